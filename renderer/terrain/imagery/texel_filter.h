// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "fabric/image.h"

namespace eyrie::terrain {

/// The next coarser level of a picture: each texel the mean of four in linear light (the texels are
/// sRGB), weighted by alpha; its alpha is their mean. The side that is odd repeats its last texel.
/// Precondition: texels.size() == columns * rows;
/// out.size() == ((columns + 1) / 2) * ((rows + 1) / 2).
void halve(std::span<const fabric::Rgba> texels, std::int32_t columns, std::int32_t rows,
           std::span<fabric::Rgba> out);

}  // namespace eyrie::terrain
