// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "fabric/image.h"

namespace eyrie::test {

/// Pixels whose colour or depth is not the same; all where the pictures are not alike in size or in
/// having depth.
inline std::size_t differentPixels(const fabric::Image& a, const fabric::Image& b) {
    if (a.area != b.area || a.depth.size() != b.depth.size())
        return std::max(a.colour.size(), b.colour.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i)
        different +=
            a.colour[i] == b.colour[i] && (!a.hasDepth() || a.depth[i] == b.depth[i]) ? 0 : 1;
    return different;
}

}  // namespace eyrie::test
