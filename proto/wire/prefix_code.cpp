// SPDX-License-Identifier: Apache-2.0
#include "wire/prefix_code.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

namespace eyrie::wire {
namespace {

using Weights = std::vector<std::uint32_t>;

/// A symbol beside its weight: as numbers they are in order of weight, and then of symbol.
struct Leaf {
    std::uint64_t both;

    Leaf(std::uint32_t weight, std::size_t symbol) : both(std::uint64_t{weight} << 32 | symbol) {}
    std::uint32_t weight() const { return static_cast<std::uint32_t>(both >> 32); }
    std::size_t symbol() const { return both & 0xffffffff; }
};

/// By the lowest byte of the weight, then the next one and so on, which keeps the order of those
/// that agree in it (radix sort): what comes by comparing is guessed wrong half of the time.
void sortByWeight(std::vector<Leaf>& leaves) {
    std::uint64_t any = 0;
    for (const Leaf& leaf : leaves) any |= leaf.both;
    std::vector<Leaf> sorted(leaves);
    for (int shift = 32; shift < 64 && any >> shift != 0; shift += 8) {
        std::array<std::uint32_t, 257> begin{};
        for (const Leaf& leaf : leaves) ++begin[(leaf.both >> shift & 0xff) + 1];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        for (const Leaf& leaf : leaves) sorted[begin[leaf.both >> shift & 0xff]++] = leaf;
        leaves.swap(sorted);
    }
}

/// Lengths without a limit, by the two queues of those that were there, lightest first, and of
/// those that were joined, which come in order of weight by themselves.
std::vector<std::uint8_t> unlimitedLengths(const Weights& weights) {
    std::vector<Leaf> leaves;
    leaves.reserve(weights.size());
    for (std::size_t symbol = 0; symbol < weights.size(); ++symbol)
        if (weights[symbol] > 0)
            leaves.emplace_back(weights[symbol], symbol);
    sortByWeight(leaves);
    std::vector<std::uint8_t> lengths(weights.size(), 0);
    if (leaves.size() == 1)
        lengths[leaves.front().symbol()] = 1;
    if (leaves.size() < 2)
        return lengths;

    const std::size_t count = leaves.size();
    std::vector<std::uint32_t> joined;  // weights
    joined.reserve(count);
    std::vector<std::size_t> above(2 * count);  // the node over each: leaves, then those joined
    std::size_t leaf = 0, pair = 0;
    const auto lightest = [&] {
        const bool takesLeaf =
            leaf < count && (pair == joined.size() || leaves[leaf].weight() <= joined[pair]);
        return takesLeaf ? leaf++ : count + pair++;
    };
    const auto weightOf = [&](std::size_t node) {
        return node < count ? leaves[node].weight() : joined[node - count];
    };
    while (joined.size() + 1 < count) {
        const std::size_t one = lightest(), other = lightest();
        above[one] = above[other] = count + joined.size();
        joined.push_back(weightOf(one) + weightOf(other));
    }
    std::vector<std::uint8_t> depth(2 * count - 1, 0);  // the root is the last
    for (std::size_t node = depth.size() - 1; node-- > 0;)
        depth[node] = static_cast<std::uint8_t>(depth[above[node]] + 1);
    for (std::size_t i = 0; i < count; ++i) lengths[leaves[i].symbol()] = depth[i];
    return lengths;
}

}  // namespace

std::vector<std::uint8_t> codeLengths(std::span<const std::uint32_t> counts, int longest) {
    Weights weights(counts.begin(), counts.end());
    for (;;) {
        std::vector<std::uint8_t> lengths = unlimitedLengths(weights);
        if (std::all_of(lengths.begin(), lengths.end(),
                        [=](std::uint8_t length) { return length <= longest; }))
            return lengths;
        for (std::uint32_t& weight : weights) weight = weight / 2 + weight % 2;
    }
}

std::vector<std::uint16_t> codesOf(std::span<const std::uint8_t> lengths) {
    constexpr std::size_t kLongest = 15;
    std::array<std::uint32_t, kLongest + 1> next{}, ofLength{};
    for (const std::uint8_t length : lengths) ++ofLength[length];
    ofLength[0] = 0;
    for (std::size_t bits = 1; bits <= kLongest; ++bits)
        next[bits] = (next[bits - 1] + ofLength[bits - 1]) << 1;
    std::vector<std::uint16_t> codes(lengths.size(), 0);
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        std::uint32_t code = next[lengths[symbol]]++;
        for (int bit = 0; bit < lengths[symbol]; ++bit, code >>= 1)
            codes[symbol] = static_cast<std::uint16_t>(codes[symbol] << 1 | (code & 1));
    }
    return codes;
}

}  // namespace eyrie::wire
