// SPDX-License-Identifier: Apache-2.0
#include "renderer/task_check.h"

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie {

namespace {

absl::Status checkPixelViewport(const fabric::ChannelTask& task) {
    const fabric::PixelViewport part = task.pixelViewport;
    const fabric::PixelViewport picture = fabric::pictureOf(task);
    if (!part.isEmpty() && picture.contains(part))
        return absl::OkStatus();
    return absl::InvalidArgumentError(fmt::format(
        "the pixel viewport {}x{}+{}+{} is empty or not inside the {} of {} x {} pixels",
        part.width, part.height, part.x, part.y, task.raster ? "raster" : "view", picture.width,
        picture.height));
}

}  // namespace

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
    if (task.sight)
        RETURN_IF_ERROR(fabric::validate(*task.sight));
    if (task.raster)
        RETURN_IF_ERROR(fabric::validate(*task.raster, task.viewWidth, task.viewHeight));
    return checkPixelViewport(task);
}

}  // namespace eyrie
