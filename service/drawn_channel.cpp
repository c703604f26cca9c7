// SPDX-License-Identifier: Apache-2.0
#include "service/drawn_channel.h"

#include <new>

#include <fmt/format.h>

namespace eyrie::service {

absl::StatusOr<fabric::ChannelResult> drawnChannel(ChannelDrawer& drawer,
                                                   const fabric::FrameData& frameData,
                                                   const fabric::ChannelTask& task,
                                                   const fabric::Delivery& delivery) {
    try {
        return drawer.render(frameData, task, delivery);
    } catch (const std::bad_alloc&) {
        return absl::ResourceExhaustedError(
            fmt::format("the renderer has no memory to draw {}x{} pixels{} within {} pixels; draw "
                        "fewer, or with a larger error",
                        task.pixelViewport.width, task.pixelViewport.height,
                        task.wantsDepth ? " and their depths" : "", frameData.tauPixels));
    }
}

}  // namespace eyrie::service
