// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "fabric/image.h"

namespace eyrie::fabric {

/// A number by which two ends see whether they have the same red, green and blue: FNV-1a (G.
/// Fowler, L. C. Noll, K.-P. Vo, 1991) of whole pixels, r + 256 g + 65536 b, from the top left one
/// by rows. Each step can be undone, so a picture with one wrong pixel always has another hash, and
/// any other wrong picture all but one in 2^32. It tells accidents, not forgeries.
inline std::uint32_t pixelHash(const Image& image) {
    const auto width = static_cast<std::size_t>(image.area.width);
    std::uint32_t hash = 2166136261u;
    for (auto y = static_cast<std::size_t>(image.area.height); y-- > 0;)
        for (std::size_t x = 0; x < width; ++x) {
            const Rgba& pixel = image.colour[y * width + x];
            const std::uint32_t word =
                pixel.r | std::uint32_t{pixel.g} << 8 | std::uint32_t{pixel.b} << 16;
            hash = (hash ^ word) * 16777619u;
        }
    return hash;
}

}  // namespace eyrie::fabric
