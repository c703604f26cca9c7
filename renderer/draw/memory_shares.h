// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace eyrie::draw {

/// Each object's share of a limit in bytes, by the most that it can ever use, `mostBytes`. Those
/// that can use no more than an even share get all of that, and what they leave is for the others,
/// likewise: those that could use more than there is get the same. So a thousand small objects
/// beside a large one cost it what they hold, not their number. The shares' sum is the limit at
/// most; equal objects have equal shares, in any order.
std::vector<std::uint64_t> memoryShares(std::uint64_t limitBytes,
                                        std::span<const std::uint64_t> mostBytes);

}  // namespace eyrie::draw
