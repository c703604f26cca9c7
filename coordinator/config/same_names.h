// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/configuration.h"
#include "coordinator/config/findings.h"

namespace eyrie::config {

/// Warns of each name that two nodes, pipes, windows, channels, observers, layouts or canvases
/// have, or two views of a layout, or two segments of a canvas: what refers to it finds the first.
void warnOfSameNames(const Configuration& configuration, Findings& findings);

}  // namespace eyrie::config
