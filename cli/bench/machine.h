// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/json_object.h"
#include "fabric/statistics.h"

namespace eyrie::cli::bench {

/// Where figures were taken: processor, cores, memory, kernel, graphics device, Eyrie's version.
JsonObject machineJson(const fabric::DeviceInfo& device);

}  // namespace eyrie::cli::bench
