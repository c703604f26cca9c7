// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/config/eqc_grammar.h"

/// A configuration as the statements that it is read from, and as the text of a .eqc file.
///
/// What has its usual value is left out. Things are referred to by name where the first of that
/// name is meant, else by position; a channel so is written ( node 0 pipe 0 window 0 channel 0 ),
/// which Equalizer does not read.
namespace eyrie::config {

/// readStatements() makes an equal configuration of them.
EqcText statementsOf(const Configuration& configuration);

/// readEqc() makes an equal configuration of it, where all texts and numbers are such as it reads.
std::string writeEqc(const Configuration& configuration);

/// A number as .eqc has it: without exponent, in as few digits as read back to the same.
Scalar numberScalar(double value);
/// `keyword value`.
Statement plain(std::string_view keyword, Scalar value);

}  // namespace eyrie::config
