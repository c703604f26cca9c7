// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/torn_pictures.h"

#include <algorithm>

namespace eyrie::config {
namespace {

bool sharesOut(const Equalizer& equalizer) {
    return equalizer.kind == EqualizerKind::Load || equalizer.kind == EqualizerKind::Tree;
}

/// All that the compound at `position` is above.
std::span<const ResolvedCompound> below(std::span<const ResolvedCompound> tree,
                                        std::size_t position) {
    const auto rest = tree.subspan(position + 1);
    const auto end = std::ranges::find_if(
        rest, [&](const ResolvedCompound& each) { return each.depth <= tree[position].depth; });
    return rest.first(static_cast<std::size_t>(end - rest.begin()));
}

/// Of several children that draw, one for fewer eyes, in fewer frames, or fewer pixels or samples
/// than the compound.
bool isTorn(const ResolvedCompound& compound, std::span<const ResolvedCompound> family) {
    int drawing = 0;
    bool isTorn = false;
    for (std::size_t i = 0; i < family.size(); ++i) {
        const ResolvedCompound& child = family[i];
        const auto draws = [](const ResolvedCompound& each) { return each.tasks.draw; };
        if (child.depth != compound.depth + 1 ||
            !(draws(child) || std::ranges::any_of(below(family, i), draws)))
            continue;
        ++drawing;
        isTorn = isTorn || child.eyes != compound.eyes || child.period != compound.period ||
                 child.pixel != compound.pixel || child.subpixel != compound.subpixel;
    }
    return isTorn && drawing > 1;
}

}  // namespace

void warnOfTornPictures(std::span<const ResolvedCompound> tree, Findings& findings) {
    for (std::size_t i = 0; i < tree.size(); ++i)
        for (const Equalizer& each : tree[i].compound->equalizers)
            if (sharesOut(each) && tree[i].destination && isTorn(tree[i], below(tree, i)))
                findings.warning(each.place,
                                 "the equalizer shares out one picture, but its children draw for "
                                 "other eyes, in other frames, or other pixels or samples than "
                                 "each other, so parts are missing; give those of each eye, phase, "
                                 "pixel or subpixel a compound with an equalizer of its own");
}

}  // namespace eyrie::config
