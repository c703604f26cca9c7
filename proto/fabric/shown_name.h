// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::fabric {

/// A name of data, or a text with such names in it, as anybody may see it: addresses without user
/// and password (`https://…@host`) and without their query (`?…`), which may be a signature. All
/// else stays as it is.
std::string shownName(std::string_view name);

}  // namespace eyrie::fabric
