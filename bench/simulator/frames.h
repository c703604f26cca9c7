// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "bench/simulator/costs.h"
#include "coordinator/config/configuration.h"

namespace eyrie::simulator {

/// Means of frames of one scene, over whole cycles of the configuration's periods.
struct Prediction {
    double frameMilliseconds = 0;  ///< from its beginning to the whole picture
    double framesPerSecond = 0;    ///< with as many in flight as the configuration's latency says
    double bytes = 0;              ///< sent in a frame, over links and within hosts
    double processorMilliseconds = 0;  ///< of all cores, a frame
};

/// What frames of `triangles` take with all compound trees of `configuration` whose pictures are
/// shown, one renderer to a pipe. The steps are those of the configuration: draw, read back, send,
/// assemble, in the order written for each channel; what the destination's channel has goes to the
/// coordinator, which assembles it with the frames that its root takes.
///
/// Triangles of a part are those of all LOD nodes that it meets: of a share w of a side of the
/// picture, w + overlap (1 - w) of that side's (after Molnar, Cox, Ellsworth, Fuchs: "A Sorting
/// Classification of Parallel Rendering", 1994). Errors: InvalidArgument: nothing is drawn,
/// frames wait for each other, or renderers fetch tiles.
absl::StatusOr<Prediction> predict(const config::Configuration& configuration, const Costs& costs,
                                   const Machines& machines, double triangles);

}  // namespace eyrie::simulator
