// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/picture_encoder.h"

#include "coordinator/stream/quality.h"
#include "fabric/pixel_hash.h"
#include "fabric/status.h"
#include "wire/jpeg.h"
#include "wire/png.h"

namespace eyrie::stream {
namespace {

constexpr int kFineQuality = 95;

}  // namespace

absl::StatusOr<EncodedFrame> encodePicture(const Picture& picture, Fineness fineness,
                                           std::uint64_t frameNumber) {
    const fabric::Image& image = picture.frame->image;
    EncodedFrame encoded;
    encoded.frameNumber = frameNumber;
    encoded.viewSequence = picture.view.sequence;
    encoded.fineness = fineness;
    encoded.liftedCamera = picture.liftedCamera;
    if (fineness == Fineness::Exact) {
        ASSIGN_OR_RETURN(encoded.picture, wire::encodePng(image));
        encoded.pixelHash = fabric::pixelHash(image);
        return encoded;
    }
    const bool isMoving = fineness == Fineness::Moving;
    encoded.quality = isMoving ? QualityControl::level(picture.level).quality : kFineQuality;
    ASSIGN_OR_RETURN(encoded.picture, wire::encodeJpeg(image, encoded.quality,
                                                       isMoving ? wire::ChromaSubsampling::Half
                                                                : wire::ChromaSubsampling::None));
    return encoded;
}

}  // namespace eyrie::stream
