// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "fabric/image.h"
#include "video/libav/owners.h"

namespace eyrie::video {

/// A frame of even sides, large enough for pictures of width x height: 4:2:0, BT.709, limited
/// range. ResourceExhausted: no memory.
absl::StatusOr<Frame> makePlanes(int width, int height);

/// Puts the colour of `image` into `frame`, top row first; the last column and row of odd sides are
/// there twice. Chroma is the mean of the four pixels that it stands for. Precondition: `frame` was
/// made for such a size and nobody else has it.
void fillPlanes(const fabric::Image& image, AVFrame& frame);

}  // namespace eyrie::video
