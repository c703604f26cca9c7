// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "tests/coordinator/balanced_scene.h"

namespace eyrie::equalizer {

/// A way of cutting, and where nine tenths of the load lie.
struct HotTenth {
    const char* mode;
    Area hot;  ///< a tenth of the whole
};
inline constexpr double kLow = .3419;
inline constexpr std::array<HotTenth, 12> kHotTenths = {{{"2D", {.45, 0, .55, 1}},
                                                         {"2D", {.9, 0, 1, 1}},
                                                         {"2D", {.6838, .6838, 1, 1}},
                                                         {"2D", {kLow, kLow, 1 - kLow, 1 - kLow}},
                                                         {"2D", {.1, .3, .3, .8}},
                                                         {"DB", {.45, 0, .55, 1}},
                                                         {"DB", {.9, 0, 1, 1}},
                                                         {"DB", {.2, 0, .3, 1}},
                                                         {"VERTICAL", {.9, 0, 1, 1}},
                                                         {"VERTICAL", {.33, 0, .43, 1}},
                                                         {"HORIZONTAL", {0, .45, 1, .55}},
                                                         {"HORIZONTAL", {0, 0, 1, .1}}}};

inline Balanced loadBalanced(int count, const std::string& settings) {
    return Balanced(
        configurationOf(count - 1, sharedBetween(count, "load_equalizer { " + settings + " }")));
}

}  // namespace eyrie::equalizer
