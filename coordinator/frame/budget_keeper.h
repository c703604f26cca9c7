// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>

#include "coordinator/frame/cost_model.h"
#include "coordinator/frame/cut_margin.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/view_change.h"
#include "fabric/frame_budget.h"
#include "fabric/statistics.h"

namespace eyrie::coordinator {

/// Whether what a frame took is what drawing it takes: not where it waited for data, or measured
/// its stages one by one.
bool tellsItsCost(const FrameRequest& request, const fabric::FrameStatistics& statistics);

/// What a frame that is to keep a budget is drawn with.
struct BudgetPlan {
    fabric::FrameBudget budget;  ///< for the frame data
    int width = 0;               ///< of the picture, pixels
    int height = 0;
};

/// Holds the frame time of one kind of frame (picture size, shading): learns what frames cost, and
/// makes pictures smaller where even the coarsest tau takes too long.
///
/// Pictures have the size asked for, or about 1/2, 1/4 … 1/16 of its pixels. They get smaller at
/// once, by as many halvings as the time foreseen is too long by; and larger again when the same
/// cut, whose tau in larger pixels is larger, keeps well clear of the coarsest, and the time of all
/// the pixels is foreseen to fit. So the step up is not taken back at once.
///
/// The first frame of a new view is foreseen with a margin, for what a triangle costs there is not
/// known yet, and the view is drawn somewhat coarser for that frame than for the next.
class BudgetKeeper {
public:
    static constexpr int kHalvings = 4;  ///< of pixels, at most

    /// For a request with a budget that fabric::validateBudgetMilliseconds accepts.
    BudgetPlan plan(const FrameRequest& request) const;

    /// What the frame of the last plan came to. `milliseconds`: from asking for it to having all of
    /// it. Nothing is learned from a time in which it waited for data, or measured its stages.
    void record(const FrameRequest& request, const fabric::FrameStatistics& statistics,
                double milliseconds);

private:
    /// With costs `margin` times as high as learned.
    fabric::FrameBudget budgetOf(const FrameRequest& request, double margin) const;
    void resize(const fabric::BudgetUse& use, double coarsestTau);

    CostModel cost_;
    ViewChange view_;
    CutMargin margin_;
    double lastTauPixels_ = 0;
    int halvings_ = 0;
};

/// A keeper for each kind of frame that each session asked for lately: what one session looks at
/// may take long while another's takes nothing.
class BudgetKeepers {
public:
    BudgetKeeper& of(const FrameRequest& request);

    /// Frames of another scene come next.
    void forget() { kept_.clear(); }

private:
    static constexpr std::size_t kMostKept = 64;

    struct Kept {
        int width;
        int height;
        fabric::Shading shading;
        std::uint64_t session;
        BudgetKeeper keeper;
    };
    std::list<Kept> kept_;  ///< the one used last comes first
};

}  // namespace eyrie::coordinator
