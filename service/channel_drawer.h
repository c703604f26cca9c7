// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"
#include "fabric/delivery.h"
#include "fabric/frame_data.h"
#include "fabric/pick.h"
#include "fabric/scene.h"
#include "fabric/statistics.h"

namespace eyrie::service {

/// Finds what a place of a picture shows; on any thread, until `deadline`.
using PickFunction = std::function<absl::StatusOr<fabric::Picked>(
    const fabric::PickRequest& request, std::chrono::steady_clock::time_point deadline)>;

/// What a drawer holds for its scene.
struct DrawerMemory {
    std::uint64_t deviceBytes = 0;  ///< geometry and textures
    std::uint64_t hostBytes = 0;    ///< terrains' indices; pages, those being loaded included
};

/// What a renderer process draws with: eyrie::Renderer, or a fake in tests. Created, used and
/// destroyed on one thread.
class ChannelDrawer {
public:
    virtual ~ChannelDrawer() = default;

    virtual const fabric::DeviceInfo& device() const = 0;
    virtual absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene) = 0;
    /// Cancelled, soon, after `delivery.stop`; the rest of that it may leave alone.
    virtual absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& frameData,
                                                         const fabric::ChannelTask& task,
                                                         const fabric::Delivery& delivery) = 0;

    /// For the scene that is open; null where none is.
    virtual PickFunction pickFunction() const = 0;

    virtual DrawerMemory memory() const { return {}; }
};

using DrawerFactory = std::function<absl::StatusOr<std::unique_ptr<ChannelDrawer>>()>;

}  // namespace eyrie::service
