// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/lost_depth.h"

namespace eyrie::compound {

std::vector<LostDepth> lostDepth(const config::ResolvedConfiguration& resolved,
                                 const WorkList& list, std::span<const Contents> contents) {
    std::vector<bool> isTaken(list.frames.size(), false);
    for (const Work& work : list.works)
        for (const Input& input : work.inputs) isTaken[input.frame] = true;
    std::vector<LostDepth> lost;
    for (std::size_t i = 0; i < list.frames.size(); ++i) {
        const OutputFrame& frame = list.frames[i];
        if (isTaken[i] && !frame.hasDepth && contents[i].hasOnlyPartOfTheData())
            lost.push_back({resolved.compounds[frame.compound].compound, frame.written});
    }
    return lost;
}

}  // namespace eyrie::compound
