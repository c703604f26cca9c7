// SPDX-License-Identifier: Apache-2.0
#include "service/renderer_drawer.h"

#include <utility>

#include "fabric/status.h"
#include "renderer/pick/picker.h"

namespace eyrie::service {
namespace {

class RendererDrawer final : public ChannelDrawer {
public:
    RendererDrawer(std::unique_ptr<Renderer> renderer, page::AllowedUrls allowed, DataPlaces places)
        : renderer_(std::move(renderer)),
          allowed_(std::move(allowed)),
          places_(std::move(places)) {}

    const fabric::DeviceInfo& device() const override { return renderer_->device(); }
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene) override {
        fabric::Scene placed = scene;
        for (fabric::SceneObject& object : placed.objects) {
            object.path = places_.placed(object.path);
            RETURN_IF_ERROR(allowed_.check(object.path));
        }
        return renderer_->openScene(placed);
    }
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& frameData,
                                                 const fabric::ChannelTask& task,
                                                 const fabric::Delivery& delivery) override {
        return renderer_->render(frameData, task, delivery);
    }
    DrawerMemory memory() const override {
        const RendererMemory memory = renderer_->memory();
        return {memory.deviceBytes, memory.hostBytes};
    }
    PickFunction pickFunction() const override {
        auto picker = renderer_->picker();
        if (!picker)
            return nullptr;
        return [picker](const fabric::PickRequest& request,
                        std::chrono::steady_clock::time_point deadline) {
            return picker->pick(request, deadline);
        };
    }

private:
    std::unique_ptr<Renderer> renderer_;
    page::AllowedUrls allowed_;
    DataPlaces places_;
};

}  // namespace

DrawerFactory rendererDrawer(const RendererOptions& options, const page::AllowedUrls& allowed,
                             const DataPlaces& places) {
    return [options, allowed, places]() -> absl::StatusOr<std::unique_ptr<ChannelDrawer>> {
        ASSIGN_OR_RETURN(std::unique_ptr<Renderer> renderer, Renderer::create(options));
        return std::make_unique<RendererDrawer>(std::move(renderer), allowed, places);
    };
}

}  // namespace eyrie::service
