// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "fabric/image.h"

namespace eyrie::fabric {

/// Random colours, and depths from so few values that many pixels tie; about a third undrawn.
inline Image sampleImage(const PixelViewport& area, std::uint32_t seed) {
    std::mt19937 random(seed);
    Image image = makeImage(area, {}, true);
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        image.colour[i] = {static_cast<std::uint8_t>(random() % 256),
                           static_cast<std::uint8_t>(random() % 256),
                           static_cast<std::uint8_t>(random() % 256), 255};
        image.depth[i] = static_cast<float>(random() % 6) / 5;
        if (random() % 3 == 0)
            image.depth[i] = 0;
    }
    return image;
}

}  // namespace eyrie::fabric
