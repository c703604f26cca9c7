// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace eyrie::fabric {

/// A share [begin, end) of the work of a view, or of an object in it, both in [0, 1], in the order
/// of the data: what a sort-last (DB) channel draws. What cannot be cut belongs to the one range
/// that contains its start.
struct Range {
    double begin = 0;
    double end = 1;

    bool isEmpty() const { return !(begin < end); }
    bool isWhole() const { return begin <= 0 && end >= 1; }
    bool contains(double position) const { return position >= begin && position < end; }
    bool operator==(const Range&) const = default;
};

/// The positions in (0, 1) that cut a whole into `count` equal parts. Precondition: count >= 1.
inline std::vector<double> equalCuts(int count) {
    std::vector<double> cuts;
    for (int i = 1; i < count; ++i) cuts.push_back(static_cast<double>(i) / count);
    return cuts;
}

/// One range more than `cuts` (ascending, in (0, 1)) that cover `whole` without gap or overlap.
inline std::vector<Range> split(const Range& whole, std::span<const double> cuts) {
    std::vector<Range> parts = {whole};
    for (const double cut : cuts) {
        const double at = whole.begin + (whole.end - whole.begin) * cut;
        parts.back().end = at;
        parts.push_back({at, whole.end});
    }
    return parts;
}

}  // namespace eyrie::fabric
