// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderer/mesh/codec/open_edges.h"
#include "renderer/mesh/lattice.h"

/// What encoder and decoder of a node's page (page_codec.h) agree on.
namespace eyrie::mesh {

/// A number as an entropy-coded symbol, which has its size and two bits below the highest, and the
/// bits that are left, which are stored as they are.
struct NumberCode {
    std::uint32_t symbol = 0;
    int restBits = 0;
};

inline constexpr std::uint32_t kNumberSymbols = 124;  ///< of numbers below 2^32

inline NumberCode codeOf(std::uint32_t number) {
    const int bits = std::bit_width(number);
    if (bits < 3)
        return {number, 0};
    return {static_cast<std::uint32_t>(4 * (bits - 2)) + (number >> (bits - 3) & 3), bits - 3};
}

inline int restBitsOf(std::uint32_t symbol) {
    return symbol < 4 ? 0 : static_cast<int>(symbol / 4) - 1;
}

inline std::uint32_t numberOf(std::uint32_t symbol, std::uint32_t rest) {
    return symbol < 4 ? symbol : (4 + symbol % 4) << restBitsOf(symbol) | rest;
}

/// Small numbers for small differences of either sign.
inline std::uint32_t zigzag(std::int32_t difference) {
    return static_cast<std::uint32_t>(difference) << 1 ^
           static_cast<std::uint32_t>(difference >> 31);
}
inline std::uint32_t unzigzag(std::uint32_t code) { return code >> 1 ^ (0U - (code & 1)); }

/// `difference` modulo 2^bits, from -2^(bits-1) on.
template <int kBits>
std::int32_t wrapped(std::uint32_t difference) {
    return static_cast<std::int32_t>(difference << (32 - kBits)) >> (32 - kBits);
}

/// Contexts, each with shares of its own, of the triangles' symbols ...
enum TriangleContext : std::uint32_t {
    kMetEdge,                         ///< age of the open edge that it meets, and the turn
    kThirdCorner,                     ///< ... and three more, by age
    kLooseCorner = kThirdCorner + 4,  ///< of a triangle that meets none
    kTriangleContexts = kLooseCorner + 1
};
inline constexpr std::uint32_t kMetEdgeSymbols = 3 * OpenEdges::kReach + 1;
static_assert(kMetEdgeSymbols <= 256);

/// Symbols of third corners: ThirdCorner's, and from kElsewhere on how long ago it was new.
inline constexpr auto kElsewhere = static_cast<std::uint32_t>(ThirdCorner::IsElsewhere);
inline constexpr std::uint32_t kThirdSymbols = kElsewhere + kNumberSymbols;

inline std::uint32_t thirdContext(std::uint32_t age) { return kThirdCorner + (age < 3 ? age : 3); }

inline constexpr std::uint32_t symbolsOf(std::uint32_t triangleContext) {
    return triangleContext == kMetEdge       ? kMetEdgeSymbols
           : triangleContext == kLooseCorner ? kNumberSymbols
                                             : kThirdSymbols;
}

/// ... and of a vertex's numbers: x, y, z, the two of the normal, and, where there are some, r, g,
/// b, a, and u, v.
constexpr std::size_t numbersOf(bool hasColours, bool hasTextures) {
    return 5U + (hasColours ? 4U : 0U) + (hasTextures ? 2U : 0U);
}

/// The vertices from which a new one is foreseen: it makes a parallelogram of the triangle across
/// the edge from a to b. All three are the same where there is no such triangle.
struct Origin {
    std::uint16_t a = 0;
    std::uint16_t b = 0;
    std::uint16_t opposite = 0;
};

/// Origins of the new vertices of a triangle that meets no edge: those from `firstNew` on.
template <typename Set>
void originsOfLoose(std::span<const std::uint16_t, 3> corners, std::uint32_t firstNew,
                    const Set& set) {
    auto known = static_cast<std::uint16_t>(firstNew == 0 ? 0 : firstNew - 1);
    for (std::size_t k = 3; k-- > 0;)
        if (corners[k] < firstNew)
            known = corners[k];
    for (const std::uint16_t corner : corners) {
        if (corner == firstNew) {
            set(corner, Origin{known, known, known});
            ++firstNew;
        }
        known = corner;
    }
}

/// Of vertices without triangles: each is foreseen where the one before it is.
inline void originsOfPoints(std::span<Origin> origins) {
    for (std::size_t v = 1; v < origins.size(); ++v) {
        const auto before = static_cast<std::uint16_t>(v - 1);
        origins[v] = {before, before, before};
    }
}

/// Modulo 2^21: any three make a lattice point.
inline glm::uvec3 foreseen(const glm::uvec3& a, const glm::uvec3& b, const glm::uvec3& opposite) {
    return (a + b - opposite) & glm::uvec3(kMaxLatticeCoordinate);
}

/// Modulo 2^32.
inline glm::uvec2 foreseen(const glm::ivec2& a, const glm::ivec2& b, const glm::ivec2& opposite) {
    return glm::uvec2(a) + glm::uvec2(b) - glm::uvec2(opposite);
}

/// Channel by channel half way between two colours.
inline std::uint32_t meanColour(std::uint32_t a, std::uint32_t b) {
    return (a & b) + (((a ^ b) & 0xFEFEFEFEU) >> 1);
}

}  // namespace eyrie::mesh
