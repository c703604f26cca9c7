// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/picture_error.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "renderer/draw/selection.h"

namespace eyrie::draw {
namespace {

std::vector<std::size_t> shownOf(std::span<const OpenObject> objects, const fabric::Look& look) {
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < objects.size(); ++i)
        if (!look.hidden.contains(i))
            shown.push_back(i);
    return shown;
}

bool isGroundAlone(std::span<const OpenObject> objects, const std::vector<std::size_t>& shown,
                   const fabric::FrameData& frameData) {
    const fabric::Look& look = frameData.look;
    return shown.size() == 1 && !look.transfer && !look.tileBounds && !look.pageBounds &&
           look.objects.shadingOf(shown[0], frameData.shading) != fabric::Shading::Wireframe &&
           objects[shown[0]].object.kind == fabric::ObjectKind::Terrain;
}

}  // namespace

double promisedPixels(std::span<const OpenObject> objects, const lod::TaskViews& views,
                      const FinishedPicture& picture) {
    const auto& [frameData, task, covered, framebuffer, depthReading] = picture;
    const fabric::Look& look = frameData.look;
    if (look.cutCamera)
        return std::numeric_limits<double>::infinity();
    const std::vector<std::size_t> shown = shownOf(objects, look);
    const bool mayHide = isGroundAlone(objects, shown, frameData);
    const fabric::Frustum channel =
        lod::subFrustum(views.drawn, reach(frameData, task.pixelViewport));
    double worst = 0;
    for (const std::size_t i : shown) {
        const fabric::Mat4 worldFromObject = drawnWorldFromObject(objects[i].object, look);
        const lod::ObjectView objectView(views.whole, worldFromObject);
        const lod::ObjectView drawnView(views.drawn, worldFromObject);
        occlusion::HiddenGround hidden(
            drawnView, covered,
            [&picture](const auto& part) { return picture.framebuffer.depth(part); }, depthReading);
        const double pixels = objects[i].drawable->errorPixels(
            {objectView, channel, task.range, frameData.tauPixels, task.completeness,
             look.exaggeration, look.pageBounds},
            mayHide ? &hidden : nullptr);
        worst = std::max(worst, pixels);
    }
    return worst;
}

}  // namespace eyrie::draw
