// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/configuration.h"

namespace eyrie::config {

/// The same displays, each destination drawn by its own channel alone, with the walls, eyes and
/// stereo that its compounds have: what the pictures of `configuration` are to equal.
Configuration oneChannel(const Configuration& configuration);

}  // namespace eyrie::config
