// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/load_map.h"

#include <cmath>
#include <cstddef>
#include <numeric>

namespace eyrie::equalizer {
namespace {

/// Of what is known of a part, how much a frame replaces by an even spread: least while all is as
/// foreseen, more where more of the load than noise explains was foreseen in the wrong part.
constexpr double kLeastForgotten = .02;
constexpr double kNoise = .15;
constexpr double kForgottenBeyond = 2;
constexpr double kMostForgotten = .3;
/// A time is believed in proportion to how far it is off what was foreseen, from this share on in
/// full: nearer to that it may be noise. docs/benchmarks.md has what comes of it.
constexpr double kSurprising = .3;
constexpr double kLeastBelieved = .1;

/// The first and past the last of `count` cells that [begin, end) meets.
struct Cells {
    Cells(double begin, double end, int count)
        : first(std::clamp(static_cast<int>(std::floor(begin * count)), 0, count - 1)),
          past(std::clamp(static_cast<int>(std::ceil(end * count)), first + 1, count)) {}

    int first;
    int past;
};

/// How much of cell `index` of `count` lies in [begin, end).
double lengthIn(int index, int count, double begin, double end) {
    return std::max(0.0, std::min(end, static_cast<double>(index + 1) / count) -
                             std::max(begin, static_cast<double>(index) / count));
}

}  // namespace

/// An area in cells.
struct LoadMap::Overlap {
    Cells columns;
    Cells rows;
};

LoadMap::LoadMap(int columns, int rows) : columns_(columns), rows_(rows) {}

double LoadMap::density(int row, int column) const {
    return densities_.empty() ? 1.0 : densities_[static_cast<std::size_t>(row * columns_ + column)];
}

LoadMap::Overlap LoadMap::overlap(const Area& area) const {
    return {{area.x, area.xEnd, columns_}, {area.y, area.yEnd, rows_}};
}

void LoadMap::record(std::span<const Measured> parts) {
    double measured = 0;
    double foreseen = 0;
    for (const Measured& part : parts) {
        measured += part.load;
        foreseen += load(part.part);
    }
    std::vector<double> expected;
    double wrong = 0;
    for (const Measured& part : parts) {
        expected.push_back(foreseen > 0 ? load(part.part) * measured / foreseen : part.load);
        wrong += std::abs(part.load - expected.back()) / measured;
    }
    const double forgotten =
        std::clamp(kForgottenBeyond * (wrong - kNoise), kLeastForgotten, kMostForgotten);
    std::vector<double> densities(
        static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0.0);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Measured part = parts[i];
        const double off = part.load - expected[i];
        const double share = std::abs(off) / std::max(part.load, expected[i]);
        part.load = expected[i] + off * std::clamp(share / kSurprising, kLeastBelieved, 1.0);
        add(part, forgotten, densities);
    }
    densities_ = std::move(densities);
}

void LoadMap::add(const Measured& part, double forgotten, std::vector<double>& densities) const {
    Area region = intersection(part.part, part.region);
    if (region.isEmpty())
        region = part.part;
    if (region.isEmpty())
        return;
    const double known = load(region);
    const double even = part.load / region.size();
    const double kept = known > 0 ? (1 - forgotten) * part.load / known : 0;
    const double fresh = known > 0 ? forgotten * even : even;
    const auto [columns, rows] = overlap(region);
    const double cellSize = 1.0 / columns_ / rows_;
    for (int row = rows.first; row < rows.past; ++row) {
        const double height = lengthIn(row, rows_, region.y, region.yEnd);
        for (int column = columns.first; column < columns.past; ++column) {
            const auto cell = static_cast<std::size_t>(row * columns_ + column);
            const double covered =
                height * lengthIn(column, columns_, region.x, region.xEnd) / cellSize;
            densities[cell] += covered * (kept * density(row, column) + fresh);
        }
    }
}

std::vector<double> LoadMap::profile(const Area& area, Axis axis) const {
    const auto [columns, rows] = overlap(area);
    const Cells& along = axis == Axis::X ? columns : rows;
    std::vector<double> loads(static_cast<std::size_t>(along.past - along.first), 0.0);
    for (int row = rows.first; row < rows.past; ++row) {
        const double height = lengthIn(row, rows_, area.y, area.yEnd);
        for (int column = columns.first; column < columns.past; ++column)
            loads[static_cast<std::size_t>((axis == Axis::X ? column : row) - along.first)] +=
                height * lengthIn(column, columns_, area.x, area.xEnd) * density(row, column);
    }
    return loads;
}

double LoadMap::load(const Area& area) const {
    const std::vector<double> loads = profile(area, Axis::X);
    return std::accumulate(loads.begin(), loads.end(), 0.0);
}

double LoadMap::cut(const Area& area, Axis axis, double share, double wanted) const {
    const std::vector<double> loads = profile(area, axis);
    const double total = std::accumulate(loads.begin(), loads.end(), 0.0);
    const double low = area.begin(axis);
    const double high = area.end(axis);
    if (!(total > 0))
        return low + share * (high - low);
    const int count = axis == Axis::X ? columns_ : rows_;
    const int first = Cells(low, high, count).first;
    // Sums that should be equal differ by rounding.
    const double least = share * total - 1e-12 * total;
    const double most = share * total + 1e-12 * total;
    double sum = 0;
    double earliest = low;
    double latest = high;
    bool isFound = false;
    for (std::size_t i = 0; i < loads.size(); ++i) {
        const int cell = first + static_cast<int>(i);
        const double begin = std::max(low, static_cast<double>(cell) / count);
        const double end = std::min(high, static_cast<double>(cell + 1) / count);
        const double after = sum + loads[i];
        if (!isFound && after >= least) {
            earliest = begin +
                       (loads[i] > 0 ? std::max(0.0, least - sum) / loads[i] : 0.0) * (end - begin);
            isFound = true;
        }
        if (after > most) {
            latest = begin + std::max(0.0, most - sum) / loads[i] * (end - begin);
            break;
        }
        sum = after;
    }
    return std::clamp(wanted, std::min(earliest, latest), std::max(earliest, latest));
}

}  // namespace eyrie::equalizer
