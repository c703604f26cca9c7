// SPDX-License-Identifier: Apache-2.0
#include "tests/support/local_pictures.h"

#include "coordinator/compound/compose.h"
#include "fabric/status.h"

namespace eyrie::test {

absl::StatusOr<std::unique_ptr<LocalPictures>> LocalPictures::open(const fabric::Scene& scene) {
    ASSIGN_OR_RETURN(auto renderer, Renderer::create({}));
    ASSIGN_OR_RETURN(const fabric::SceneInfo info, renderer->openScene(scene));
    return std::unique_ptr<LocalPictures>(
        new LocalPictures(std::move(renderer), info.bounds, scene.background));
}

absl::StatusOr<fabric::Image> LocalPictures::draw(const coordinator::FrameRequest& view,
                                                  fabric::ChannelTask task) {
    fabric::FrameData frameData;
    frameData.version = ++frames_;
    frameData.camera = view.camera;
    frameData.tauPixels = view.tauPixels;
    task.frameDataVersion = frames_;
    if (task.viewWidth == 0) {
        task.viewWidth = view.width;
        task.viewHeight = view.height;
    }
    ASSIGN_OR_RETURN(const fabric::ChannelResult result, renderer_->render(frameData, task));
    fabric::Image image = fabric::makeImage(task.pixelViewport, background_, task.wantsDepth);
    if (!result.image.area.isEmpty())
        fabric::paste(result.image, image);
    return image;
}

absl::StatusOr<fabric::Image> LocalPictures::draw(const coordinator::FrameRequest& view,
                                                  const fabric::Raster& raster) {
    fabric::ChannelTask task;
    task.raster = raster;
    task.pixelViewport = {0, 0, raster.width, raster.height};
    return draw(view, task);
}

absl::StatusOr<std::vector<fabric::Image>> LocalPictures::pictures(
    const coordinator::FrameRequest& view, const compound::Plan& plan) {
    std::vector<fabric::LentImage> drawn;
    for (const compound::PlannedDraw& each : plan.draws) {
        ASSIGN_OR_RETURN(fabric::Image image, draw(view, each.task));
        drawn.emplace_back(std::move(image));
    }
    return compound::composePictures(plan, std::move(drawn), background_);
}

}  // namespace eyrie::test
