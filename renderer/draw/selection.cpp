// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/selection.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace eyrie::draw {
namespace {

void addTo(fabric::FrameStatistics& statistics, const Cut& cut) {
    statistics.complete = statistics.complete && cut.isComplete;
    statistics.memoryRaisedTau = statistics.memoryRaisedTau || cut.memoryRaisedTau;
    statistics.pagesLoaded += cut.pagesLoaded;
    statistics.bytesLoaded += cut.bytesLoaded;
    statistics.pagesMissing += cut.pagesMissing;
    statistics.pagesFailed += cut.pagesFailed;
    statistics.tilesDecodedOnGpu += cut.tilesDecodedOnGpu;
}

/// The farthest first, by the middles of their boxes.
void sortBackToFront(std::vector<OrderedPiece>& pieces, const lod::View& view,
                     const std::vector<fabric::Mat4>& worldFromObject) {
    std::vector<lod::ObjectView> views;
    for (const fabric::Mat4& one : worldFromObject) views.emplace_back(view, one);
    const auto height = [&](const OrderedPiece& one) {  // the view looks down
        return (views[one.object].viewFromObject() * fabric::Vec4(one.piece.bounds.centre(), 1.0))
            .z;
    };
    std::stable_sort(pieces.begin(), pieces.end(),
                     [&](const auto& a, const auto& b) { return height(a) < height(b); });
}

/// What of each object's work falls to the channel. Of the view's work objects have a share each,
/// one after the other; every channel of a frame comes to the same.
std::vector<fabric::Range> rangesOf(std::span<const OpenObject> objects, const lod::View& view,
                                    const fabric::FrameData& frameData,
                                    const fabric::ChannelTask& task) {
    std::vector<fabric::Range> ranges(objects.size());
    if (task.range.isWhole())
        return ranges;
    const fabric::Look& look = frameData.look;
    std::vector<double> work(objects.size(), 0.0);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (look.hidden.contains(i))
            continue;
        const lod::ObjectView objectView(view, drawnWorldFromObject(objects[i].object, look));
        work[i] = objects[i].drawable->viewWork({.view = objectView,
                                                 .channel = view.frustum,
                                                 .range = {},
                                                 .tauPixels = frameData.tauPixels,
                                                 .exaggeration = look.exaggeration});
    }
    const double total = std::accumulate(work.begin(), work.end(), 0.0);
    double before = 0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const auto inObject = [&](double place) {
            if (place <= 0 || place >= 1)
                return place <= 0 ? 0.0 : 1.0;
            const double beyond = place * total - before;
            return work[i] > 0 ? std::clamp(beyond / work[i], 0.0, 1.0) : beyond > 0 ? 1.0 : 0.0;
        };
        ranges[i] = {inObject(task.range.begin), inObject(task.range.end)};
        before += work[i];
    }
    return ranges;
}

}  // namespace

bool hasLines(const fabric::FrameData& frameData) {
    const fabric::Look& look = frameData.look;
    return frameData.shading == fabric::Shading::Wireframe || look.tileBounds || look.pageBounds ||
           std::ranges::any_of(look.objects.looks, [](const fabric::ObjectLook& one) {
               return one.shading == fabric::Shading::Wireframe;
           });
}

fabric::PixelViewport reach(const fabric::FrameData& frameData, const fabric::PixelViewport& part) {
    return hasLines(frameData)
               ? fabric::PixelViewport{part.x - 1, part.y - 1, part.width + 2, part.height + 2}
               : part;
}

lod::View cutViewOf(const fabric::Look& look, const fabric::ChannelTask& task,
                    const lod::View& whole) {
    return look.cutCamera ? lod::View(*look.cutCamera, task.sight, task.viewWidth, task.viewHeight)
                          : whole;
}

Selection selectPieces(std::span<const OpenObject> objects, const lod::TaskViews& views,
                       const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                       const ViewTurn& turn, fabric::FrameStatistics& statistics,
                       const std::stop_token& stop) {
    Selection selection;
    std::vector<OrderedPiece>& pieces = selection.pieces;
    const fabric::Look& look = frameData.look;
    const fabric::Frustum channel =
        lod::subFrustum(views.drawn, reach(frameData, task.pixelViewport));
    // A cut that was frozen is brought whole: this view may see all of it.
    const lod::View cutView = cutViewOf(look, task, views.whole);
    const fabric::Frustum& cutChannel = look.cutCamera ? cutView.frustum : channel;
    const std::vector<fabric::Range> ranges = rangesOf(objects, cutView, frameData, task);
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        const fabric::Mat4& worldFromObject =
            selection.worldFromObject.emplace_back(drawnWorldFromObject(objects[i].object, look));
        if (look.hidden.contains(i))
            continue;
        const lod::ObjectView objectView(views.drawn, worldFromObject);
        const lod::ObjectView cutObjectView(cutView, worldFromObject);
        const Cut cut = objects[i].drawable->selectCut(
            {cutObjectView, cutChannel, ranges[i], frameData.tauPixels, task.completeness,
             look.exaggeration, look.pageBounds, look.cutCamera.has_value(), stop, turn});
        addTo(statistics, cut);
        const bool hasLayers =
            look.objects.shadingOf(i, frameData.shading) != fabric::Shading::Wireframe;
        for (const Piece& piece : cut.pieces) {
            const bool isInRange = ranges[i].contains(piece.rangePosition);
            const bool isBlended = piece.hasBlended && hasLayers;
            if ((!isInRange && !isBlended) || !objectView.isVisible(piece.bounds, channel))
                continue;
            if (isInRange)
                pieces.push_back({i, piece});
            if (isBlended)
                selection.blended.push_back({i, piece});
            if (!selection.covered.contains(task.pixelViewport))
                selection.covered =
                    enclosing(selection.covered, objectView.coveredPixels(piece.bounds));
        }
    }
    sortBackToFront(selection.blended, views.drawn, selection.worldFromObject);
    selection.covered = intersection(selection.covered, task.pixelViewport);
    return selection;
}

}  // namespace eyrie::draw
