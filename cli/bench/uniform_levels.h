// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/bench/frame_error.h"
#include "cli/bench/reference_sources.h"
#include "fabric/camera.h"

namespace eyrie::cli::bench {

/// Pictures of uniform levels are cast this high, and their displacements counted in the pixels of
/// the pictures asked for: percentiles need no more of them.
inline constexpr int kUniformHeight = 180;

/// A scene whose every source is decimated uniformly, to a half, a quarter, an eighth ... of its
/// triangles (meshes: truth::clustered; terrains: truth::everyPost, from a quarter on), how many of
/// them are in view, which renderers without levels leave out, too, and how far each is off in
/// pictures of `width` x `height` from `cameras`. Finest first; levels without any
/// error are left out; the last is the first beyond `untilPixels` of 99 in 100 pixels. `levelDone`
/// is called after each. Errors: Cancelled.
absl::StatusOr<std::vector<UniformLevel>> uniformLevels(const ReferenceScene& reference,
                                                        std::span<const fabric::Camera> cameras,
                                                        int width, int height, double untilPixels,
                                                        const std::function<void()>& levelDone,
                                                        const std::stop_token& stop);

}  // namespace eyrie::cli::bench
