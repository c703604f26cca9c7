// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/picture_encoder.h"

#include <optional>

#include "coordinator/stream/drawing.h"
#include "coordinator/stream/quality.h"
#include "coordinator/stream/shrink.h"
#include "fabric/pixel_hash.h"
#include "fabric/status.h"
#include "wire/jpeg.h"
#include "wire/png.h"

namespace eyrie::stream {
namespace {

constexpr int kFineQuality = 95;

const fabric::Image& imageOf(const Picture& picture, std::size_t output) {
    return output == 0 ? picture.frame->image : picture.frame->further[output - 1];
}

/// Nothing where it is no larger than the level asks for.
std::optional<fabric::Image> shrunkFor(const Picture& picture, const fabric::Image& image,
                                       int level) {
    const coordinator::FrameRequest wanted =
        drawingOf(picture.view, nullptr, QualityControl::level(level).scale);
    if (wanted.width >= image.area.width || wanted.height >= image.area.height)
        return std::nullopt;
    return shrunk(image, wanted.width, wanted.height);
}

}  // namespace

absl::StatusOr<EncodedPicture> encodePicture(const Picture& picture, const QualityClass& as) {
    const fabric::Image& drawn = imageOf(picture, as.output);
    std::optional<fabric::Image> smaller;
    if (as.fineness == Fineness::Moving && as.level > picture.level)
        smaller = shrunkFor(picture, drawn, as.level);
    const fabric::Image& image = smaller ? *smaller : drawn;
    EncodedPicture encoded;
    encoded.fineness = as.fineness;
    encoded.width = image.area.width;
    encoded.height = image.area.height;
    if (as.fineness == Fineness::Exact) {
        ASSIGN_OR_RETURN(encoded.bytes, wire::encodePng(image));
        encoded.pixelHash = fabric::pixelHash(image);
        return encoded;
    }
    const bool isMoving = as.fineness == Fineness::Moving;
    encoded.quality = isMoving ? QualityControl::level(as.level).quality : kFineQuality;
    ASSIGN_OR_RETURN(encoded.bytes, wire::encodeJpeg(image, encoded.quality,
                                                     isMoving ? wire::ChromaSubsampling::Half
                                                              : wire::ChromaSubsampling::None));
    return encoded;
}

}  // namespace eyrie::stream
