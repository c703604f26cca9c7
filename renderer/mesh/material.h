// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

/// What a mesh's surface is drawn with besides its vertices' colours. These hold the diffuse colour
/// and, as alpha, the opacity: materials that differ in colour alone are one.
namespace eyrie::mesh {

/// In Material::flags.
inline constexpr std::uint32_t kIsBlended = 1;   ///< what is behind shows by what alpha lacks
inline constexpr std::uint32_t kIsTwoSided = 2;  ///< also where the object is drawn single-sided
inline constexpr std::uint32_t kIsOneSided = 4;  ///< its backs are not there at all

/// As stored.
struct Material {
    std::int32_t image = -1;  ///< multiplied with the colour, texel by texel; -1: none
    std::uint32_t flags = 0;
    float alphaCutoff = 0;  ///< where there is less alpha there is a hole; 0: no holes
    std::uint32_t reserved = 0;

    bool hasImage() const { return image >= 0; }
    bool isBlended() const { return (flags & kIsBlended) != 0; }
    bool isTwoSided() const { return (flags & kIsTwoSided) != 0; }
    bool isOneSided() const { return (flags & kIsOneSided) != 0; }
    /// Whether what is behind it is seen, its own backs among that.
    bool isSeeThrough() const { return isBlended() || alphaCutoff > 0; }
    bool operator==(const Material&) const = default;
};
static_assert(sizeof(Material) == 16);

inline constexpr std::uint32_t kMaxMaterials = 65535;
inline constexpr std::uint32_t kMaxImageSide = 8192;  ///< texels

/// Texture coordinates are whole numbers of this part of an image's side, (0, 0) the outer corner
/// of its first texel, v along its columns downwards. Beyond 0 and kTextureSteps it is repeated.
inline constexpr std::int32_t kTextureSteps = 65536;

/// In ImageShape::flags.
inline constexpr std::uint32_t kHasAlpha = 1;
inline constexpr std::uint32_t kClampsU = 2;  ///< the outermost texels go on; otherwise repeated
inline constexpr std::uint32_t kClampsV = 4;

/// An image with all its coarser levels, each half as wide and high (but 1 at least), down to one
/// texel, in blocks of 4 x 4 texels: BC1's, or BC3's where it has alpha. Rows of blocks from the
/// top; blocks at the right and lower side have texels beyond it.
struct ImageShape {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t flags = 0;
    /// Red, green, blue and alpha, to stand for an image that cannot be read.
    std::uint32_t meanColour = 0xFFFFFFFF;
    float rmsError = 0;  ///< of a coded channel against the source's, of 255

    bool hasAlpha() const { return (flags & kHasAlpha) != 0; }
    std::uint32_t levels() const {
        return static_cast<std::uint32_t>(std::bit_width(std::max(width, height)));
    }
    std::uint32_t widthAt(std::uint32_t level) const { return std::max(width >> level, 1U); }
    std::uint32_t heightAt(std::uint32_t level) const { return std::max(height >> level, 1U); }
    std::uint32_t blockBytes() const { return hasAlpha() ? 16 : 8; }
    /// Of the blocks of levels from `first` on.
    std::uint64_t bytesFrom(std::uint32_t first) const {
        std::uint64_t bytes = 0;
        for (std::uint32_t level = first; level < levels(); ++level)
            bytes += std::uint64_t{(widthAt(level) + 3) / 4} * ((heightAt(level) + 3) / 4) *
                     blockBytes();
        return bytes;
    }
    bool operator==(const ImageShape&) const = default;
};

struct Image {
    ImageShape shape;
    std::vector<std::byte> blocks;  ///< shape.bytesFrom(0), the finest level first

    bool operator==(const Image&) const = default;
};

/// Where an image lies in a file.
struct ImageRecord {
    std::uint64_t offset = 0;
    std::uint64_t checksum = 0;  ///< xxh64
    std::uint32_t bytes = 0;
    ImageShape shape;
};
static_assert(sizeof(ImageRecord) == 40);

/// A run of a node's indices that have one material. Runs follow each other.
struct MaterialRange {
    std::uint32_t node = 0;
    std::uint32_t material = 0;
    std::uint32_t indexCount = 0;       ///< three a triangle
    std::uint32_t frontIndexCount = 0;  ///< as Node::frontIndexCount, of the run

    bool operator==(const MaterialRange&) const = default;
};
static_assert(sizeof(MaterialRange) == 16);

}  // namespace eyrie::mesh
