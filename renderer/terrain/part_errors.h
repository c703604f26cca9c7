// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "renderer/terrain/eyt_format.h"

namespace eyrie::terrain {

/// Greatest deviations of a tile's 4 x 4 parts, see TileRecord::partErrors.
class PartErrors {
public:
    /// Columns x0 to x1 and rows y0 to y1 of a tile, in half sample spacings; they may reach beyond
    /// it. Precondition: neither side is 0.
    struct Rectangle {
        std::int32_t x0, y0, x1, y1;
    };

    /// Of a tile of that many cells a side, none of which deviates yet.
    explicit PartErrors(std::int32_t cells = kFinestTileCells)
        : shift_(std::bit_width(static_cast<std::uint32_t>(2 * cells / kTilePartsPerSide)) - 1) {}

    /// The least of the parts of which the rectangle covers some.
    double least(const Rectangle& covered) const {
        const Span parts = over(covered);
        double least = at(parts.x0, parts.y0);
        if (parts.isOne()) [[likely]]
            return least;
        for (std::int32_t y = parts.y0; y <= parts.y1; ++y)
            for (std::int32_t x = parts.x0; x <= parts.x1; ++x) least = std::min(least, at(x, y));
        return least;
    }

    /// Counts a deviation for all these parts.
    void raise(const Rectangle& covered, double deviationMetres) {
        const Span parts = over(covered);
        if (parts.isOne()) [[likely]]
            return raiseOne(parts.x0, parts.y0, deviationMetres);
        for (std::int32_t y = parts.y0; y <= parts.y1; ++y)
            for (std::int32_t x = parts.x0; x <= parts.x1; ++x) raiseOne(x, y, deviationMetres);
    }

    /// Bits, as TileRecord::nodataParts has them, of the parts of which the rectangle covers some.
    std::uint16_t mask(const Rectangle& covered) const {
        const Span parts = over(covered);
        const int row = (2 << parts.x1) - (1 << parts.x0);
        int mask = 0;
        for (std::int32_t y = parts.y0; y <= parts.y1; ++y) mask |= row << kTilePartsPerSide * y;
        return static_cast<std::uint16_t>(mask);
    }

    double metres(std::int32_t x, std::int32_t y) const { return at(x, y); }
    double greatest() const { return *std::max_element(metres_.begin(), metres_.end()); }

private:
    struct Span {
        std::int32_t x0, y0, x1, y1;
        bool isOne() const { return x0 == x1 && y0 == y1; }
    };

    std::int32_t part(std::int32_t position) const {
        return std::clamp(position >> shift_, 0, kTilePartsPerSide - 1);
    }
    Span over(const Rectangle& r) const {
        return {part(r.x0), part(r.y0), part(r.x1 - 1), part(r.y1 - 1)};
    }
    static std::size_t index(std::int32_t x, std::int32_t y) {
        return static_cast<std::size_t>(y * kTilePartsPerSide + x);
    }
    double at(std::int32_t x, std::int32_t y) const { return metres_[index(x, y)]; }
    void raiseOne(std::int32_t x, std::int32_t y, double deviationMetres) {
        double& metres = metres_[index(x, y)];
        metres = std::max(metres, deviationMetres);
    }

    int shift_;  ///< a part's side is 2^shift_ half spacings
    std::array<double, kTilePartsPerSide * kTilePartsPerSide> metres_{};
};

}  // namespace eyrie::terrain
