// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/json_object.h"
#include "renderer/terrain/imagery/imagery_index.h"

namespace eyrie::cli {

/// What is said of a terrain's imagery: by `eyrie info`, and at the end of an import.
JsonObject imageryJson(const terrain::ImagerySummary& imagery);
std::string imageryText(const terrain::ImagerySummary& imagery);

}  // namespace eyrie::cli
