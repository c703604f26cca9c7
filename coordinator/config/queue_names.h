// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Warns of inputtiles without outputtiles of their name in the same tree, which leave their
/// compound drawing all of its part, and of outputtiles that nobody takes, or nobody any more, as
/// others before them are of the same name.
void warnOfQueueNames(std::span<const ResolvedCompound> tree, Findings& findings);

}  // namespace eyrie::config
