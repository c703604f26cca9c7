// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace eyrie::fabric {

/// Objects of a scene that are as if they were not there: not drawn, not picked, no ground. Those
/// that a scene does not have count for nothing.
struct HiddenObjects {
    std::vector<std::int32_t> positions;  ///< in Scene::objects; ascending, none twice

    bool contains(std::size_t object) const {
        return std::binary_search(positions.begin(), positions.end(),
                                  static_cast<std::int64_t>(object));
    }
    bool operator==(const HiddenObjects&) const = default;
};

inline constexpr int kMaxHiddenObjects = 1000;

}  // namespace eyrie::fabric
