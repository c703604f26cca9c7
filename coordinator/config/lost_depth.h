// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Whether it leaves its compound's children parts of the data while frames are drawn.
bool dividesData(const Equalizer& equalizer);

/// An output frame without depth that has a part of the data only: it comes over all that others
/// have drawn, also over what is nearer.
struct LostDepth {
    const ResolvedCompound* compound = nullptr;
    const ResolvedFrame* frame = nullptr;
};
/// Those of a tree, or of what is below one of its compounds.
std::vector<LostDepth> lostDepth(std::span<const ResolvedCompound> tree);

void warnOfLostDepth(std::span<const ResolvedCompound> tree, Findings& findings);

}  // namespace eyrie::config
