// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fabric/image.h"

namespace eyrie::composite {

/// Each pixel the mean of the samples' (subpixel compounds), rounded to the nearest, halves up; the
/// same whatever their order. Depth is the first sample's.
/// Preconditions: there is a sample; all have one area.
fabric::Image mean(std::span<const fabric::Image> samples);

}  // namespace eyrie::composite
