// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/terrain/hard_grids.h"

#include <array>
#include <cmath>

namespace eyrie::test {

std::uint64_t Random::next() {
    state_ += 0x9e3779b97f4a7c15;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
}

std::int32_t Random::integer(std::int32_t low, std::int32_t high) {
    return low + static_cast<std::int32_t>(next() % static_cast<std::uint64_t>(high - low + 1));
}

double Random::unit() { return static_cast<double>(next() >> 11) / 9007199254740992.0; }

std::string name(GridKind kind) {
    constexpr std::array<const char*, kGridKinds> kNames = {
        "noise", "smooth", "plane", "flat", "spikes", "cliff", "comb", "checkerboard", "terraces"};
    return kNames[static_cast<std::size_t>(kind)];
}

namespace {

double heightAt(GridKind kind, std::int32_t i, std::int32_t j, std::int32_t columns,
                Random& random) {
    switch (kind) {
        case GridKind::Noise:
            return 100 * random.unit();
        case GridKind::Smooth:
            return 300 * std::sin(i * 0.11) * std::cos(j * 0.07) + 0.3 * random.unit();
        case GridKind::Plane:
            return 12 + 0.1 * i - 0.3 * j;
        case GridKind::Flat:
            return 0;
        case GridKind::Spikes:
            return random.integer(0, 60) == 0 ? 500 * random.unit() : 0;
        case GridKind::Cliff:
            return i > columns / 3 ? 4000 : 0;
        case GridKind::Comb:
            return i % 2 == 0 ? 0 : 4000;
        case GridKind::Checkerboard:
            return (i + j) % 2 == 0 ? 20 : -20;
        case GridKind::Terraces:
            return std::floor(0.13 * i + 0.04 * j) * 3;
    }
    return 0;
}

}  // namespace

terrain::HeightGrid hardGrid(GridKind kind, std::int32_t columns, std::int32_t rows,
                             std::uint64_t seed) {
    Random random(seed);
    terrain::HeightGrid grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.origin = {500000, 5200000};
    grid.perColumn = {10, 0};
    grid.perRow = {0, 10};
    for (std::int32_t j = 0; j < rows; ++j)
        for (std::int32_t i = 0; i < columns; ++i)
            grid.heights.push_back(static_cast<float>(heightAt(kind, i, j, columns, random)));
    return grid;
}

}  // namespace eyrie::test
