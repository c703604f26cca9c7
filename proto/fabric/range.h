// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace eyrie::fabric {

/// A share [begin, end) of a scene's data, both in [0, 1]: what a sort-last (DB) channel draws.
/// A piece of data belongs to the one range that contains the position of its start.
struct Range {
    double begin = 0;
    double end = 1;

    bool isEmpty() const { return !(begin < end); }
    bool isWhole() const { return begin <= 0 && end >= 1; }
    bool contains(double position) const { return position >= begin && position < end; }
    bool operator==(const Range&) const = default;
};

/// `count` equal ranges that cover `whole` without gap or overlap.
inline std::vector<Range> split(const Range& whole, int count) {
    std::vector<Range> parts;
    const double size = whole.end - whole.begin;
    for (int i = 0; i < count; ++i)
        parts.push_back({i == 0 ? whole.begin : parts.back().end,
                         i + 1 == count ? whole.end : whole.begin + size * (i + 1) / count});
    return parts;
}

}  // namespace eyrie::fabric
