// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/scene.h"
#include "fabric/statistics.h"

namespace eyrie::service {

/// What a renderer process draws with: eyrie::Renderer, or a fake in tests. Created, used and
/// destroyed on one thread.
class ChannelDrawer {
public:
    virtual ~ChannelDrawer() = default;

    virtual const fabric::DeviceInfo& device() const = 0;
    virtual absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene) = 0;
    virtual absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& frameData,
                                                         const fabric::ChannelTask& task) = 0;
};

using DrawerFactory = std::function<absl::StatusOr<std::unique_ptr<ChannelDrawer>>()>;

}  // namespace eyrie::service
