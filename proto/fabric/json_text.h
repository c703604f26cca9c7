// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::fabric {

/// `text` as a JSON string, with its quotation marks. What is not UTF-8 is not mended.
std::string quotedJson(std::string_view text);

}  // namespace eyrie::fabric
