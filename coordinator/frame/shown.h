// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coordinator/compound/plan.h"

namespace eyrie::coordinator {

/// Which picture of a configuration somebody wants to see. Things are named by their names, of
/// several the first, or by their positions from 0 on: "1", or "#1" where another is named "1".
struct Shown {
    std::string canvas;                ///< empty: the first
    std::string segment;               ///< empty: the whole canvas
    std::optional<compound::Eye> eye;  ///< nothing: what the view shows
    compound::Stereo stereo = compound::Stereo::Configured;

    /// Pictures of eyes in one, side by side and one above the other; each is of the size asked
    /// for.
    int eyesAcross() const { return !eye && stereo == compound::Stereo::SideBySide ? 2 : 1; }
    int eyesUp() const { return !eye && stereo == compound::Stereo::TopBottom ? 2 : 1; }

    bool operator==(const Shown&) const = default;
};

}  // namespace eyrie::coordinator
