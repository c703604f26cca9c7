// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace eyrie::cli {

/// A bound in three significant digits, which are not below it.
std::string boundText(double bound);

}  // namespace eyrie::cli
