// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/composed_frame.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "coordinator/compound/compose.h"

namespace eyrie::coordinator {
namespace {

std::vector<CodedTile> tilesFrom(const std::vector<compound::Tile>& tiles,
                                 const std::vector<Dispatch::Drawn>& drawn) {
    std::vector<CodedTile> coded;
    for (const compound::Tile& tile : tiles)
        coded.push_back({tile.area, drawn[tile.draw].result.jpeg});
    return coded;
}

}  // namespace

Dispatch::Plan dispatchOf(const PlannedFrame& frame, const compound::Plan& draws, Takers takers,
                          std::chrono::milliseconds first) {
    Dispatch::Plan plan;
    plan.frameData = frame.frameData;
    for (const compound::PlannedDraw& draw : draws.draws) {
        fabric::ChannelTask& task = plan.tasks.emplace_back(draw.task);
        task.frameDataVersion = frame.frameData.version;
        task.completeness = frame.request.completeness;
        task.measuresStages = frame.request.measuresStages;
        task.jpegQuality = frame.tiles.empty() ? 0 : frame.request.jpegQuality;
    }
    plan.sceneRevision = frame.scene.revision;
    plan.kind = frame.kind;
    plan.firstPatience = first;
    plan.takers = std::move(takers);
    plan.stop = frame.request.stop;
    return plan;
}

std::vector<ActiveConfiguration::Taken> takenBy(const std::vector<Dispatch::Drawn>& drawn) {
    std::vector<ActiveConfiguration::Taken> taken;
    for (const Dispatch::Drawn& one : drawn)
        taken.push_back({one.result.image.area, one.result.statistics.milliseconds,
                         std::chrono::duration<double, std::milli>(one.taken).count()});
    return taken;
}

DrawnPart partOf(const fabric::ChannelTask& task, const std::string& renderer,
                 const fabric::FrameStatistics& statistics) {
    const fabric::PixelViewport& drawn = task.pixelViewport;
    const auto share = [](int pixels, int side) { return static_cast<double>(pixels) / side; };
    const fabric::PixelViewport whole = fabric::pictureOf(task);
    return {renderer,
            share(drawn.x, whole.width),
            share(drawn.y, whole.height),
            share(drawn.width, whole.width),
            share(drawn.height, whole.height),
            task.range,
            statistics.milliseconds.total,
            statistics.triangles};
}

RenderedFrame composedFrame(const PlannedFrame& frame, const compound::Plan& plan,
                            std::vector<Dispatch::Drawn> drawn, std::vector<fabric::Image> more) {
    RenderedFrame result;
    if (!drawn.empty())
        result.device = drawn.front().device;
    for (const compound::Picture& picture : frame.plan.pictures)
        result.pictures.push_back({picture.output, picture.seen, picture.whyBlind});
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const Dispatch::Drawn& part = drawn[i];
        fabric::accumulate(result.statistics, part.result.statistics);
        result.parts.push_back(partOf(plan.draws[i].task, part.renderer, part.result.statistics));
    }
    result.statistics.tauAskedPixels = frame.request.tauPixels;
    if (!frame.tiles.empty()) {
        result.tiles = tilesFrom(frame.tiles, drawn);
        result.image.area = frame.plan.pictures.front().area;
        return result;
    }
    std::vector<fabric::LentImage> images;
    for (Dispatch::Drawn& part : drawn)
        images.push_back(part.result.lent ? *std::move(part.result.lent)
                                          : std::move(part.result.image));
    std::ranges::move(more, std::back_inserter(images));
    std::vector<fabric::Image> pictures =
        compound::composePictures(plan, std::move(images), frame.scene.scene->background);
    if (pictures.empty())
        return result;
    result.image = std::move(pictures.front());
    result.further.assign(std::make_move_iterator(pictures.begin() + 1),
                          std::make_move_iterator(pictures.end()));
    return result;
}

}  // namespace eyrie::coordinator
