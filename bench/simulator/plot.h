// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace eyrie::simulator {

/// Values by number of renderers.
struct Curve {
    std::string name;
    std::vector<std::pair<int, double>> points;
};

/// An SVG of curves over 1, 2, 4 … renderers, side by side: what one frame takes, and how many
/// there are in a second for each that one renderer makes.
std::string plot(const std::string& title, const std::vector<Curve>& milliseconds,
                 const std::vector<Curve>& speedups);

}  // namespace eyrie::simulator
