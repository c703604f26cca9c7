// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "fabric/image.h"

namespace eyrie::test {

/// The bytes of a TGA file: texels as they are, rows from the top.
inline std::string tgaOf(int width, int height, const std::vector<fabric::Rgba>& texels) {
    std::string file(18, '\0');
    const auto put = [&file](std::size_t at, int value) {
        file[at] = static_cast<char>(value & 255);
        file[at + 1] = static_cast<char>(value >> 8);
    };
    file[2] = 2;  // true colour
    put(12, width);
    put(14, height);
    file[16] = 32;    // bits a texel
    file[17] = 0x28;  // eight of alpha, from the top
    for (const fabric::Rgba& texel : texels)
        for (const std::uint8_t value : {texel.b, texel.g, texel.r, texel.a})
            file += static_cast<char>(value);
    return file;
}

}  // namespace eyrie::test
