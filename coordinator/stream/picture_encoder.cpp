// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/picture_encoder.h"

#include "coordinator/stream/drawing.h"
#include "coordinator/stream/shrink.h"
#include "fabric/pixel_hash.h"
#include "fabric/status.h"
#include "wire/jpeg.h"
#include "wire/png.h"

namespace eyrie::stream {
namespace {

constexpr int kFineQuality = 95;

}  // namespace

const fabric::Image& imageOf(const Picture& picture, const QualityClass& as) {
    return as.output == 0 ? picture.frame->image : picture.frame->further[as.output - 1];
}

std::optional<fabric::Image> shrunkFor(const Picture& picture, const QualityClass& as) {
    if (as.fineness != Fineness::Moving || as.level <= picture.level)
        return std::nullopt;
    const fabric::Image& image = imageOf(picture, as);
    const coordinator::FrameRequest wanted =
        drawingOf(picture.view, nullptr, QualityControl::level(as.level).scale);
    if (wanted.width >= image.area.width || wanted.height >= image.area.height)
        return std::nullopt;
    return shrunk(image, wanted.width, wanted.height);
}

absl::StatusOr<EncodedPicture> encodePicture(const Picture& picture, const QualityClass& as) {
    const std::optional<fabric::Image> smaller = shrunkFor(picture, as);
    const fabric::Image& image = smaller ? *smaller : imageOf(picture, as);
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
