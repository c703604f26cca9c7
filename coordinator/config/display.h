// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fabric/vec.h"

/// What of a configuration is shown, how large, and from where, while that is not as it is written.
namespace eyrie::config {

struct PixelSize {
    std::int32_t width = 0;
    std::int32_t height = 0;

    bool operator==(const PixelSize&) const = default;
};

struct ShownCanvas {
    /// Position in the canvas's list of layouts; nothing: it is off.
    std::optional<std::size_t> layout = 0;
    /// Of the whole canvas; its segments are parts of it. Nothing: as `segments` say.
    std::optional<PixelSize> size;
    /// Of segments by themselves; those left out are as large as their channels.
    std::vector<std::optional<PixelSize>> segments;

    bool operator==(const ShownCanvas&) const = default;
};

/// Entries that are left out are as the configuration says.
struct Display {
    std::vector<ShownCanvas> canvases;
    /// Where the observers' heads are in the room, of metres: rotation and place.
    std::vector<fabric::Mat4> heads;
    /// Of layouts' views: metres of the scene that one metre of the room stands for; walls and eyes
    /// are that much larger. Above 0; those left out are 1.
    std::vector<std::vector<double>> modelUnits;

    bool operator==(const Display&) const = default;

    const ShownCanvas* find(std::size_t canvas) const {
        return canvas < canvases.size() ? &canvases[canvas] : nullptr;
    }
    double modelUnit(std::size_t layout, std::size_t view) const {
        return layout < modelUnits.size() && view < modelUnits[layout].size()
                   ? modelUnits[layout][view]
                   : 1;
    }
};

}  // namespace eyrie::config
