// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// Coordinate reference systems as well-known text, as .eyt files have them.
namespace eyrie::import {

/// Whether both mean the same, however they say it. Text that GDAL does not understand is the same
/// as itself.
bool isSameCrs(const std::string& wkt, const std::string& otherWkt);

}  // namespace eyrie::import
