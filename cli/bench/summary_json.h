// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/bench/report.h"
#include "cli/json_object.h"

namespace eyrie::cli::bench {

/// What summary.json holds, and the page's data begin with.
JsonObject summaryOf(const Report& report);

}  // namespace eyrie::cli::bench
