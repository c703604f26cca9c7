// SPDX-License-Identifier: Apache-2.0
// Levenshtein, "Binary codes capable of correcting deletions, insertions, and reversals", 1966.
#include "fabric/near_name.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace eyrie::fabric {
namespace {

std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string didYouMean(std::string_view name, const std::vector<std::string>& names) {
    constexpr std::size_t kLongest = 64;  // nobody means an option or a keyword by more
    if (name.size() > kLongest)
        return "";
    std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
    std::string nearest;
    for (const std::string& candidate : names)
        if (const std::size_t apart = distance(name, candidate); apart < least) {
            least = apart;
            nearest = candidate;
        }
    return nearest.empty() ? "" : fmt::format(", did you mean '{}'?", nearest);
}

}  // namespace eyrie::fabric
