// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/budget_keeper.h"

#include <algorithm>
#include <cmath>

namespace eyrie::coordinator {
namespace {

/// How clear of the coarsest tau a larger picture is to begin.
constexpr double kClearOfCoarsest = 0.7;

double pixelsAfter(int halvings) { return std::exp2(-halvings); }

int scaled(int side, int halvings) {
    return std::max(1, static_cast<int>(std::lround(side * std::sqrt(pixelsAfter(halvings)))));
}

}  // namespace

BudgetPlan BudgetKeeper::plan(const FrameRequest& request) const {
    return {budgetOf(request), scaled(request.width, halvings_), scaled(request.height, halvings_)};
}

fabric::FrameBudget BudgetKeeper::budgetOf(const FrameRequest& request) const {
    return {*request.budgetMilliseconds, cost_.fixedMilliseconds(), cost_.millisecondsATriangle(),
            lastTauPixels_};
}

void BudgetKeeper::record(const FrameRequest& request, const fabric::FrameStatistics& statistics,
                          double milliseconds) {
    if (!statistics.budget)
        return;
    fabric::BudgetUse use = *statistics.budget;
    lastTauPixels_ = use.tauPixels;
    const bool hasWaited =
        request.completeness == fabric::Completeness::Complete && statistics.pagesLoaded > 0;
    if (hasWaited || request.measuresStages)
        return;
    // Until its data are there a frame is drawn with others, mostly fewer, triangles.
    const double triangles = static_cast<double>(
        statistics.complete ? use.triangles : std::min(use.triangles, statistics.triangles));
    cost_.record(fabric::FrameBudget::fixedShare(use.covered), triangles, milliseconds);
    use.predictedMilliseconds = budgetOf(request).predict(use.covered, use.triangles);
    resize(use, std::max(statistics.tauAskedPixels, fabric::kBudgetTauPixels));
}

/// `use` with the time that it is foreseen to take by what is known now.
void BudgetKeeper::resize(const fabric::BudgetUse& use, double coarsestTau) {
    const int before = halvings_;
    const double over = use.predictedMilliseconds / use.milliseconds;
    if (use.tauPixels >= coarsestTau && over > 1) {
        halvings_ += static_cast<int>(std::ceil(std::log2(std::min(over, 1e3))));
        halvings_ = std::min(halvings_, kHalvings);
    } else {
        const double fixed =
            cost_.fixedMilliseconds() * fabric::FrameBudget::fixedShare(use.covered);
        const double drawing = use.predictedMilliseconds - fixed;
        const auto mayBe = [&](int halvings) {
            const double pixels = pixelsAfter(halvings - before);
            return use.tauPixels * std::sqrt(pixels) <= kClearOfCoarsest * coarsestTau &&
                   fixed * pixels + drawing <= fabric::kBudgetAim * use.milliseconds;
        };
        while (halvings_ > 0 && mayBe(halvings_ - 1)) --halvings_;
    }
    if (halvings_ != before) {
        const double pixels = pixelsAfter(halvings_ - before);
        cost_.resized(pixels);
        lastTauPixels_ *= std::sqrt(pixels);
    }
}

BudgetKeeper& BudgetKeepers::of(const FrameRequest& request) {
    const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) {
        return kept.width == request.width && kept.height == request.height &&
               kept.shading == request.shading;
    });
    if (found != kept_.end())
        kept_.splice(kept_.begin(), kept_, found);
    else
        kept_.push_front({request.width, request.height, request.shading, {}});
    if (kept_.size() > kMostKept)
        kept_.pop_back();
    return kept_.front().keeper;
}

}  // namespace eyrie::coordinator
