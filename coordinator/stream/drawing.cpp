// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/drawing.h"

#include <algorithm>
#include <cmath>

#include "coordinator/frame/eye_sides.h"
#include "fabric/frame_data.h"
#include "fabric/ground.h"
#include "fabric/smaller_picture.h"

namespace eyrie::stream {
namespace {

/// About 1460 x 820.
constexpr double kMostMovingSoftwarePixels = 1.2e6;

bool draws(const coordinator::RendererStatus& renderer) {
    return renderer.condition == coordinator::RendererCondition::Ready ||
           renderer.condition == coordinator::RendererCondition::Late;
}

}  // namespace

PictureSource pictureSource(const coordinator::Status& status) {
    PictureSource source{.scene = status.scene,
                         .sceneInfo = status.sceneInfo,
                         .renderers = {},
                         .canvases = status.canvases,
                         .sceneRevision = status.sceneRevision,
                         .displayRevision = status.displayRevision};
    bool isSoftware = false;
    for (const coordinator::RendererStatus& renderer : status.renderers)
        if (draws(renderer)) {
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
    const auto [width, height] =
        fabric::smallerPicture(request.width, request.height, scale, kMinPictureSide);
    request.width = width;
    request.height = height;
    const double ofShape =
        fabric::shapeErrorPixels(view.frame.width, view.frame.height, {width, height});
    const double left = std::max(request.tauPixels - ofShape, request.tauPixels / 2);
    request.tauPixels = std::max(fabric::kMinTauPixels, left / stretchOf(view, {width, height}));
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

fabric::PictureSides drawnSides(const coordinator::FrameRequest& asked,
                                const fabric::PixelViewport& drawn) {
    const bool mayBeSmaller = asked.budgetMilliseconds && !drawn.isEmpty();
    return mayBeSmaller ? coordinator::sidesOfEye(asked, drawn)
                        : fabric::PictureSides{asked.width, asked.height};
}

double stretchOf(const ViewRequest& view, const fabric::PictureSides& drawn) {
    return std::max({1.0, static_cast<double>(view.frame.width) / drawn.width,
                     static_cast<double>(view.frame.height) / drawn.height});
}

void tellAtFullSize(fabric::FrameStatistics& statistics, const ViewRequest& view,
                    const fabric::PictureSides& drawn) {
    const double stretch = stretchOf(view, drawn);
    statistics.tauAskedPixels = view.frame.tauPixels;
    statistics.tauAchievedPixels =
        statistics.tauAchievedPixels * stretch +
        fabric::shapeErrorPixels(view.frame.width, view.frame.height, drawn);
    if (statistics.budget)
        statistics.budget->tauPixels *= stretch;
}

}  // namespace eyrie::stream
