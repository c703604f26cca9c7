// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Warns of load and tree equalizers between whose children eyes, phases, pixels or samples are
/// divided, too: each draws its part for its own eye, in its own frames or its own pixels, where
/// nobody draws the others'.
void warnOfTornPictures(std::span<const ResolvedCompound> tree, Findings& findings);

}  // namespace eyrie::config
