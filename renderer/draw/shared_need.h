// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fabric/range.h"

namespace eyrie::draw {

/// Something that a view needs on the device.
struct NeededItem {
    std::uint32_t key = 0;
    std::uint64_t bytes = 0;
};

/// What the whole of one view needs, of which a channel has a share.
struct ViewNeed {
    fabric::Range range;
    std::span<const NeededItem> items;  ///< distinct
};

/// Bytes of each view by itself, added up.
std::uint64_t separateBytes(std::span<const ViewNeed> needs);

/// Bytes of what all need together: of an item as large a share as the ranges of those that need it
/// cover. At most kMostNeeds of them.
std::uint64_t sharedBytes(std::span<const ViewNeed> needs);

inline constexpr std::size_t kMostNeeds = 32;

}  // namespace eyrie::draw
