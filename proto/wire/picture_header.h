// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>
#include <fmt/format.h>

#include "eyrie/v1/frame.pb.h"
#include "eyrie/v1/render_service.pb.h"
#include "fabric/image.h"
#include "fabric/status.h"
#include "wire/frame.h"
#include "wire/picture_bytes.h"
#include "wire/picture_memory.h"

/// The fields that the messages before pixels have in common: ChannelHeader, ProgramPictureHeader
/// and FrameHeader. Include it in sources only.
namespace eyrie::wire {

inline v1::PixelEncoding toMessage(PixelEncoding encoding) {
    return encoding == PixelEncoding::ActiveRuns ? v1::PIXEL_ENCODING_ACTIVE_RUNS
                                                 : v1::PIXEL_ENCODING_RAW;
}

inline absl::StatusOr<PixelEncoding> fromMessage(v1::PixelEncoding encoding) {
    switch (encoding) {
        case v1::PIXEL_ENCODING_UNSPECIFIED:
        case v1::PIXEL_ENCODING_RAW:
            return PixelEncoding::Raw;
        case v1::PIXEL_ENCODING_ACTIVE_RUNS:
            return PixelEncoding::ActiveRuns;
        default:
            return absl::InvalidArgumentError(fmt::format(
                "encoding is {}, which this version does not know", static_cast<int>(encoding)));
    }
}

inline v1::PictureMemory toMessage(const MemoryOffer& offer) {
    v1::PictureMemory message;
    message.set_process(offer.process);
    message.set_file(offer.descriptor);
    message.set_bytes(offer.bytes);
    message.set_key(offer.key);
    return message;
}

/// Checked when it is opened.
inline MemoryOffer fromMessage(const v1::PictureMemory& message) {
    return {message.process(), message.file(), message.bytes(), message.key()};
}

inline std::uint64_t pixelBytes(const fabric::PixelViewport& area, bool hasDepth) {
    return static_cast<std::uint64_t>(area.area()) * (hasDepth ? 8 : 4);
}

template <typename Header>
void describe(const fabric::PixelViewport& area, bool hasDepth, PixelEncoding encoding,
              Header& header) {
    *header.mutable_area() = toMessage(area);
    header.set_has_depth(hasDepth);
    header.set_pixel_bytes(pixelBytes(area, hasDepth));
    header.set_encoding(toMessage(encoding));
}

template <typename Header>
void describe(const fabric::Image& image, PixelEncoding encoding, Header& header) {
    describe(image.area, image.hasDepth(), encoding, header);
}

/// What a header announces, as far as that can be believed: the area lies within `whole` or is
/// empty, there is depth if `wantsDepth` and the area is not empty, the sizes agree.
struct AnnouncedPicture {
    fabric::PixelViewport area;
    bool hasDepth = false;
    PixelEncoding encoding = PixelEncoding::Raw;

    std::uint64_t bytes() const { return pixelBytes(area, hasDepth); }
    /// With all its pixels, of whatever value.
    fabric::Image blank() const { return fabric::makeImage(area, {}, hasDepth); }
};

/// InvalidArgument, naming the field.
template <typename Header>
absl::StatusOr<AnnouncedPicture> announcedPicture(const Header& header,
                                                  const fabric::PixelViewport& whole,
                                                  bool wantsDepth) {
    AnnouncedPicture picture;
    ASSIGN_OR_RETURN(picture.area, fromMessage(header.area()));
    ASSIGN_OR_RETURN(picture.encoding, fromMessage(header.encoding()));
    picture.hasDepth = header.has_depth();
    const fabric::PixelViewport& area = picture.area;
    if (!area.isEmpty() && !whole.contains(area))
        return absl::InvalidArgumentError(
            fmt::format("area is {}x{} at {},{}, outside the task's {}x{} at {},{}", area.width,
                        area.height, area.x, area.y, whole.width, whole.height, whole.x, whole.y));
    if (wantsDepth && !picture.hasDepth && !area.isEmpty())
        return absl::InvalidArgumentError("has_depth is false, but the task wants depth");
    if (header.pixel_bytes() != picture.bytes())
        return absl::InvalidArgumentError(fmt::format("pixel_bytes is {}, but {}x{} pixels have {}",
                                                      header.pixel_bytes(), area.width, area.height,
                                                      picture.bytes()));
    return picture;
}

}  // namespace eyrie::wire
