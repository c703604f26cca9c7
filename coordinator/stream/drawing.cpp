// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/drawing.h"

#include <algorithm>
#include <cmath>

#include "fabric/frame_data.h"
#include "fabric/ground.h"

namespace eyrie::stream {
namespace {

/// About 1460 x 820.
constexpr double kMostMovingSoftwarePixels = 1.2e6;

/// Pixels of the picture asked for that one of the picture drawn covers, the longer way.
double stretch(const ViewRequest& view, const coordinator::FrameRequest& drawn) {
    return std::max(static_cast<double>(view.frame.width) / drawn.width,
                    static_cast<double>(view.frame.height) / drawn.height);
}

}  // namespace

PictureSource pictureSource(const coordinator::Status& status) {
    PictureSource source{status.scene, status.sceneInfo, {}, true, status.canvases};
    bool isSoftware = false;
    for (const coordinator::RendererStatus& renderer : status.renderers)
        if (renderer.isAlive()) {
            source.renderers.push_back(renderer.id);
            isSoftware |= renderer.device.software;
        }
    source.isSoftware = isSoftware || source.renderers.empty();
    return source;
}

double movingScale(const ViewRequest& view, const PictureSource* source) {
    if (source != nullptr && !source->isSoftware)
        return 1;
    const double pixels = static_cast<double>(view.frame.width) * view.frame.height;
    return std::min(1.0, std::sqrt(kMostMovingSoftwarePixels / pixels));
}

coordinator::FrameRequest drawingOf(const ViewRequest& view, const fabric::SceneInfo* scene,
                                    double scale) {
    coordinator::FrameRequest request = view.frame;
    if (scene != nullptr && scene->ground && !view.isUnderground)
        request.camera = fabric::aboveGround(request.camera, *scene->ground, request.look);
    if (scale == 1)
        return request;
    const auto scaled = [=](int side) {
        return std::max(kMinPictureSide, static_cast<int>(std::lround(scale * side)));
    };
    request.width = scaled(request.width);
    request.height = scaled(request.height);
    request.tauPixels = std::max(fabric::kMinTauPixels, request.tauPixels / stretch(view, request));
    return request;
}

std::optional<fabric::Vec3> liftOf(const ViewRequest& view, const fabric::SceneInfo* scene) {
    if (scene == nullptr || !scene->ground || !view.isUnderground)
        return std::nullopt;
    const fabric::Vec3& eye = view.frame.camera.eye;
    const fabric::Camera lifted =
        fabric::aboveGround(view.frame.camera, *scene->ground, view.frame.look);
    return lifted.eye == eye ? std::nullopt : std::optional(lifted.eye - eye);
}

double stretchOf(const ViewRequest& view, const coordinator::FrameRequest& asked,
                 const fabric::PixelViewport& drawn) {
    double within = 1;
    if (asked.budgetMilliseconds)
        within = std::max({1.0, static_cast<double>(asked.width) / std::max(1, drawn.width),
                           static_cast<double>(asked.height) / std::max(1, drawn.height)});
    return within * stretch(view, asked);
}

void tellAtFullSize(fabric::FrameStatistics& statistics, const ViewRequest& view, double stretch) {
    statistics.tauAskedPixels = view.frame.tauPixels;
    statistics.tauAchievedPixels *= stretch;
    if (statistics.budget)
        statistics.budget->tauPixels *= stretch;
}

}  // namespace eyrie::stream
