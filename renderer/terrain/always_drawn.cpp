// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/always_drawn.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "renderer/terrain/tile_triangulation.h"

namespace eyrie::terrain {
namespace {

/// Vertices around a hole that are looked at: more than there are around one point.
constexpr std::size_t kFewVertices = 16;

constexpr std::int32_t kBinsPerSide = 16;

using Indices = BoundedList<std::uint16_t>;

const Indices& part(std::span<const Indices> parts, int number) {
    return parts[static_cast<std::size_t>(number)];
}

std::vector<bool> usedBy(const Indices& indices, std::size_t vertices) {
    std::vector<bool> used(vertices);
    for (const std::uint16_t index : indices) used[index] = true;
    return used;
}

template <typename Visit>
void forEachSide(const Indices& indices, Visit visit) {
    for (std::size_t k = 0; k + 2 < indices.size(); k += 3)
        for (std::size_t e = 0; e < 3; ++e) {
            const auto [low, high] = std::minmax(indices[k + e], indices[k + (e + 1) % 3]);
            visit(low, high);
        }
}

std::vector<std::array<std::uint16_t, 2>> sortedSides(const Indices& indices) {
    std::vector<std::array<std::uint16_t, 2>> sides;
    forEachSide(indices, [&](std::uint16_t low, std::uint16_t high) {
        sides.push_back({low, high});
    });
    std::ranges::sort(sides);
    return sides;
}

}  // namespace

AlwaysDrawn::AlwaysDrawn(std::span<const Indices> parts, std::uint8_t finerEdges,
                         std::vector<Corner> corners)
    : corners_(std::move(corners)) {
    setVertices(parts, finerEdges);
    setBins();
    setSides(parts, finerEdges);
}

void AlwaysDrawn::setVertices(std::span<const Indices> parts, std::uint8_t finerEdges) {
    isDrawn_ = usedBy(part(parts, kInteriorPart), corners_.size());
    for (int edge = 0; edge < kEdges; ++edge) {
        const std::vector<bool> own = usedBy(part(parts, kOwnPart + edge), corners_.size());
        const std::vector<bool> finer =
            (finerEdges >> edge & 1) != 0 ? usedBy(part(parts, kFinerPart + edge), corners_.size())
                                          : own;
        for (std::size_t k = 0; k < isDrawn_.size(); ++k)
            isDrawn_[k] = isDrawn_[k] || (own[k] && finer[k]);
    }
    for (std::size_t k = 0; k < isDrawn_.size(); ++k)
        if (isDrawn_[k])
            vertices_.push_back(static_cast<std::uint16_t>(k));
}

std::size_t AlwaysDrawn::binOf(std::int32_t i, std::int32_t j) const {
    const auto at = [&](std::int32_t posts) {
        return std::clamp(posts / binPosts_, 0, kBinsPerSide - 1);
    };
    return static_cast<std::size_t>(at(j - j0_) * kBinsPerSide + at(i - i0_));
}

void AlwaysDrawn::setBins() {
    if (vertices_.empty())
        return;
    const auto column = [this](std::uint16_t vertex) { return corners_[vertex].i; };
    const auto row = [this](std::uint16_t vertex) { return corners_[vertex].j; };
    const auto [left, right] = std::ranges::minmax(vertices_, {}, column);
    const auto [low, high] = std::ranges::minmax(vertices_, {}, row);
    i0_ = column(left);
    j0_ = row(low);
    binPosts_ = std::max(column(right) - i0_, row(high) - j0_) / kBinsPerSide + 1;
    const auto bin = [&](std::uint16_t vertex) { return binOf(column(vertex), row(vertex)); };
    firstOfBin_.assign(kBinsPerSide * kBinsPerSide + 1, 0);
    for (const std::uint16_t vertex : vertices_) ++firstOfBin_[bin(vertex) + 1];
    std::partial_sum(firstOfBin_.begin(), firstOfBin_.end(), firstOfBin_.begin());
    std::ranges::stable_sort(vertices_, {}, bin);
}

/// Those of enough bins around a post.
std::vector<std::uint16_t> AlwaysDrawn::near(std::int32_t i, std::int32_t j) const {
    const auto middle = static_cast<std::int32_t>(binOf(i, j));
    const std::int32_t x = middle % kBinsPerSide;
    const std::int32_t y = middle / kBinsPerSide;
    std::vector<std::uint16_t> found;
    for (std::int32_t r = 1; found.size() < std::min(vertices_.size(), kFewVertices); ++r) {
        found.clear();
        for (std::int32_t v = std::max(0, y - r); v <= std::min(kBinsPerSide - 1, y + r); ++v) {
            // Bins of a row follow each other.
            const auto bin = [&](std::int32_t u) {
                return static_cast<std::size_t>(v * kBinsPerSide +
                                                std::clamp(u, 0, kBinsPerSide - 1));
            };
            found.insert(found.end(), vertices_.begin() + firstOfBin_[bin(x - r)],
                         vertices_.begin() + firstOfBin_[bin(x + r) + 1]);
        }
    }
    return found;
}

void AlwaysDrawn::setSides(std::span<const Indices> parts, std::uint8_t finerEdges) {
    std::vector<Side> ofBorders;
    for (int edge = 0; edge < kEdges; ++edge) {
        const std::vector<Side> own = sortedSides(part(parts, kOwnPart + edge));
        if ((finerEdges >> edge & 1) == 0)
            ofBorders.insert(ofBorders.end(), own.begin(), own.end());
        else
            std::ranges::set_intersection(own, sortedSides(part(parts, kFinerPart + edge)),
                                          std::back_inserter(ofBorders));
    }
    const auto forEach = [&](auto visit) {
        forEachSide(part(parts, kInteriorPart), visit);
        for (const auto& [low, high] : ofBorders) visit(low, high);
    };
    first_.assign(corners_.size() + 1, 0);
    forEach([&](std::uint16_t low, std::uint16_t) { ++first_[low]; });
    std::uint32_t end = 0;
    for (std::uint32_t& first : first_) first = end += first;
    ends_.resize(end);
    forEach([&](std::uint16_t low, std::uint16_t high) { ends_[--first_[low]] = high; });
}

bool AlwaysDrawn::isSide(std::uint16_t a, std::uint16_t b) const {
    const auto [low, high] = std::minmax(a, b);
    return std::ranges::count(sidesFrom(low), high) != 0;
}

std::vector<DrawnSide> AlwaysDrawn::of(const std::array<std::uint16_t, 3>& triangle) const {
    std::vector<DrawnSide> sides;
    const auto isDrawn = [&](std::uint16_t vertex) {
        return vertex != kAbsentPoint && isDrawn_[vertex];
    };
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint16_t a = triangle[k];
        const std::uint16_t b = triangle[(k + 1) % 3];
        if (isDrawn(a) && isDrawn(b) && isSide(a, b))
            sides.push_back({corners_[a], corners_[b]});
    }
    for (const std::uint16_t vertex : triangle)
        if (isDrawn(vertex))
            sides.push_back({corners_[vertex], corners_[vertex]});
    return sides;
}

std::vector<DrawnSide> AlwaysDrawn::around(const Triangle& t) const {
    const auto posts = [&](std::uint16_t vertex) {
        const Corner& corner = corners_[vertex];
        const std::int64_t di = 3 * std::int64_t{corner.i} - t[0].i - t[1].i - t[2].i;
        const std::int64_t dj = 3 * std::int64_t{corner.j} - t[0].j - t[1].j - t[2].j;
        return di * di + dj * dj;
    };
    std::vector<std::uint16_t> few(std::min(vertices_.size(), kFewVertices));
    std::ranges::partial_sort_copy(
        near((t[0].i + t[1].i + t[2].i) / 3, (t[0].j + t[1].j + t[2].j) / 3), few, {}, posts,
        posts);
    std::vector<DrawnSide> sides;
    for (const std::uint16_t a : few)
        for (const std::uint16_t b : few)
            if (a < b && isSide(a, b))
                sides.push_back({corners_[a], corners_[b]});
    for (const std::uint16_t vertex : few) sides.push_back({corners_[vertex], corners_[vertex]});
    return sides;
}

}  // namespace eyrie::terrain
