// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/picture_encoder.h"

#include <utility>

#include "coordinator/stream/drawing.h"
#include "coordinator/stream/shrink.h"
#include "fabric/pixel_hash.h"
#include "fabric/status.h"
#include "wire/jpeg.h"
#include "wire/png.h"

namespace eyrie::stream {
namespace {

constexpr int kFineQuality = 95;

absl::StatusOr<std::shared_ptr<const fabric::Image>> decoded(
    const coordinator::RenderedFrame& frame) {
    auto image = std::make_shared<fabric::Image>(fabric::makeImage(frame.image.area, {}, false));
    for (const coordinator::CodedTile& tile : frame.tiles) {
        ASSIGN_OR_RETURN(fabric::Image part, wire::decodeJpeg(tile.jpeg));
        part.area = tile.area;
        fabric::paste(part, *image);
    }
    return image;
}

/// Of the pictures of one moment the one that a class gets, as large as it was drawn.
absl::StatusOr<std::shared_ptr<const fabric::Image>> wholeOf(const Picture& picture,
                                                             const QualityClass& as) {
    const std::shared_ptr<const coordinator::RenderedFrame>& frame = picture.frame;
    if (frame->tiles.empty())
        return std::shared_ptr<const fabric::Image>(
            frame, as.output == 0 ? &frame->image : &frame->further[as.output - 1]);
    if (as.fineness != Fineness::Moving)
        return absl::FailedPreconditionError("the picture was encoded by renderers, with loss");
    return decoded(*frame);
}

/// As renderers encoded it, for a level of that quality.
EncodedPicture laidOut(const coordinator::RenderedFrame& frame, int quality) {
    EncodedPicture encoded;
    const fabric::PixelViewport& whole = frame.image.area;
    encoded.width = whole.width;
    encoded.height = whole.height;
    encoded.quality = quality;
    if (frame.tiles.size() == 1) {
        encoded.bytes = frame.tiles.front().jpeg;
        return encoded;
    }
    for (const coordinator::CodedTile& tile : frame.tiles) {
        const fabric::PixelViewport& area = tile.area;
        const int fromTop = whole.y + whole.height - (area.y + area.height);
        encoded.tiles.push_back({area.x - whole.x, fromTop, tile.jpeg.size()});
        encoded.bytes.insert(encoded.bytes.end(), tile.jpeg.begin(), tile.jpeg.end());
    }
    return encoded;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const fabric::Image>> pixelsFor(const Picture& picture,
                                                               const QualityClass& as) {
    ASSIGN_OR_RETURN(const std::shared_ptr<const fabric::Image> image, wholeOf(picture, as));
    if (as.fineness != Fineness::Moving || as.level <= picture.level)
        return image;
    const coordinator::FrameRequest wanted =
        drawingOf(picture.view, nullptr, QualityControl::level(as.level).scale);
    if (wanted.width >= image->area.width || wanted.height >= image->area.height)
        return image;
    return std::make_shared<const fabric::Image>(shrunk(*image, wanted.width, wanted.height));
}

absl::StatusOr<EncodedPicture> encodePicture(const Picture& picture, const QualityClass& as) {
    if (as.asTiles)
        return laidOut(*picture.frame, QualityControl::level(as.level).quality);
    ASSIGN_OR_RETURN(const std::shared_ptr<const fabric::Image> pixels, pixelsFor(picture, as));
    const fabric::Image& image = *pixels;
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
