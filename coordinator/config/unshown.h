// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Whether any of these compounds is part of a view's picture.
bool isShown(std::span<const ResolvedCompound> compounds);

/// Warns of what only draws into channels, as files of Equalizer 1.0 do, where views show others: a
/// whole tree of compounds, or the parts of one.
void warnOfUnshown(std::span<const ResolvedCompound> tree, Findings& findings);

}  // namespace eyrie::config
