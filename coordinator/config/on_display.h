// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/config/state.h"
#include "fabric/vec.h"

namespace eyrie::config {

/// What of a configuration is seen at the moment, however it is drawn: while it is the same, so are
/// pictures of the same view. Canvases and segments are as they are written, and are left out.
struct OnDisplay {
    struct Canvas {
        std::vector<View> views;         ///< of the layout that it shows; none: OFF
        std::vector<double> modelUnits;  ///< of those
        std::vector<Compound> drawn;     ///< as oneChannel() has them, whichever layout it is

        bool operator==(const Canvas&) const = default;
    };
    std::vector<Canvas> canvases;
    std::vector<Observer> observers;
    std::vector<fabric::Mat4> heads;  ///< of those

    bool operator==(const OnDisplay&) const = default;
};

/// `shown` is applied() for `state`.
OnDisplay onDisplay(const Configuration& shown, const ConfigurationState& state);

}  // namespace eyrie::config
