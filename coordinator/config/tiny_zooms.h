// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Warns of zooms of compounds and frames that leave one pixel of many across or along, as where
/// .0001 was written for .01: that is drawn and shown, in one colour.
void warnOfTinyZooms(std::span<const ResolvedCompound> tree, Findings& findings);

}  // namespace eyrie::config
