// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "coordinator/stream/progress.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::stream {

/// `picture` as it goes to a browser, by its fineness: a JPEG as its level says, one of quality 95
/// without loss in chroma, or a PNG with its hash. Errors: those of wire::encodeJpeg and encodePng.
absl::StatusOr<EncodedFrame> encodePicture(const Picture& picture, Fineness fineness,
                                           std::uint64_t frameNumber);

}  // namespace eyrie::stream
