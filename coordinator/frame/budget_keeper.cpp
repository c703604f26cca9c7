// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/budget_keeper.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fabric/smaller_picture.h"

namespace eyrie::coordinator {
namespace {

/// How clear of the coarsest tau a larger picture is to begin.
constexpr double kClearOfCoarsest = 0.7;

/// Of the budget, what an easy frame takes less than.
constexpr double kEasy = 0.25;

double pixelsAfter(int halvings) { return std::exp2(-halvings); }

}  // namespace

bool tellsItsCost(const FrameRequest& request, const fabric::FrameStatistics& statistics) {
    const bool hasWaited =
        request.completeness == fabric::Completeness::Complete && statistics.pagesLoaded > 0;
    return !hasWaited && !request.measuresStages;
}

BudgetPlan BudgetKeeper::plan(const FrameRequest& request) const {
    const double margin = view_.isCut(request.camera) ? margin_.factor() : 1;
    const auto [width, height] =
        fabric::smallerPicture(request.width, request.height, std::sqrt(pixelsAfter(halvings_)));
    return {budgetOf(request, margin), width, height};
}

fabric::FrameBudget BudgetKeeper::budgetOf(const FrameRequest& request, double margin) const {
    return {*request.budgetMilliseconds, margin * cost_.fixedMilliseconds(),
            margin * cost_.millisecondsATriangle(), lastTauPixels_};
}

void BudgetKeeper::record(const FrameRequest& request, const fabric::FrameStatistics& statistics,
                          double milliseconds) {
    if (!statistics.budget)
        return;
    fabric::BudgetUse use = *statistics.budget;
    lastTauPixels_ = use.tauPixels;
    if (!tellsItsCost(request, statistics))
        return;
    // Until its data are there a frame is drawn with others, mostly fewer, triangles.
    const std::uint64_t drawn =
        statistics.complete ? use.triangles
                            : std::min(use.triangles, statistics.triangles + statistics.points);
    const bool isOfNewView = view_.isCut(request.camera);
    view_.follow(request.camera);
    if (isOfNewView)
        margin_.record(budgetOf(request, 1).predict(use.covered, drawn), milliseconds,
                       use.milliseconds);
    cost_.record({.fixedShare = fabric::FrameBudget::fixedShare(use.covered),
                  .triangles = static_cast<double>(drawn),
                  .milliseconds = milliseconds,
                  .isEasy = halvings_ == 0 && use.tauPixels <= statistics.tauAskedPixels &&
                            milliseconds < kEasy * use.milliseconds,
                  .isOfNewView = isOfNewView});
    use.predictedMilliseconds = budgetOf(request, 1).predict(use.covered, use.triangles);
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
               kept.shading == request.shading && kept.session == request.session;
    });
    if (found != kept_.end())
        kept_.splice(kept_.begin(), kept_, found);
    else
        kept_.push_front({request.width, request.height, request.shading, request.session, {}});
    if (kept_.size() > kMostKept)
        kept_.pop_back();
    return kept_.front().keeper;
}

}  // namespace eyrie::coordinator
