// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "fabric/range.h"

namespace eyrie::draw {

/// The lowest step of page::TauLadder from the view's `first` on at which what the channel of
/// `range` needs fits by itself: `bytesOf(range, step)`, which falls as steps rise. That may be
/// more than its share of what the view needs: shares are of work, not of bytes, and several
/// channels may need the same. Of equal ranges it is what the neediest needs, so that all of them
/// come to the same step.
int stepOfRange(const fabric::Range& range, int first, std::uint64_t roomBytes,
                const std::function<std::uint64_t(const fabric::Range&, int)>& bytesOf);

}  // namespace eyrie::draw
