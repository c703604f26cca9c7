// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace eyrie::fabric {

/// ", did you mean 'listen'?" where one of `names` is nearly `name`: by the fewest letters that
/// are added, left out or replaced, a third of them at most. Empty where none is.
std::string didYouMean(std::string_view name, const std::vector<std::string>& names);

}  // namespace eyrie::fabric
