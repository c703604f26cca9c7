// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace eyrie::terrain {

/// What one byte keeps of a vertex's error: how many thresholds it exceeds, in the five high bits,
/// and how far the vertex's own triangles reach towards the next threshold, in eighths of the step,
/// in the three low bits. Of two bytes about the same vertex the greater one holds for both.
class DeviationScale {
public:
    static constexpr int kEighthBits = 3;
    static constexpr int kMaxThresholds = 30;

    DeviationScale() = default;
    /// `thresholds` ascend, kMaxThresholds at most. No height is greater than `highestMetres`.
    DeviationScale(std::vector<double> thresholds, double highestMetres);

    int thresholds() const { return static_cast<int>(thresholds_.size()); }
    std::span<const double> metres() const { return thresholds_; }
    /// Precondition: fewer than all are exceeded.
    double next(int exceeded) const { return thresholds_[static_cast<std::size_t>(exceeded)]; }
    /// Thresholds that a deviation exceeds, given that it, or another one as well, exceeds `known`.
    int exceededBy(double deviationMetres, int known = 0) const {
        while (known < thresholds() && deviationMetres > next(known)) ++known;
        return known;
    }

    static constexpr int exceeded(std::uint8_t code) { return code >> kEighthBits; }
    /// Of a vertex whose own triangles do not deviate by more than the others that it stands for.
    static constexpr std::uint8_t lowest(int exceeded) {
        return static_cast<std::uint8_t>(exceeded << kEighthBits);
    }
    /// Of a vertex of which nothing else is known.
    static constexpr std::uint8_t highest(int exceeded) {
        return static_cast<std::uint8_t>(((exceeded + 1) << kEighthBits) - 1);
    }
    /// `deviationMetres`: of the own triangles at most; not above next(exceeded).
    std::uint8_t code(int exceeded, double deviationMetres) const {
        const auto k = static_cast<std::size_t>(exceeded);
        const double eighths = (deviationMetres - last_[k]) * eighths_[k];
        return static_cast<std::uint8_t>(lowest(exceeded) |
                                         static_cast<int>(std::clamp(eighths, 0.0, 7.0)));
    }
    /// What a vertex's own triangles deviate from the source at most; rounding, in float as well,
    /// included.
    double greatestMetres(std::uint8_t code) const { return greatest_[code]; }

    /// For loops in float: thresholds, and by thresholds exceeded the last of them and eighths a
    /// metre from there.
    std::span<const float> floatMetres() const { return floatThresholds_; }
    const float* floatLast() const { return floatLast_.data(); }
    const float* floatEighths() const { return floatEighths_.data(); }

private:
    static constexpr std::size_t kClasses = 1 << (8 - kEighthBits);

    std::vector<double> thresholds_;
    std::array<double, kClasses> last_{};     ///< by thresholds exceeded
    std::array<double, kClasses> eighths_{};  ///< a metre
    std::array<double, 256> greatest_{};
    std::vector<float> floatThresholds_;
    std::array<float, kClasses> floatLast_{};
    std::array<float, kClasses> floatEighths_{};
};

}  // namespace eyrie::terrain
