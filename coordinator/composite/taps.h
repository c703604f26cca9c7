// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fabric/regridding.h"

/// Which pixels of one picture a pixel of another shows, where they have different pixels. Columns
/// and rows are alike, and independent of each other.
namespace eyrie::composite {

enum class Axis { Columns, Rows };

/// One or two neighbours, and the second's weight. None: the pixel shows nothing of the other.
struct Tap {
    static constexpr std::int32_t kNone = -1;

    std::int32_t first = kNone;
    std::int32_t second = kNone;
    double weight = 0;

    bool isNone() const { return first == kNone; }
    std::int32_t nearest() const { return weight < .5 ? first : second; }
    bool operator==(const Tap&) const = default;
};

/// For pixels `begin`, `begin` + 1, … before `regriddings`: those behind them, which bring a frame
/// back to where it was made from. Every n-th pixel has its own, the others none. Of a zoom the
/// nearest pixel where a whole number of pixels shows each one, else two by distance between
/// centres (bilinear).
std::vector<Tap> tapsBehind(std::span<const fabric::Regridding> regriddings, Axis axis,
                            std::int32_t begin, std::int32_t count);

/// For each pixel that `zoom` makes: those before it, nearest or bilinear likewise.
std::vector<Tap> tapsBefore(const fabric::Regridding& zoom, Axis axis);

}  // namespace eyrie::composite
