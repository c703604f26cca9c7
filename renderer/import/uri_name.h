// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace eyrie::import {

/// The name of a file that a URI gives with percent signs and two hexadecimal digits for some of
/// its bytes, as glTF does with spaces. `name` itself where it has none, or where one is followed
/// by something else or stands for byte 0.
std::string withoutPercents(const std::string& name);

}  // namespace eyrie::import
