// SPDX-License-Identifier: Apache-2.0
// K. Perlin, "Improving Noise", 2002; F. K. Musgrave, C. E. Kolb, R. S. Mace, "The Synthesis and
// Rendering of Eroded Fractal Terrains", 1989 (octaves weighed by the height so far: smooth
// valleys, rough ridges). Whole rows at a time, since within a row and a noise cell the two
// gradients on either side are linear in x.
#include "renderer/import/terrain_synth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "fabric/simd_clones.h"

namespace eyrie::import {
namespace {

constexpr std::int32_t kOctaves = 10;
constexpr std::int32_t kLongestWave = 1024;  // posts; a power of two
constexpr std::int32_t kRidgedOctaves = 4;
constexpr float kFirstAmplitude = 2400;  // metres
constexpr float kGain = 0.53F;

struct Gradient {
    float x;
    float y;
};

/// Sebastiano Vigna's splitmix64 finaliser.
std::uint64_t mixed(std::uint64_t value) {
    value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9;
    value = (value ^ value >> 27) * 0x94d049bb133111eb;
    return value ^ value >> 31;
}

Gradient gradientAt(std::int32_t x, std::int32_t y, std::uint64_t octaveSeed) {
    const std::uint64_t bits =
        mixed(octaveSeed ^ (static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint32_t>(x)));
    const auto unit = [](std::uint64_t b) {
        return static_cast<float>(static_cast<std::int32_t>(b & 0xffff) - 0x8000) / 32768.0F;
    };
    return {unit(bits), unit(bits >> 16)};
}

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// One noise cell in one row: the values that the gradients left and right of it imply.
struct CellRow {
    float left;
    float leftSlope;
    float right;  ///< at the cell's right end
    float rightSlope;
};

EYRIE_SIMD_CLONES void fillCell(const CellRow& cell, const float* t, const float* faded,
                                std::int32_t count, float* out) {
    for (std::int32_t k = 0; k < count; ++k) {
        const float left = cell.left + cell.leftSlope * t[k];
        const float right = cell.right + cell.rightSlope * (t[k] - 1);
        out[k] = left + faded[k] * (right - left);
    }
}

/// Adds an octave to a row and makes the next octaves' weights of what there is then.
EYRIE_SIMD_CLONES void addOctave(const float* noise, float amplitude, bool isRidged,
                                 std::int32_t count, float* height, float* weight) {
    constexpr float kRoughAbove = 900;  // metres
    for (std::int32_t i = 0; i < count; ++i) {
        const float shaped = isRidged ? 0.45F - 2 * std::abs(noise[i]) : noise[i];
        height[i] += amplitude * weight[i] * shaped;
        weight[i] = std::min(std::max(height[i] / kRoughAbove + 0.5F, 0.1F), 1.0F);
    }
}

/// One octave's rows: noise of wavelength 2^k posts.
class Octave {
public:
    Octave(std::int32_t wave, std::uint64_t seed) : wave_(wave), seed_(mixed(seed)) {
        for (std::int32_t k = 0; k < wave; ++k) {
            t_.push_back((static_cast<float>(k) + 0.37F) / static_cast<float>(wave));
            faded_.push_back(fade(t_.back()));
        }
    }

    void fillRow(std::int32_t j, std::int32_t count, float* out) const {
        const std::int32_t y = j / wave_;
        const float ty = t_[static_cast<std::size_t>(j % wave_)];
        const float v = faded_[static_cast<std::size_t>(j % wave_)];
        const auto columnOf = [&](std::int32_t x) {
            const Gradient low = gradientAt(x, y, seed_);
            const Gradient high = gradientAt(x, y + 1, seed_);
            return Gradient{low.x + v * (high.x - low.x),
                            low.y * ty + v * (high.y * (ty - 1) - low.y * ty)};
        };
        Gradient left = columnOf(0);
        for (std::int32_t i = 0; i < count; i += wave_) {
            const Gradient right = columnOf(i / wave_ + 1);
            fillCell({left.y, left.x, right.y, right.x}, t_.data(), faded_.data(),
                     std::min(wave_, count - i), out + i);
            left = right;
        }
    }

private:
    std::int32_t wave_;
    std::uint64_t seed_;
    std::vector<float> t_;
    std::vector<float> faded_;
};

}  // namespace

terrain::HeightGrid synthesizeTerrain(std::uint32_t posts, std::uint64_t seed) {
    terrain::HeightGrid grid;
    grid.columns = grid.rows = static_cast<std::int32_t>(posts);
    grid.heights.resize(static_cast<std::size_t>(posts) * posts);
    grid.origin = {500000, 5200000};
    grid.perColumn = {kSynthPostMetres, 0};
    grid.perRow = {0, kSynthPostMetres};

    std::vector<Octave> octaves;
    for (std::int32_t k = 0; k < kOctaves; ++k)
        octaves.emplace_back(kLongestWave >> k, seed * kOctaves + static_cast<std::uint64_t>(k));
    tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, grid.rows, 16),
                      [&](const tbb::blocked_range<std::int32_t>& range) {
                          std::vector<float> noise(posts);
                          std::vector<float> weight(posts);
                          for (std::int32_t j = range.begin(); j < range.end(); ++j) {
                              float* row = grid.row(j);
                              std::fill(weight.begin(), weight.end(), 1.0F);
                              std::fill(row, row + grid.columns, 500.0F);
                              float amplitude = kFirstAmplitude;
                              for (std::int32_t k = 0; k < kOctaves; ++k, amplitude *= kGain) {
                                  octaves[static_cast<std::size_t>(k)].fillRow(j, grid.columns,
                                                                               noise.data());
                                  addOctave(noise.data(), amplitude, k < kRidgedOctaves,
                                            grid.columns, row, weight.data());
                              }
                              std::transform(row, row + grid.columns, row,
                                             [](float h) { return std::max(h, 0.0F); });  // lakes
                          }
                      });
    return grid;
}

}  // namespace eyrie::import
