// SPDX-License-Identifier: Apache-2.0
#include "fabric/frame_budget.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::fabric {
namespace {

constexpr double kStepsADoubling = 4;

/// The taus that a budget may choose from.
class Ladder {
public:
    explicit Ladder(double lowest) : lowest_(lowest), highest_(std::max(lowest, kBudgetTauPixels)) {
        last_ = static_cast<int>(std::ceil(kStepsADoubling * std::log2(highest_ / lowest_)));
    }

    int last() const { return last_; }
    double tau(int step) const {
        return step == last_ ? highest_ : lowest_ * std::exp2(step / kStepsADoubling);
    }
    int nearest(double tau) const {
        const double step = std::round(kStepsADoubling * std::log2(tau / lowest_));
        return static_cast<int>(std::clamp(step, 0.0, static_cast<double>(last_)));
    }

private:
    double lowest_;
    double highest_;
    int last_;
};

/// Looks for the lowest step that fits, from that of the frame before.
class Search {
public:
    Search(double tauAsked, const FrameBudget& budget, double covered,
           const CutTriangles& triangles)
        : ladder_(tauAsked), budget_(budget), covered_(covered), triangles_(triangles) {}

    BudgetUse run() {
        at_ = budget_.lastTauPixels > 0 ? ladder_.nearest(budget_.lastTauPixels) : ladder_.last();
        tried_ = at(at_);
        best_ = tried_;
        if (tried_.predictedMilliseconds > budget_.milliseconds)
            searchBetween(at_, ladder_.last() + 1);
        else if (fits(tried_))
            searchBetween(-1, at_);
        return best_;
    }

private:
    bool fits(const BudgetUse& use) const {
        return use.predictedMilliseconds <= kBudgetAim * budget_.milliseconds;
    }

    BudgetUse at(int step) const {
        const double tau = ladder_.tau(step);
        const std::uint64_t triangles = triangles_(tau);
        return {budget_.milliseconds, budget_.predict(covered_, triangles), tau, triangles,
                covered_};
    }

    /// Where the step that fits is thought to be. Triangles fall at least as tau rises and at most
    /// as its square: either way the guess is rather too coarse, whose cut is quickly made.
    int guess() const {
        const double fixed = budget_.predict(covered_, 0);
        const double room = kBudgetAim * budget_.milliseconds - fixed;
        const double cost = tried_.predictedMilliseconds - fixed;
        if (!(room > 0))
            return ladder_.last();
        if (!(cost > 0))
            return 0;
        const double steps = kStepsADoubling * std::log2(cost / room);
        const double careful = steps > 0 ? std::ceil(steps) : std::ceil(steps / 2);
        return at_ + static_cast<int>(std::clamp(careful, -1e3, 1e3));
    }

    /// Leaves in best_ the lowest step above `tooLow` that fits, if any below `high` does; else
    /// what it held, or the last step.
    void searchBetween(int tooLow, int high) {
        while (high - tooLow > 1) {
            at_ = std::clamp(guess(), tooLow + 1, high - 1);
            tried_ = at(at_);
            const bool isFit = fits(tried_);
            (isFit ? high : tooLow) = at_;
            if (isFit || at_ == ladder_.last())
                best_ = tried_;
        }
    }

    const Ladder ladder_;
    const FrameBudget& budget_;
    const double covered_;
    const CutTriangles& triangles_;
    int at_ = 0;       ///< the step of tried_
    BudgetUse tried_;  ///< last
    BudgetUse best_;
};

constexpr double kGreatest = 1e6;  ///< of what a budget holds beside its milliseconds

absl::Status checkNotNegative(double value, std::string_view field) {
    if (value >= 0 && value <= kGreatest)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("budget.{} is {}; it must be from 0 to {}", field, value, kGreatest));
}

}  // namespace

absl::Status validateBudgetMilliseconds(double milliseconds) {
    if (milliseconds >= kMinBudgetMilliseconds && milliseconds <= kMaxBudgetMilliseconds)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("the frame time to hold is {} ms; it must be from {} to {} ms", milliseconds,
                    kMinBudgetMilliseconds, kMaxBudgetMilliseconds));
}

absl::Status validate(const FrameBudget& budget) {
    RETURN_IF_ERROR(validateBudgetMilliseconds(budget.milliseconds));
    RETURN_IF_ERROR(checkNotNegative(budget.fixedMilliseconds, "fixed_milliseconds"));
    RETURN_IF_ERROR(checkNotNegative(budget.millisecondsATriangle, "milliseconds_a_triangle"));
    return checkNotNegative(budget.lastTauPixels, "last_tau_pixels");
}

BudgetUse tauForBudget(double tauAskedPixels, const FrameBudget& budget, double covered,
                       const CutTriangles& triangles) {
    return Search(tauAskedPixels, budget, covered, triangles).run();
}

}  // namespace eyrie::fabric
