// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::fabric {

/// `text` as a JSON string, with its quotation marks. Bytes that are no UTF-8, as of files' names,
/// become question marks: JSON is UTF-8.
std::string quotedJson(std::string_view text);

/// The shortest JSON number that reads back as the same double. JSON has no infinity: that is
/// "Infinity" or "-Infinity", a string, as in protobuf's JSON. NaN, of what there is none of, is
/// null.
std::string numberJson(double value);

/// Puts each list of numbers alone on one line, of `json` that has a line for each. Strings stay as
/// they are.
void joinNumbers(std::string& json);

}  // namespace eyrie::fabric
