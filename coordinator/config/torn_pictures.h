// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

namespace eyrie::config {

/// Warns of load and tree equalizers between whose children eyes or phases are divided, too: each
/// draws its part for its own eye or in its own frames, where nobody draws the others'.
void warnOfTornPictures(std::span<const ResolvedCompound> tree, Findings& findings);

}  // namespace eyrie::config
