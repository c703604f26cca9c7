// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/range_step.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/page/tau_ladder.h"

namespace eyrie::draw {
namespace {

/// All of the equal ranges that `range` is one of, to a millionth; else it alone.
std::vector<fabric::Range> equalRanges(const fabric::Range& range) {
    constexpr double kRounding = 1e-6;
    constexpr double kMost = 1024;
    const double count = std::round(1 / (range.end - range.begin));
    const double index = std::round(range.begin * count);
    if (!(count <= kMost) || std::abs(range.begin * count - index) > kRounding ||
        std::abs(range.end * count - index - 1) > kRounding)
        return {range};
    return fabric::split(fabric::Range{}, fabric::equalCuts(static_cast<int>(count)));
}

}  // namespace

int stepOfRange(const fabric::Range& range, int first, std::uint64_t roomBytes,
                const std::function<std::uint64_t(const fabric::Range&, int)>& bytesOf) {
    if (range.isWhole() || bytesOf({}, first) <= roomBytes)
        return first;
    const std::vector<fabric::Range> ranges = equalRanges(range);
    const auto bytes = [&](int step) {
        std::uint64_t most = 0;
        for (const fabric::Range& one : ranges) most = std::max(most, bytesOf(one, step));
        return most;
    };
    return bytes(first) <= roomBytes ? first : page::TauLadder::lowest(bytes, roomBytes, first + 1);
}

}  // namespace eyrie::draw
