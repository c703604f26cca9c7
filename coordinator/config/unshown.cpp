// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/unshown.h"

#include <algorithm>

namespace eyrie::config {
namespace {

/// The tree that begins there.
std::span<const ResolvedCompound> treeAt(std::span<const ResolvedCompound> compounds,
                                         std::size_t first) {
    std::size_t end = first + 1;
    while (end < compounds.size() && compounds[end].depth > compounds[first].depth) ++end;
    return compounds.subspan(first, end - first);
}

bool draws(const ResolvedCompound& compound) { return compound.tasks.draw; }

}  // namespace

bool isShown(std::span<const ResolvedCompound> compounds) {
    return std::ranges::any_of(
        compounds, [](const ResolvedCompound& each) { return each.destination.has_value(); });
}

void warnOfUnshown(std::span<const ResolvedCompound> tree, Findings& findings) {
    for (std::size_t i = 0; i < tree.size();) {
        const auto part = treeAt(tree, i);
        if (isShown(part)) {
            ++i;
            continue;
        }
        if (i == 0 || std::ranges::any_of(part, draws))
            findings.warning(tree[i].place(),
                             "nothing of this compound tree is shown: none of its channels is a "
                             "view's, as in channel ( canvas 0 segment 0 layout 0 view 0 )");
        i += part.size();
    }
}

}  // namespace eyrie::config
