// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>

#include <absl/status/statusor.h>

#include "coordinator/stream/progress.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

/// What is encoded once for all browsers that are to have it so.
struct QualityClass {
    Fineness fineness = Fineness::Moving;
    int level = 0;           ///< QualityControl's; of still ones 0
    std::size_t output = 0;  ///< in RenderedFrame::pictures

    auto operator<=>(const QualityClass&) const = default;
};

/// `picture` as browsers get it: a JPEG as the level says, shrunk to its scale where it was drawn
/// larger, one of quality 95 without loss in chroma, or a PNG with its hash. Errors: those of
/// wire::encodeJpeg and encodePng.
absl::StatusOr<EncodedPicture> encodePicture(const Picture& picture, const QualityClass& as);

}  // namespace eyrie::stream
