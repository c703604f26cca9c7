// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/compound/plan.h"
#include "fabric/image.h"
#include "fabric/lent_image.h"

namespace eyrie::compound {

/// Carries out a plan's steps: from what renderers drew to its pictures, each of its area (that of
/// two eyes in one picture is larger), with depth where it says so.
///
/// `drawn` is of plan.draws, in their order: each within its task's pixel viewport, background
/// where it has nothing, with depth where its task asks for it. What is lent of it is read where it
/// lies, and given back when it is used up. `background` is the colour where nothing was drawn.
std::vector<fabric::Image> composePictures(const Plan& plan, std::vector<fabric::LentImage> drawn,
                                           fabric::Rgba background);

}  // namespace eyrie::compound
