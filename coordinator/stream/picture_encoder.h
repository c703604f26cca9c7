// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <memory>

#include <absl/status/statusor.h>

#include "coordinator/stream/progress.h"
#include "coordinator/stream/quality.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

/// What is encoded once for all browsers that are to have it so.
struct QualityClass {
    Fineness fineness = Fineness::Moving;
    int level = 0;              ///< QualityControl's; of still ones 0
    Codec codec = Codec::Jpeg;  ///< of moving ones
    std::size_t output = 0;     ///< in RenderedFrame::pictures
    bool asTiles = false;       ///< of moving ones: as renderers encoded them

    auto operator<=>(const QualityClass&) const = default;
};

/// The pixels of `picture` as a class gets them: of those of one moment its own, shrunk to its
/// scale where it was drawn larger, decoded where renderers encoded it. They may be the picture's,
/// which is kept for as long. Errors: those of wire::decodeJpeg; FailedPrecondition (pixels as they
/// were drawn, of a picture that renderers encoded).
absl::StatusOr<std::shared_ptr<const fabric::Image>> pixelsFor(const Picture& picture,
                                                               const QualityClass& as);

/// `picture` as browsers get it, but for streams: JPEGs as renderers encoded them, a JPEG as the
/// level says, shrunk to its scale where it was drawn larger, one of quality 95 without loss in
/// chroma, or a PNG with its hash. Errors: those of pixelsFor, wire::encodeJpeg and encodePng.
absl::StatusOr<EncodedPicture> encodePicture(const Picture& picture, const QualityClass& as);

}  // namespace eyrie::stream
