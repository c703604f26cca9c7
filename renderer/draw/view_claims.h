// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "renderer/draw/view_turns.h"
#include "renderer/page/host_pages.h"

namespace eyrie::draw {

/// What a view wanted of an object when it was last drawn.
struct ViewClaim {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> items;  ///< on the device, with their rank
    std::vector<std::uint32_t> pages;                            ///< of what is missing there
    std::vector<std::uint32_t> soon;  ///< pages that may be needed soon, likely ones first
};

/// The claims of the views that are drawn by turns, so that none pushes out what another draws.
class ViewClaims {
public:
    /// An empty one for the view that is drawn.
    ViewClaim& begin(const ViewTurn& turn) {
        ViewClaim& own = claims_.of(turn);
        own.items.clear();
        own.pages.clear();
        own.soon.clear();
        return own;
    }

    /// Gives what the others have on the device the ranks that it had for them, `behind` lower.
    template <typename Set>
    void rankOthers(const ViewTurn& turn, Set& items, std::uint32_t behind) const {
        for (const auto& [view, claim] : claims_.all())
            if (view != turn.view)
                for (const auto& [key, rank] : claim.items) items.rank(key, rank + behind);
    }

    /// Asks for all claimed pages in an order that does not depend on whose turn it is: what is
    /// missing comes before what may be needed soon, and the first of each view before the second
    /// of any. Returns whether there are any.
    bool want(page::HostPages& pages) const {
        const bool hasMissing = wantEach(pages, &ViewClaim::pages);
        return wantEach(pages, &ViewClaim::soon) || hasMissing;
    }

private:
    bool wantEach(page::HostPages& pages, std::vector<std::uint32_t> ViewClaim::*list) const {
        for (std::size_t i = 0;; ++i) {
            bool hasMore = false;
            for (const auto& [view, claim] : claims_.all())
                if (i < (claim.*list).size()) {
                    pages.want((claim.*list)[i]);
                    hasMore = true;
                }
            if (!hasMore)
                return i > 0;
        }
    }

    PerView<ViewClaim> claims_;
};

}  // namespace eyrie::draw
