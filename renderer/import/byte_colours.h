// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::import {

/// Colours of OBJ and OFF reach to 1 or to 255, and the files do not say to which: to 255 where a
/// number is above this one, as many of those that reach to 1 are a little above it.
constexpr double kMostOfFractions = 2;

}  // namespace eyrie::import
