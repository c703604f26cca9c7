// SPDX-License-Identifier: Apache-2.0
#include "renderer/codec/symbol_shares.h"

#include <algorithm>
#include <numeric>

namespace eyrie::codec {

SymbolShares::SymbolShares(std::span<const std::uint32_t> counts) {
    const std::uint64_t total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    if (total == 0)
        return;
    std::vector<std::uint32_t> sizes;
    std::uint32_t sum = 0;
    for (const std::uint32_t count : counts) {
        const auto rounded = static_cast<std::uint32_t>((count * kAllShares + total / 2) / total);
        sizes.push_back(count == 0 ? 0 : std::max(1U, rounded));
        sum += sizes.back();
    }
    while (sum != kAllShares) {  // the largest can spare it, or gains least
        std::uint32_t& largest = *std::max_element(sizes.begin(), sizes.end());
        const std::uint32_t change =
            sum < kAllShares ? kAllShares - sum : -std::min(sum - kAllShares, (largest + 1) / 2);
        largest += change;
        sum += change;
    }
    while (sizes.back() == 0) sizes.pop_back();
    setSizes(sizes);
}

void SymbolShares::setSizes(std::span<const std::uint32_t> sizes) {
    std::uint32_t start = 0;
    shares_.clear();
    for (const std::uint32_t size : sizes) {
        shares_.push_back({start, size});
        start += size;
    }
}

void SymbolShares::write(BitWriter& writer) const {
    writer.putGamma(static_cast<std::uint32_t>(shares_.size()) + 1);
    for (const Share& share : shares_) writer.putGamma(share.size + 1);
}

bool SymbolShares::read(BitReader& reader, std::uint32_t symbols) {
    const std::uint32_t count = reader.getGamma();
    if (count == 0 || count - 1 > symbols)
        return false;
    std::vector<std::uint32_t> sizes(count - 1);
    std::uint64_t sum = 0;
    for (std::uint32_t& size : sizes) {
        const std::uint32_t code = reader.getGamma();
        if (code == 0)
            return false;
        size = code - 1;
        sum += size;
    }
    if (sum != (sizes.empty() ? 0 : kAllShares))
        return false;
    setSizes(sizes);
    return true;
}

void SymbolShares::fillSlots(std::span<std::uint32_t, kAllShares> slots) const {
    // Without symbols every slot leaves the state as it is, until its tile is found to be wrong.
    std::uint32_t symbol = 0;
    if (shares_.empty())
        for (std::uint32_t k = 0; k < kAllShares; ++k) slots[k] = kAllShares << 8 | k << 20;
    for (const Share& share : shares_) {
        for (std::uint32_t k = 0; k < share.size; ++k)
            slots[share.start + k] = symbol | share.size << 8 | k << 20;
        ++symbol;
    }
}

}  // namespace eyrie::codec
