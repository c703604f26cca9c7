// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>

#include "coordinator/frame/kept_settings.h"

namespace eyrie::coordinator {

/// What a canvas was switched to.
struct KeptLayout {
    std::string first;  ///< what it shows unless told otherwise
    std::string layout;

    bool operator==(const KeptLayout&) const = default;
};

/// All that was set of a configuration, for a coordinator that takes this one's place.
struct KeptConfiguration {
    KeptSettings settings;
    std::map<std::string, KeptLayout> layouts;  ///< of canvases that show another than at first

    bool operator==(const KeptConfiguration&) const = default;
};

/// How it goes from one to the other.
struct ConfigurationKeeping {
    KeptConfiguration before;
    /// Called after each change, while no frame is being planned: it is not to block.
    std::function<void(const KeptConfiguration&)> keep = [](const KeptConfiguration&) {};
};

}  // namespace eyrie::coordinator
