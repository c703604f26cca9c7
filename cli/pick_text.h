// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fabric/pick.h"

namespace eyrie::cli {

/// What `eyrie pick` prints of a point of the object of this name: what is read holds as what it is
/// written from.
std::string pickText(const fabric::PickedPoint& point, const std::string& object);

}  // namespace eyrie::cli
