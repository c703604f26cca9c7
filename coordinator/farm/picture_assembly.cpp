// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/picture_assembly.h"

#include <utility>

#include "coordinator/farm/broken_protocol.h"
#include "eyrie/v1/render_service.pb.h"
#include "wire/picture_header.h"
#include "wire/statistics.h"

namespace eyrie::coordinator {

absl::Status PictureAssembly::takeHeader(const v1::ChannelHeader& header) {
    if (pixels_ || isInMemory_)
        return brokenProtocol("a second header");
    const auto picture = wire::announcedPicture(header, task_.pixelViewport, task_.wantsDepth);
    RETURN_IF_ERROR(brokenProtocol(picture.status()));
    const auto statistics = wire::fromMessage(header.statistics());
    RETURN_IF_ERROR(brokenProtocol(statistics.status()));
    result_.statistics = *statistics;
    if (header.is_in_memory())
        return takeFromMemory(picture->area, picture->hasDepth);
    result_.image = picture->blank();
    pixels_.emplace(result_.image, picture->encoding);
    return absl::OkStatus();
}

absl::Status PictureAssembly::takeFromMemory(const fabric::PixelViewport& area, bool hasDepth) {
    if (memory_ == nullptr)
        return brokenProtocol("a picture in memory, where none was offered");
    auto image = memory_->take(area, hasDepth);
    RETURN_IF_ERROR(brokenProtocol(image.status()));
    result_.image = *std::move(image);
    isInMemory_ = true;
    return absl::OkStatus();
}

absl::Status PictureAssembly::takeChunk(std::string_view bytes) {
    if (isInMemory_)
        return brokenProtocol("pixels after a picture in memory");
    if (!pixels_)
        return brokenProtocol("pixels before the header");
    return brokenProtocol(pixels_->take(bytes));
}

absl::StatusOr<fabric::ChannelResult> PictureAssembly::finish() {
    if (!pixels_ && !isInMemory_)
        return brokenProtocol("no header");
    if (pixels_)
        RETURN_IF_ERROR(brokenProtocol(pixels_->finish()));
    return std::move(result_);
}

}  // namespace eyrie::coordinator
