// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "coordinator/compound/work.h"

/// Which pictures an output is: of which eyes, and put together from which framebuffers.
namespace eyrie::compound {

/// Whose pictures, and how they become one.
struct ShownEyes {
    std::vector<Eye> eyes;             ///< one each; two, left and right, where `stereo` joins them
    Stereo stereo = Stereo::Separate;  ///< Separate: each is a picture by itself
    bool isPlain = false;              ///< the view's own, of no eye in particular
};

ShownEyes shownEyes(const config::Configuration& configuration,
                    const config::ResolvedConfiguration& resolved, const Output& output);

/// The pass in which a destination's picture for an eye of an output comes to be; nothing where it
/// shows none. Of a view without stereo both eyes see the same, unless eyes are asked for.
std::optional<Pass> passFor(const config::Destination& destination, const Output& output, Eye eye);

bool isPartOf(const config::Destination& destination, const Output& output);

/// Pictures of output `index`; their framebuffers are made where no compound has any.
std::vector<Picture> picturesOf(const config::Configuration& configuration,
                                const config::ResolvedConfiguration& resolved, const Output& output,
                                std::size_t index, WorkList& list);

/// Leaves out parts that no step draws or assembles anything in, which would be background, where
/// another part shows something in the same place.
void leaveOutEmptyParts(std::span<const Step> steps, std::vector<Picture>& pictures);

}  // namespace eyrie::compound
