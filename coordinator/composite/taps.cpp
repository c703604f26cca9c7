// SPDX-License-Identifier: Apache-2.0
#include "coordinator/composite/taps.h"

#include <algorithm>
#include <cmath>

namespace eyrie::composite {
namespace {

using fabric::Regridding;

/// A regridding along one axis.
struct Along {
    std::int32_t begin;
    std::int32_t before;  ///< pixels of `of`
    std::int32_t made;
    std::int32_t first;
    std::int32_t every;
};

Along along(const Regridding& each, Axis axis) {
    if (axis == Axis::Columns)
        return {each.of.x, each.of.width, each.width, each.firstColumn, each.everyColumn};
    return {each.of.y, each.of.height, each.height, each.firstRow, each.everyRow};
}

/// The pixel or pixels at `position`, where pixel i reaches from i to i + 1, of `count` from
/// `begin` on, when each is shown by `shownBy` pixels.
Tap tapAt(double position, double shownBy, std::int32_t begin, std::int32_t count) {
    constexpr double kRounding = 1e-9;
    const auto within = [&](double pixel) {
        return begin + static_cast<std::int32_t>(std::clamp(pixel, 0.0, count - 1.0));
    };
    if (shownBy > 1 - kRounding && std::abs(shownBy - std::round(shownBy)) < kRounding) {
        const std::int32_t pixel = within(std::floor(position));
        return {pixel, pixel, 0};
    }
    const double left = std::floor(position - .5);
    return {within(left), within(left + 1), position - .5 - left};
}

/// One pixel on its way through regriddings, by its centre.
class Walk {
public:
    explicit Walk(std::int32_t pixel) : position_(pixel + .5) {}

    bool through(const Along& step, Regridding::Kind kind) {
        const double inside = position_ - step.begin;
        if (!(inside >= 0 && inside < step.before) || step.made < 1)
            return false;
        made_ = step.made;
        if (kind == Regridding::Kind::Zoom) {
            position_ = inside * step.made / step.before;
            shownBy_ *= static_cast<double>(step.before) / step.made;
            return true;
        }
        const auto pixel = static_cast<std::int32_t>(inside) - step.first;
        if (pixel < 0 || pixel % step.every != 0)
            return false;
        position_ = pixel / step.every + .5;
        shownBy_ = 1;
        return true;
    }

    Tap tap() const { return tapAt(position_, shownBy_, 0, made_); }

private:
    double position_;
    double shownBy_ = 1;
    std::int32_t made_ = 0;
};

}  // namespace

std::vector<Tap> tapsBehind(std::span<const Regridding> regriddings, Axis axis, std::int32_t begin,
                            std::int32_t count) {
    std::vector<Tap> taps(static_cast<std::size_t>(std::max(count, 0)));
    for (std::int32_t i = 0; i < count; ++i) {
        Walk walk(begin + i);
        const bool arrives = std::ranges::all_of(regriddings, [&](const Regridding& each) {
            return walk.through(along(each, axis), each.kind);
        });
        if (arrives)
            taps[static_cast<std::size_t>(i)] = walk.tap();
    }
    return taps;
}

std::vector<Tap> tapsBefore(const Regridding& zoom, Axis axis) {
    const Along step = along(zoom, axis);
    std::vector<Tap> taps;
    for (std::int32_t i = 0; i < step.made; ++i)
        taps.push_back(tapAt((i + .5) * step.before / step.made,
                             static_cast<double>(step.made) / step.before, step.begin,
                             step.before));
    return taps;
}

}  // namespace eyrie::composite
