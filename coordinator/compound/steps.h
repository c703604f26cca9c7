// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/compound/contents.h"
#include "coordinator/compound/work.h"

namespace eyrie::compound {

struct StepList {
    std::vector<Step> steps;
    std::vector<Contents> contents;  ///< of the framebuffers, after all steps
    std::vector<Contents> frames;    ///< of the output frames
};

/// Works as steps on framebuffers: what comes over what, in which order, and by depth or not.
///
/// Of pictures that meet, that of the lower range wins where depths are equal, whichever arrives
/// first. Adds framebuffers for the samples of subpixel compounds to `list`. Refuses, and leaves
/// out, frames that cannot be brought into the pixels of who takes them.
StepList stepsOf(const config::ResolvedConfiguration& resolved, const std::vector<Work>& works,
                 WorkList& list);

}  // namespace eyrie::compound
