// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace eyrie::effects {

/// Whether generated C++ cannot call a uniform or parameter `name`: a keyword, or a member that
/// every generated class has.
bool isTakenInCpp(std::string_view name);

}  // namespace eyrie::effects
