// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/budget_choice.h"

#include <cstddef>
#include <cstdint>

#include "fabric/frame_budget.h"
#include "fabric/viewport.h"
#include "renderer/draw/selection.h"

namespace eyrie::draw {
namespace {

/// Of all objects that are shown, in the whole view's cut.
std::uint64_t viewTriangles(std::span<const OpenObject> objects, const lod::View& view,
                            const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                            double tauPixels) {
    const fabric::Look& look = frameData.look;
    const lod::View cutView = cutViewOf(look, task, view);
    std::uint64_t triangles = 0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (look.hidden.contains(i))
            continue;
        const OpenObject& open = objects[i];
        const lod::ObjectView objectView(cutView, drawnWorldFromObject(open.object, look));
        triangles += open.drawable->viewTriangles({objectView,
                                                   cutView.frustum,
                                                   {},
                                                   tauPixels,
                                                   task.completeness,
                                                   look.exaggeration,
                                                   false});
    }
    return triangles;
}

/// Of the view's pixels, those in a rectangle around them.
double coveredShare(std::span<const OpenObject> objects, const lod::View& view,
                    const fabric::FrameData& frameData) {
    fabric::PixelViewport covered{};
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (frameData.look.hidden.contains(i))
            continue;
        const OpenObject& open = objects[i];
        const lod::ObjectView objectView(view, drawnWorldFromObject(open.object, frameData.look));
        covered = enclosing(covered, objectView.coveredPixels(open.drawable->bounds()));
    }
    const fabric::PixelViewport all{0, 0, view.width, view.height};
    return static_cast<double>(intersection(covered, all).area()) / static_cast<double>(all.area());
}

}  // namespace

fabric::FrameData withinBudget(std::span<const OpenObject> objects, const lod::View& view,
                               const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                               fabric::FrameStatistics& statistics) {
    fabric::FrameData drawn = frameData;
    if (!frameData.budget)
        return drawn;
    statistics.budget = fabric::tauForBudget(
        frameData.tauPixels, *frameData.budget, coveredShare(objects, view, frameData),
        [&](double tauPixels) { return viewTriangles(objects, view, frameData, task, tauPixels); });
    drawn.tauPixels = statistics.budget->tauPixels;
    return drawn;
}

}  // namespace eyrie::draw
