// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <absl/status/status.h>

#include "cli/bench/compare.h"

/// A comparison for people and programs.
namespace eyrie::cli::bench {

/// "faster", "within noise": what `figure` is in B.
std::string_view wordFor(const Figure& figure);

/// A line a figure, run by run, for a terminal.
std::string table(const Comparison& comparison);

std::string comparisonJson(const Comparison& comparison);

/// Both curves and every figure; a page that needs no other file and no network.
std::string comparisonPage(const Comparison& comparison);

/// comparison.json and index.html, in a folder that is made where there is none. Errors:
/// InvalidArgument (a report is there, or another page), those of fabric::writeError.
absl::Status writeComparison(const Comparison& comparison, const std::string& folder);

}  // namespace eyrie::cli::bench
