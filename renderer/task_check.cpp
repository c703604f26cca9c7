// SPDX-License-Identifier: Apache-2.0
#include "renderer/task_check.h"

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie {

absl::Status validateTask(const fabric::FrameData& frameData, const fabric::ChannelTask& task) {
    RETURN_IF_ERROR(fabric::validate(frameData.camera));
    RETURN_IF_ERROR(fabric::validate(frameData.look));
    if (!(frameData.tauPixels >= fabric::kMinTauPixels &&
          frameData.tauPixels <= fabric::kMaxTauPixels))
        return absl::InvalidArgumentError(fmt::format("tau is {} pixels; it must be from {} to {}",
                                                      frameData.tauPixels, fabric::kMinTauPixels,
                                                      fabric::kMaxTauPixels));
    if (frameData.budget)
        RETURN_IF_ERROR(fabric::validate(*frameData.budget));
    const auto inLimits = [](int side) { return side >= 1 && side <= fabric::kMaxViewPixels; };
    if (!inLimits(task.viewWidth) || !inLimits(task.viewHeight))
        return absl::InvalidArgumentError(
            fmt::format("the view is {} x {} pixels; each side must be from 1 to {}",
                        task.viewWidth, task.viewHeight, fabric::kMaxViewPixels));
    const fabric::PixelViewport view{0, 0, task.viewWidth, task.viewHeight};
    if (task.pixelViewport.isEmpty() || !view.contains(task.pixelViewport))
        return absl::InvalidArgumentError(fmt::format(
            "the pixel viewport {}x{}+{}+{} is empty or not inside the view of {} x {} pixels",
            task.pixelViewport.width, task.pixelViewport.height, task.pixelViewport.x,
            task.pixelViewport.y, task.viewWidth, task.viewHeight));
    return absl::OkStatus();
}

}  // namespace eyrie
