// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/memory_shares.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace eyrie::draw {

std::vector<std::uint64_t> memoryShares(std::uint64_t limitBytes,
                                        std::span<const std::uint64_t> mostBytes) {
    std::vector<std::size_t> ascending(mostBytes.size());
    std::iota(ascending.begin(), ascending.end(), std::size_t{0});
    std::ranges::sort(ascending, {}, [&](std::size_t i) { return mostBytes[i]; });
    std::uint64_t even = 0;
    std::uint64_t left = limitBytes;
    for (std::size_t i = 0; i < ascending.size(); ++i) {
        even = left / (ascending.size() - i);
        const std::uint64_t most = mostBytes[ascending[i]];
        if (most > even)
            break;
        left -= most;
    }
    std::vector<std::uint64_t> shares;
    for (const std::uint64_t most : mostBytes) shares.push_back(std::min(most, even));
    return shares;
}

}  // namespace eyrie::draw
