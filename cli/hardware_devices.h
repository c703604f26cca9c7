// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace eyrie::cli {

/// Indices, as `eyrie renderer --device` takes them, of the EGL devices that are hardware.
std::vector<int> hardwareDevices();

}  // namespace eyrie::cli
