// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::fabric {

/// `text` as a JSON string, with its quotation marks. Bytes that are no UTF-8, as of files' names,
/// become question marks: JSON is UTF-8.
std::string quotedJson(std::string_view text);

/// Puts each list of numbers alone on one line, of `json` that has a line for each. Strings stay as
/// they are.
void joinNumbers(std::string& json);

}  // namespace eyrie::fabric
