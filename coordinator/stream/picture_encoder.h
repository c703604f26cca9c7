// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <optional>

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

    auto operator<=>(const QualityClass&) const = default;
};

/// Of the pictures of one moment the one that a class gets.
const fabric::Image& imageOf(const Picture& picture, const QualityClass& as);

/// The pixels of `picture` as a class gets them: shrunk to its scale where it was drawn larger,
/// and nothing where they are its own.
std::optional<fabric::Image> shrunkFor(const Picture& picture, const QualityClass& as);

/// `picture` as browsers get it, but for streams: a JPEG as the level says, shrunk to its scale
/// where it was drawn larger, one of quality 95 without loss in chroma, or a PNG with its hash.
/// Errors: those of wire::encodeJpeg and encodePng.
absl::StatusOr<EncodedPicture> encodePicture(const Picture& picture, const QualityClass& as);

}  // namespace eyrie::stream
