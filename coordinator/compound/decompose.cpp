// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/decompose.h"

namespace eyrie::coordinator {
namespace {

std::vector<fabric::ChannelTask> cutPicture(const fabric::ChannelTask& whole,
                                            std::span<const double> cuts) {
    std::vector<fabric::ChannelTask> tasks;
    for (const fabric::PixelViewport& part : fabric::split(whole.pixelViewport, cuts)) {
        tasks.push_back(whole);
        tasks.back().pixelViewport = part;
    }
    return tasks;
}

std::vector<fabric::ChannelTask> cutData(const fabric::ChannelTask& whole,
                                         std::span<const double> cuts) {
    std::vector<fabric::ChannelTask> tasks;
    for (const fabric::Range& part : fabric::split(whole.range, cuts)) {
        tasks.push_back(whole);
        tasks.back().range = part;
        tasks.back().wantsDepth = true;
    }
    return tasks;
}

}  // namespace

std::vector<fabric::ChannelTask> decompose(const fabric::ChannelTask& whole,
                                           Decomposition decomposition,
                                           std::span<const double> cuts) {
    if (cuts.empty())
        return {whole};
    return decomposition == Decomposition::TwoD ? cutPicture(whole, cuts) : cutData(whole, cuts);
}

}  // namespace eyrie::coordinator
