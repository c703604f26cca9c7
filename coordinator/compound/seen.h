// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/compound/plan.h"

/// What the views of a configuration show: through which walls, from where.
namespace eyrie::compound {

/// The view that a destination is a part of.
struct Surroundings {
    fabric::PixelViewport whole;       ///< from (0, 0), of the size of the view
    std::optional<config::Wall> wall;  ///< of the whole, in the room; nothing: the camera's view
};

/// `wall`: one that a compound has for the whole of the destination.
Surroundings surroundingsOf(const config::Destination& destination,
                            const std::optional<config::Wall>& wall);

/// config::focusRatio() where heads are as `display` has them.
double focusRatio(const config::Configuration& configuration, const config::Display& display,
                  const config::ResolvedConfiguration& resolved,
                  const config::Destination& destination);

/// What an eye sees of the whole of `surroundings`; nothing: the camera's own view. Errors, for a
/// person to read: FailedPrecondition where the eye is not before the wall, InvalidArgument where
/// renderers cannot draw what it sees there.
absl::StatusOr<std::optional<fabric::Sight>> seen(const config::Configuration& configuration,
                                                  const PlanRequest& request,
                                                  const config::Destination& destination,
                                                  const Surroundings& surroundings, Eye eye,
                                                  double focusRatio);

}  // namespace eyrie::compound
