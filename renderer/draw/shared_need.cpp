// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/shared_need.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <numeric>
#include <unordered_map>

namespace eyrie::draw {
namespace {

double length(const fabric::Range& range) { return range.end - range.begin; }

/// How much of [0, 1) the ranges of the needs in `set`, a bit each, cover.
double covered(std::span<const ViewNeed> needs, std::uint32_t set) {
    std::vector<fabric::Range> ranges;
    for (std::size_t i = 0; i < needs.size(); ++i)
        if ((set >> i & 1U) != 0)
            ranges.push_back(needs[i].range);
    std::ranges::sort(ranges, {}, &fabric::Range::begin);
    double sum = 0;
    double end = 0;
    for (const fabric::Range& range : ranges) {
        sum += std::max(range.end - std::max(range.begin, end), 0.0);
        end = std::max(end, range.end);
    }
    return sum;
}

}  // namespace

std::uint64_t separateBytes(std::span<const ViewNeed> needs) {
    double sum = 0;
    for (const ViewNeed& need : needs) {
        std::uint64_t bytes = 0;
        for (const NeededItem& item : need.items) bytes += item.bytes;
        sum += length(need.range) * static_cast<double>(bytes);
    }
    return static_cast<std::uint64_t>(sum);
}

std::uint64_t sharedBytes(std::span<const ViewNeed> needs) {
    assert(needs.size() <= kMostNeeds);
    struct Item {
        std::uint64_t bytes = 0;
        std::uint32_t set = 0;  ///< who needs it
    };
    std::unordered_map<std::uint32_t, Item> items;
    for (std::size_t i = 0; i < needs.size(); ++i)
        for (const NeededItem& needed : needs[i].items) {
            Item& item = items[needed.key];
            item.bytes = std::max(item.bytes, needed.bytes);
            item.set |= 1U << i;
        }
    std::unordered_map<std::uint32_t, std::uint64_t> bytesBySet;
    for (const auto& [key, item] : items) bytesBySet[item.set] += item.bytes;
    double sum = 0;
    for (const auto& [set, bytes] : bytesBySet)
        sum += covered(needs, set) * static_cast<double>(bytes);
    return static_cast<std::uint64_t>(sum);
}

}  // namespace eyrie::draw
