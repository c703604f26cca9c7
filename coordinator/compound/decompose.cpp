// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/decompose.h"

#include <cassert>

namespace eyrie::coordinator {
namespace {

std::vector<fabric::ChannelTask> cutPicture(const fabric::ChannelTask& whole, int count) {
    std::vector<fabric::ChannelTask> tasks;
    for (const fabric::PixelViewport& part : fabric::split(whole.pixelViewport, count)) {
        tasks.push_back(whole);
        tasks.back().pixelViewport = part;
    }
    return tasks;
}

std::vector<fabric::ChannelTask> cutData(const fabric::ChannelTask& whole, int count) {
    std::vector<fabric::ChannelTask> tasks;
    for (const fabric::Range& part : fabric::split(whole.range, count)) {
        tasks.push_back(whole);
        tasks.back().range = part;
        tasks.back().wantsDepth = true;
    }
    return tasks;
}

}  // namespace

std::vector<fabric::ChannelTask> decompose(const fabric::ChannelTask& whole,
                                           Decomposition decomposition, int renderers) {
    assert(renderers >= 1);
    if (renderers == 1)
        return {whole};
    return decomposition == Decomposition::TwoD ? cutPicture(whole, renderers)
                                                : cutData(whole, renderers);
}

}  // namespace eyrie::coordinator
