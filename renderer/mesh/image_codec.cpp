// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/image_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <glm/vec4.hpp>

#define STB_DXT_STATIC
#define STB_DXT_IMPLEMENTATION
#include <stb/stb_dxt.h>

#include "renderer/mesh/vertex_packing.h"
#include "renderer/terrain/imagery/bc1.h"

namespace eyrie::mesh {
namespace {

using terrain::BlockTexels;
using Texels = std::vector<fabric::Rgba>;

constexpr std::size_t kAlphaBytes = 8;  ///< of a block, before the colours' eight

/// Texels a side of images that may be palettes, in which each is the colour of something. Enlarged
/// they take 44 KB at most, twice that with alpha.
constexpr std::uint32_t kMostEnlargedSide = 64;
constexpr std::uint32_t kEnlargement = 4;  ///< to a block for each texel
constexpr double kMostBlockError = 20;     ///< root of the mean square, of 255

/// What a texel of a coarser level covers along one axis: texels from `first` on, by share.
struct Cover {
    std::uint32_t first = 0;
    std::array<float, 3> shares{};
};

std::vector<Cover> coversOf(std::uint32_t fine, std::uint32_t coarse) {
    std::vector<Cover> covers(coarse);
    for (std::uint32_t i = 0; i < coarse; ++i) {
        // In parts of which a fine texel has `coarse`, and a coarse one `fine`.
        const std::uint32_t begin = i * fine;
        const std::uint32_t end = begin + fine;
        covers[i].first = begin / coarse;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t from = std::max(begin, (covers[i].first + k) * coarse);
            const std::uint32_t to = std::min(end, (covers[i].first + k + 1) * coarse);
            covers[i].shares[k] =
                to > from ? static_cast<float>(to - from) / static_cast<float>(fine) : 0;
        }
    }
    return covers;
}

std::uint8_t byteOf(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// Means of squares, those of texels that show counting more; of texels that do not show at all,
/// as if they did.
class Mean {
public:
    void add(const fabric::Rgba& texel, float share) {
        const glm::vec4 colour(texel.r, texel.g, texel.b, 1);
        const glm::vec4 squares = colour * colour;
        shown_ += squares * (share * static_cast<float>(texel.a));
        all_ += squares * share;
    }
    fabric::Rgba value() const {
        const glm::vec4& sum = shown_.w > 0 ? shown_ : all_;
        const auto root = [&](float squares) { return byteOf(std::sqrt(squares / sum.w)); };
        return {root(sum.x), root(sum.y), root(sum.z), byteOf(shown_.w / all_.w)};
    }

private:
    glm::vec4 shown_{0};
    glm::vec4 all_{0};
};

Texels coarser(const Texels& fine, const ImageShape& shape, std::uint32_t level) {
    const std::vector<Cover> across = coversOf(shape.widthAt(level - 1), shape.widthAt(level));
    const std::vector<Cover> down = coversOf(shape.heightAt(level - 1), shape.heightAt(level));
    Texels texels;
    texels.reserve(across.size() * down.size());
    for (const Cover& row : down)
        for (const Cover& column : across) {
            Mean mean;
            for (std::uint32_t y = 0; y < 3; ++y)
                for (std::uint32_t x = 0; x < 3; ++x)
                    if (const float share = row.shares[y] * column.shares[x]; share > 0)
                        mean.add(fine[std::size_t{row.first + y} * shape.widthAt(level - 1) +
                                      column.first + x],
                                 share);
            texels.push_back(mean.value());
        }
    return texels;
}

/// Appends one block to `blocks`.
void encodeBlock(BlockTexels texels, bool hasAlpha, std::vector<std::byte>& blocks) {
    if (hasAlpha) {
        std::array<unsigned char, 16> alphas{};
        for (std::size_t k = 0; k < alphas.size(); ++k) alphas[k] = texels[k].a;
        std::array<std::byte, kAlphaBytes> coded{};
        stb_compress_bc4_block(reinterpret_cast<unsigned char*>(coded.data()), alphas.data());
        blocks.insert(blocks.end(), coded.begin(), coded.end());
    }
    for (fabric::Rgba& texel : texels) texel.a = 255;
    const auto colours =
        std::bit_cast<std::array<std::byte, sizeof(terrain::Bc1Block)>>(terrain::encodeBc1(texels));
    blocks.insert(blocks.end(), colours.begin(), colours.end());
}

void encodeLevel(const ImageShape& shape, std::uint32_t level, const Texels& texels,
                 std::vector<std::byte>& blocks) {
    const std::uint32_t width = shape.widthAt(level);
    const std::uint32_t height = shape.heightAt(level);
    for (std::uint32_t y = 0; y < height; y += 4)
        for (std::uint32_t x = 0; x < width; x += 4) {
            BlockTexels block;
            for (std::uint32_t k = 0; k < 16; ++k)
                block[k] = texels[std::size_t{std::min(y + k / 4, height - 1)} * width +
                                  std::min(x + k % 4, width - 1)];
            encodeBlock(block, shape.hasAlpha(), blocks);
        }
}

/// Eight alphas, of which each texel names one in three bits: BC4's block.
std::array<std::uint8_t, 16> decodeAlphas(const std::byte* block) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, block, kAlphaBytes);
    const auto first = static_cast<unsigned>(bits & 255U);
    const auto second = static_cast<unsigned>(bits >> 8 & 255U);
    std::array<std::uint8_t, 8> palette{
        static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second), 0, 0, 0, 0, 0, 255};
    const unsigned parts = first > second ? 7 : 5;
    for (unsigned k = 1; k < parts; ++k)
        palette[k + 1] =
            static_cast<std::uint8_t>(((parts - k) * first + k * second + parts / 2) / parts);
    std::array<std::uint8_t, 16> alphas{};
    for (unsigned k = 0; k < 16; ++k) alphas[k] = palette[bits >> (16 + 3 * k) & 7U];
    return alphas;
}

