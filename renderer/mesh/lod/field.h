// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

/// What is linear on the triangles of a surface, between what it is at their corners: light and
/// opacity, or normals before they are brought to length one.
namespace eyrie::mesh {

/// Four numbers; of normals the fourth is 0.
using FieldValue [[gnu::vector_size(16)]] = float;

inline FieldValue larger(const FieldValue& a, const FieldValue& b) { return a > b ? a : b; }
inline FieldValue smaller(const FieldValue& a, const FieldValue& b) { return a < b ? a : b; }

/// The least and the most of some values, each number apart.
struct FieldRange {
    FieldValue least;
    FieldValue most;

    static FieldRange of(const FieldValue& one) { return {one, one}; }
    void hold(const FieldValue& one) {
        least = smaller(least, one);
        most = larger(most, one);
    }
    void hold(const FieldRange& other) {
        hold(other.least);
        hold(other.most);
    }
    /// Whether the two are the same.
    bool isOne() const {
        return least[0] == most[0] && least[1] == most[1] && least[2] == most[2] &&
               least[3] == most[3];
    }
};

inline FieldRange rangeOf(const std::array<FieldValue, 3>& corners) {
    FieldRange range = FieldRange::of(corners[0]);
    range.hold(corners[1]);
    range.hold(corners[2]);
    return range;
}

/// What a triangle of a patch may have done to what the source has at points that have partners on
/// it: how much more and less it shows, and what the source has there.
///
/// Like the ways that points go (shifts.h), changes add up from step to step, those up and those
/// down apart. They cannot be more than what is shown is above or below what the source has: of
/// noise, where steps never cancel, that is the lesser.
class FieldChanges {
public:
    FieldChanges() = default;  ///< as it comes: arrays of them are filled, and often
    /// Of a triangle of the source.
    explicit FieldChanges(const FieldRange& corners) : up_{}, down_{}, source_(corners) {}

    void hold(const FieldChanges& other) {
        up_ = larger(up_, other.up_);
        down_ = larger(down_, other.down_);
        source_.hold(other.source_);
    }

    /// Each change, and then one of `step`, on a triangle that shows `shown`. Precondition: `step`
    /// holds 0.
    FieldChanges andThen(const FieldRange& step, const FieldRange& shown) const {
        FieldChanges sum = *this;
        sum.up_ = withinReason(up_ + step.most + kRounding, shown.most - source_.least);
        sum.down_ = withinReason(down_ - step.least + kRounding, source_.most - shown.least);
        return sum;
    }

    const FieldValue& up() const { return up_; }      ///< 0 or more
    const FieldValue& down() const { return down_; }  ///< 0 or more
    const FieldRange& source() const { return source_; }

private:
    /// More than rounding adds in a step, of values within 1.
    static constexpr float kRounding = 1e-6F;

    static FieldValue withinReason(const FieldValue& sum, const FieldValue& most) {
        return larger(smaller(sum, most), FieldValue{});
    }

    FieldValue up_;
    FieldValue down_;
    FieldRange source_;
};

}  // namespace eyrie::mesh
