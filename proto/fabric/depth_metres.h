// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <string>
#include <vector>

#include "fabric/frustum.h"
#include "fabric/image.h"

namespace eyrie::fabric {

/// View-space metres of a picture's depth, infinite where nothing opaque is, in the order of its
/// rows: from the bottom up.
inline std::vector<float> depthMetres(const Image& image) {
    std::vector<float> metres;
    metres.reserve(image.depth.size());
    for (const float reversed : image.depth)
        metres.push_back(static_cast<float>(viewDepthMetres(reversed, kNearMetres)));
    return metres;
}

/// What stands before them in a portable float map (PFM; P. Debevec): a negative scale says that
/// the numbers are little-endian.
inline std::string floatMapHead(int width, int height) {
    static_assert(std::endian::native == std::endian::little);
    return "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
}

}  // namespace eyrie::fabric
