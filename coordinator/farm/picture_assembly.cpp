// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/picture_assembly.h"

#include <cstdint>
#include <span>
#include <utility>

#include "coordinator/farm/broken_protocol.h"
#include "eyrie/v1/render_service.pb.h"
#include "wire/jpeg.h"
#include "wire/picture_header.h"
#include "wire/statistics.h"

namespace eyrie::coordinator {
namespace {

constexpr std::uint64_t kMostHeadBytes = 64 * 1024;  ///< of a JPEG, before its blocks

}  // namespace

absl::Status PictureAssembly::takeHeader(const v1::ChannelHeader& header) {
    if (pixels_ || inMemory_ || isJpeg_)
        return brokenProtocol("a second header");
    const auto picture = wire::announcedPicture(header, task_.pixelViewport, task_.wantsDepth);
    RETURN_IF_ERROR(brokenProtocol(picture.status()));
    const auto statistics = wire::fromMessage(header.statistics());
    RETURN_IF_ERROR(brokenProtocol(statistics.status()));
    result_.statistics = *statistics;
    if (header.is_jpeg() != (task_.jpegQuality > 0))
        return header.is_jpeg() ? brokenProtocol("a JPEG, where pixels were asked for")
                                : brokenProtocol("pixels, where a JPEG was asked for");
    if (header.is_in_memory())
        return takeFromMemory(picture->area, picture->hasDepth);
    if (header.is_jpeg())
        return takeJpeg(picture->area);
    result_.image = picture->blank();
    pixels_.emplace(result_.image, picture->encoding);
    return absl::OkStatus();
}

absl::Status PictureAssembly::takeFromMemory(const fabric::PixelViewport& area, bool hasDepth) {
    if (memory_ == nullptr)
        return brokenProtocol("a picture in memory, where none was offered");
    const auto picture = memory_->picture(area, hasDepth);
    RETURN_IF_ERROR(brokenProtocol(picture.status()));
    result_.image.area = area;
    inMemory_ = *picture;
    return absl::OkStatus();
}

absl::Status PictureAssembly::takeJpeg(const fabric::PixelViewport& area) {
    result_.image.area = area;
    isJpeg_ = true;
    return absl::OkStatus();
}

absl::Status PictureAssembly::takeJpegBytes(std::string_view bytes) {
    // No JPEG of noise at the best quality takes more.
    const std::uint64_t most = wire::pixelBytes(task_.pixelViewport, false) + kMostHeadBytes;
    if (result_.jpeg.size() + bytes.size() > most)
        return brokenProtocol("a JPEG of more than {} bytes", most);
    const auto span = std::as_bytes(std::span(bytes));
    result_.jpeg.insert(result_.jpeg.end(), span.begin(), span.end());
    return absl::OkStatus();
}

/// What comes after its header is for who decodes it.
absl::Status PictureAssembly::checkJpeg() const {
    const auto size = wire::jpegSize(result_.jpeg);
    RETURN_IF_ERROR(brokenProtocol(size.status()));
    const fabric::PixelViewport& asked = task_.pixelViewport;
    if (size->width != asked.width || size->height != asked.height)
        return brokenProtocol("a JPEG of {}x{} pixels, where {}x{} were asked for", size->width,
                              size->height, asked.width, asked.height);
    return absl::OkStatus();
}

absl::Status PictureAssembly::takeChunk(std::string_view bytes) {
    if (inMemory_)
        return brokenProtocol("pixels after a picture in memory");
    if (isJpeg_)
        return takeJpegBytes(bytes);
    if (!pixels_)
        return brokenProtocol("pixels before the header");
    return brokenProtocol(pixels_->take(bytes));
}

absl::StatusOr<fabric::ChannelResult> PictureAssembly::finish() {
    if (!pixels_ && !inMemory_ && !isJpeg_)
        return brokenProtocol("no header");
    if (isJpeg_)
        RETURN_IF_ERROR(checkJpeg());
    if (pixels_)
        RETURN_IF_ERROR(brokenProtocol(pixels_->finish()));
    return std::move(result_);
}

}  // namespace eyrie::coordinator
