// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/json_object.h"
#include "fabric/statistics.h"

namespace eyrie::cli::bench {

/// Where figures were taken: processor, cores, memory, kernel, graphics device, Eyrie's version.
JsonObject machineJson(const fabric::DeviceInfo& device);

/// What this program was called with, as a shell takes it. Empty where /proc is none.
std::string commandLine();

}  // namespace eyrie::cli::bench
