// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace eyrie::wire {

/// What RenderChannel's initial metadata have where they come before the header, see there.
inline const std::string kNearlyDrawnKey = "eyrie-nearly-drawn";

}  // namespace eyrie::wire
