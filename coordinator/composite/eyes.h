// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/image.h"

/// Two eyes' pictures in one.
namespace eyrie::composite {

/// Which colours an eye sees through its glass.
struct Mask {
    bool red = false;
    bool green = false;
    bool blue = false;
};

/// Each colour of the eye whose mask has it, of both masks' the mean, of none's 0. Opaque where
/// either is. Precondition: both have one area.
fabric::Image anaglyph(const fabric::Image& left, const Mask& leftMask, const fabric::Image& right,
                       const Mask& rightMask);

/// The left one at the left, or above; depth where both have it. The area begins where the left
/// one's does. Precondition: both are of one size.
fabric::Image sideBySide(const fabric::Image& left, const fabric::Image& right);
fabric::Image topBottom(const fabric::Image& left, const fabric::Image& right);

}  // namespace eyrie::composite
