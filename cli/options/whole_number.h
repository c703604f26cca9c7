// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace eyrie::cli {

/// Refuses what is no number of decimal digits that 64 bits hold: CLI11 takes -1 for 2^64 - 1, and
/// what is too large for the largest there is. For transform(), as 010 is 10.
CLI::Validator wholeNumber();

}  // namespace eyrie::cli
