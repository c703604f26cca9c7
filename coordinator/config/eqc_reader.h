// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "coordinator/config/configuration.h"
#include "coordinator/config/eqc_grammar.h"
#include "coordinator/config/findings.h"

namespace eyrie::config {

inline constexpr std::string_view kNewestVersion = "1.2";

/// What statements, of whichever form of file, mean: here, and only here, limits are checked and
/// references followed. Warns of names that two things have.
Configuration readStatements(const EqcText& statements, Findings& findings);

/// Reads the text of a .eqc file, and brings it to what version 1.2 has. All that is wrong with it,
/// not just the first thing, is put into `findings`; what is returned is to be used only where
/// these have no errors.
Configuration readEqc(std::string_view text, Findings& findings);

}  // namespace eyrie::config