/// What coding has made of texels.
class Difference {
public:
    explicit Difference(bool hasAlpha) : hasAlpha_(hasAlpha) {}

    void add(const fabric::Rgba& source, const fabric::Rgba& coded) {
        if (source.a > 0) {
            ofColours_ +=
                square(source.r, coded.r) + square(source.g, coded.g) + square(source.b, coded.b);
            ++shown_;
        }
        ofAlpha_ += hasAlpha_ ? square(source.a, coded.a) : 0;
        ++all_;
    }
    /// Root of the mean square, over texels that show, of their colours, or over all of alpha where
    /// that is more.
    double rms() const {
        const double colours = shown_ > 0 ? ofColours_ / (3 * static_cast<double>(shown_)) : 0;
        return std::sqrt(std::max(colours, ofAlpha_ / static_cast<double>(all_)));
    }

private:
    static double square(int a, int b) { return static_cast<double>((a - b) * (a - b)); }

    bool hasAlpha_;
    double ofColours_ = 0;
    double ofAlpha_ = 0;
    std::size_t shown_ = 0;
    std::size_t all_ = 0;
};

struct Errors {
    double ofAll = 0;
    double ofWorstBlock = 0;
};

/// Of the finest level.
Errors errorsOf(const Image& image, const Texels& texels) {
    const ImageShape& shape = image.shape;
    const Texels coded = decodeLevel(shape, image.blocks, 0);
    const std::size_t stride = (shape.width + 3) / 4 * 4;
    Difference all(shape.hasAlpha());
    Errors errors;
    for (std::size_t top = 0; top < shape.height; top += 4)
        for (std::size_t left = 0; left < shape.width; left += 4) {
            Difference block(shape.hasAlpha());
            for (std::size_t y = top; y < std::min<std::size_t>(top + 4, shape.height); ++y)
                for (std::size_t x = left; x < std::min<std::size_t>(left + 4, shape.width); ++x) {
                    all.add(texels[y * shape.width + x], coded[y * stride + x]);
                    block.add(texels[y * shape.width + x], coded[y * stride + x]);
                }
            errors.ofWorstBlock = std::max(errors.ofWorstBlock, block.rms());
        }
    errors.ofAll = all.rms();
    return errors;
}

/// Each texel four times in each direction, so that a block has one colour.
Texels enlarged(const ImageShape& shape, const Texels& texels) {
    Texels large(texels.size() * 16);
    for (std::size_t i = 0; i < large.size(); ++i)
        large[i] = texels[i / (16 * shape.width) * shape.width + i / 4 % shape.width];
    return large;
}

Image encodeLevels(const ImageShape& shape, const Texels& texels) {
    Image image{shape, {}};
    image.blocks.reserve(shape.bytesFrom(0));
    Texels level = texels;
    encodeLevel(shape, 0, level, image.blocks);
    for (std::uint32_t i = 1; i < shape.levels(); ++i) {
        level = coarser(level, shape, i);
        encodeLevel(shape, i, level, image.blocks);
    }
    image.shape.meanColour = packColour(level.front());
    return image;
}

}  // namespace

Image encodeImage(const ImageShape& shape, std::vector<fabric::Rgba> texels) {
    if (!shape.hasAlpha())
        for (fabric::Rgba& texel : texels) texel.a = 255;
    Image image = encodeLevels(shape, texels);
    const Errors errors = errorsOf(image, texels);
    image.shape.rmsError = static_cast<float>(errors.ofAll);
    const bool isSmall = std::max(shape.width, shape.height) <= kMostEnlargedSide;
    if (!isSmall || errors.ofWorstBlock <= kMostBlockError)
        return image;
    ImageShape large = shape;
    large.width *= kEnlargement;
    large.height *= kEnlargement;
    texels = enlarged(shape, texels);
    image = encodeLevels(large, texels);
    image.shape.rmsError = static_cast<float>(errorsOf(image, texels).ofAll);
    return image;
}

std::vector<fabric::Rgba> decodeLevel(const ImageShape& shape, std::span<const std::byte> blocks,
                                      std::uint32_t level) {
    const std::size_t blocksX = (shape.widthAt(level) + 3) / 4;
    const std::size_t count = blocksX * ((shape.heightAt(level) + 3) / 4);
    const std::byte* at = blocks.data() + (shape.bytesFrom(0) - shape.bytesFrom(level));
    std::vector<terrain::Bc1Block> colours(count);
    Texels texels(count * 16);
    for (std::size_t k = 0; k < count; ++k)
        std::memcpy(&colours[k], at + k * shape.blockBytes() + (shape.hasAlpha() ? kAlphaBytes : 0),
                    sizeof(terrain::Bc1Block));
    terrain::decodeBc1(colours, static_cast<std::int32_t>(blocksX), texels);
    if (!shape.hasAlpha())
        return texels;
    for (std::size_t k = 0; k < count; ++k) {
        const std::array<std::uint8_t, 16> alphas = decodeAlphas(at + k * shape.blockBytes());
        for (std::size_t texel = 0; texel < 16; ++texel)
            texels[(k / blocksX * 4 + texel / 4) * 4 * blocksX + k % blocksX * 4 + texel % 4].a =
                alphas[texel];
    }
    return texels;
}

}  // namespace eyrie::mesh
