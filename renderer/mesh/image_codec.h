// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fabric/image.h"
#include "renderer/mesh/material.h"

namespace eyrie::mesh {

/// Codes an image and its coarser levels. Coarser texels are means over the area that they cover,
/// weighted by alpha, of the squares of colours: of what shading takes for light. `shape` says
/// width, height, and in its flags whether alpha is kept; the result's also has the mean colour and
/// the error. Images of up to 64 texels a side of which some block is off by more than 20 of 255
/// (RMS), as palettes are, come out four times as wide and high: a texel is a block of its own
/// then, whose colour is kept; between two of them colours change within a quarter of the way.
/// Preconditions: sides from 1 to kMaxImageSide, texels.size() == width * height.
Image encodeImage(const ImageShape& shape, std::vector<fabric::Rgba> texels);

/// The texels of one level, rows from the top, each padded to whole blocks: 4 * ((width + 3) / 4)
/// texels a row. Any blocks give some. Precondition: blocks.size() == shape.bytesFrom(0), level <
/// shape.levels().
std::vector<fabric::Rgba> decodeLevel(const ImageShape& shape, std::span<const std::byte> blocks,
                                      std::uint32_t level);

}  // namespace eyrie::mesh
