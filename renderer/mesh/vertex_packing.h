// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include <glm/vec3.hpp>

#include "fabric/image.h"
#include "renderer/mesh/lattice.h"

/// How a vertex is stored and sent to the device: 8 bytes of position, 4 of normal, 4 of colour.
/// effects/mesh.vert.glsl decodes the same bits.
namespace eyrie::mesh {

/// Lattice coordinates in one word: x in bits 0 to 20, y in 21 to 41, z in 42 to 62.
inline std::uint64_t packPosition(const glm::uvec3& point) {
    return std::uint64_t{point.x} | std::uint64_t{point.y} << kLatticeBits |
           std::uint64_t{point.z} << (2 * kLatticeBits);
}

inline glm::uvec3 unpackPosition(std::uint64_t packed) {
    return {static_cast<std::uint32_t>(packed) & kMaxLatticeCoordinate,
            static_cast<std::uint32_t>(packed >> kLatticeBits) & kMaxLatticeCoordinate,
            static_cast<std::uint32_t>(packed >> (2 * kLatticeBits)) & kMaxLatticeCoordinate};
}

/// Octahedral unit vector, two 16-bit snorm values (x in the low half), within 0.006 degrees.
/// Q. Meyer et al., "On Floating-Point Normal Vectors", 2010; Z. Cigolle et al., "A Survey of
/// Efficient Representations for Independent Unit Vectors", 2014.
/// Precondition: `normal` is finite and not zero; its length does not matter.
std::uint32_t packNormal(const glm::vec3& normal);

/// The unit vector a shader's unpackSnorm2x16 and octahedral decoding give.
glm::vec3 unpackNormal(std::uint32_t packed);

/// Bytes in memory are r, g, b, a (sRGB as in the source): unpackUnorm4x8 gives rgba.
inline std::uint32_t packColour(fabric::Rgba colour) {
    return std::bit_cast<std::uint32_t>(colour);
}
inline fabric::Rgba unpackColour(std::uint32_t packed) {
    return std::bit_cast<fabric::Rgba>(packed);
}

}  // namespace eyrie::mesh
