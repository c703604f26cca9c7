// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "coordinator/config/configuration.h"
#include "coordinator/config/findings.h"

namespace eyrie::config {

/// Reads the text of a .eqc file. All that is wrong with it, not just the first thing, is put into
/// `findings`; what is returned is to be used only where these have no errors.
Configuration readEqc(std::string_view text, Findings& findings);

}  // namespace eyrie::config
