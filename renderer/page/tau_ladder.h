// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace eyrie::page {

/// By how much tau must exceed what is asked for so that what a view needs fits into memory.
///
/// The factors are steps of a ladder, 2^(1/4) apart. Going up happens at once, since the limit is
/// hard; going down one step a frame, and only when what the lower step needs is clear of the
/// limit, so that a camera that moves along the edge of what fits does not load the same pages
/// again and again.
class TauLadder {
public:
    static constexpr int kSteps = 64;

    struct Choice {
        int step = 0;
        /// No lower step fits: the error is as low as it can be.
        bool isLowest = true;
    };

    int step() const { return step_; }
    /// Of the last step: infinite. Around an eye that is inside a tile's bounds no finite error is
    /// promised, so no finite factor would do.
    static double factor(int step) {
        return step < kSteps ? std::exp2(step / 4.0) : std::numeric_limits<double>::infinity();
    }

    /// `need(step)` says how many bytes the view needs at a step, and falls as steps rise.
    template <typename Need>
    Choice follow(const Need& need, std::uint64_t limitBytes) {
        if (need(step_) > limitBytes)
            step_ = lowest(need, limitBytes, step_ + 1);
        else if (step_ > 0 && need(step_ - 1) <= limitBytes / 10 * 9)
            --step_;
        return {step_, step_ == 0 || need(step_ - 1) > limitBytes};
    }

    /// The lowest step that fits, whatever was chosen before.
    template <typename Need>
    Choice settle(const Need& need, std::uint64_t limitBytes) {
        step_ = lowest(need, limitBytes, 0);
        return {step_, true};
    }

    /// The lowest step from `first` on that fits, or the last.
    template <typename Need>
    static int lowest(const Need& need, std::uint64_t limitBytes, int first) {
        if (first == 0 && need(0) <= limitBytes)
            return 0;
        int last = kSteps;
        while (first < last) {
            const int middle = (first + last) / 2;
            if (need(middle) <= limitBytes)
                last = middle;
            else
                first = middle + 1;
        }
        return last;
    }

private:
    int step_ = 0;
};

}  // namespace eyrie::page
