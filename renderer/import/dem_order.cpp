// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dem_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <ogr_srs_api.h>

#include "renderer/import/joined_dems.h"
#include "renderer/import/layered_dems.h"

namespace eyrie::import {
namespace {

using fabric::Vec2;

constexpr double kEquallyFine = 0.01;

/// Side of a pixel, about.
double pixelMetres(const DemFile& file) {
    constexpr double kMetresPerDegree = 111320;
    const double side = std::sqrt(std::abs(determinant(file.reference)));
    if (file.isGeographic())
        return side * kMetresPerDegree *
               std::sqrt(std::max(0.01, std::cos(glm::radians(centreOf(file).y))));
    return file.crs ? side * OSRGetLinearUnits(file.crs.get(), nullptr) : side;
}

/// From the middle of its box to its rim.
Vec2 reachOf(const DemFile& file) {
    return (glm::abs(file.reference.perColumn * static_cast<double>(file.columns)) +
            glm::abs(file.reference.perRow * static_cast<double>(file.rows))) *
           0.5;
}

/// Whether two may both have data for a place, but for rows and columns that neighbours share.
bool mayOverlap(const DemFile& a, const DemFile& b) {
    if (!isSameCrs(a.crs.get(), b.crs.get()))
        return true;
    Vec2 between = centreOf(a) - centreOf(b);
    if (a.isGeographic())
        between.x -= 360 * std::round(between.x / 360);
    const auto pixel = [](const DemFile& file) {
        return glm::max(glm::abs(file.reference.perColumn), glm::abs(file.reference.perRow));
    };
    const Vec2 rim = glm::max(pixel(a), pixel(b)) * (1 + 1e-3);
    const Vec2 least = reachOf(a) + reachOf(b) - rim;
    return std::abs(between.x) < least.x && std::abs(between.y) < least.y;
}

}  // namespace

std::vector<std::size_t> bestFirst(const std::vector<DemFile>& files) {
    std::vector<std::pair<double, std::size_t>> bySize;
    for (std::size_t k = files.size(); k-- > 0;) bySize.emplace_back(pixelMetres(files[k]), k);
    std::ranges::stable_sort(bySize, {}, &std::pair<double, std::size_t>::first);
    std::vector<std::size_t> order;
    for (std::size_t first = 0; first < bySize.size();) {
        std::size_t end = first;
        while (end < bySize.size() && bySize[first].first >= bySize[end].first * (1 - kEquallyFine))
            order.push_back(bySize[end++].second);
        std::sort(order.end() - static_cast<std::ptrdiff_t>(end - first), order.end(),
                  std::greater<>());
        first = end;
    }
    return order;
}

std::vector<std::vector<std::size_t>> runsOf(const std::vector<DemFile>& files,
                                             const std::vector<std::size_t>& order,
                                             const std::function<bool(const DemFile&)>& isAlone) {
    std::vector<std::vector<std::size_t>> runs;
    std::vector<std::size_t> left = order;
    while (!left.empty()) {
        const DemFile& first = files[left.front()];
        const bool mayBeJoined = !isAlone(first);
        std::vector<std::size_t>& run = runs.emplace_back(1, left.front());
        std::vector<std::size_t> passed;
        for (std::size_t i = 1; i < left.size(); ++i) {
            const DemFile& next = files[left[i]];
            const bool joins = mayBeJoined && isOneGrid(first, next) && !isAlone(next) &&
                               std::ranges::none_of(passed, [&](std::size_t k) {
                                   return mayOverlap(files[k], next);
                               });
            (joins ? run : passed).push_back(left[i]);
        }
        left = std::move(passed);
    }
    return runs;
}

}  // namespace eyrie::import
