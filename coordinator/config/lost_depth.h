// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Whether it leaves its compound's children parts of the data while frames are drawn.
bool dividesData(const Equalizer& equalizer);

/// Warns of output frames without depth that have a part of the data only: they come over all that
/// others have drawn, also over what is nearer.
void warnOfLostDepth(std::span<const ResolvedCompound> tree, Findings& findings);

}  // namespace eyrie::config
