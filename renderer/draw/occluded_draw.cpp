// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/occluded_draw.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "fabric/status.h"

namespace eyrie::draw {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds since the last lap.
class Laps {
public:
    double lap() {
        const auto now = Clock::now();
        return std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count();
    }

private:
    Clock::time_point last_ = Clock::now();
};

void begin(const ChannelDraw& channel) {
    channel.framebuffer.begin(channel.view.width, channel.view.height, channel.covered,
                              channel.background);
    channel.state.apply();
}

std::vector<lod::ObjectView> objectViews(const lod::View& view, const ChannelDraw& channel) {
    std::vector<lod::ObjectView> views;
    for (const fabric::Mat4& worldFromObject : channel.worldFromObject)
        views.emplace_back(view, worldFromObject);
    return views;
}

/// Whether something holds of a piece's box or, if not, of the boxes of its parts.
template <typename Test>
bool holds(const ChannelDraw& channel, const OrderedPiece& one, const Test& test) {
    if (test(std::span(&one.piece.bounds, 1)))
        return true;
    const std::vector<fabric::Box> parts = channel.partBounds(one);
    return !parts.empty() && test(std::span(parts));
}

/// The pieces that probably are seen, and those that probably are not.
std::pair<OccludedDraw::Pieces, OccludedDraw::Pieces> expected(
    const ChannelDraw& channel, std::span<const OrderedPiece> pieces,
    const occlusion::ChannelMemory& memory) {
    const std::vector<lod::ObjectView> lastViews = objectViews(memory.view, channel);
    std::pair<OccludedDraw::Pieces, OccludedDraw::Pieces> parts;
    for (const OrderedPiece& one : pieces) {
        const bool isHidden =
            memory.isFresh && holds(channel, one, [&](std::span<const fabric::Box> boxes) {
                return memory.expectsHidden(lastViews[one.object], boxes, channel.part);
            });
        (isHidden ? parts.second : parts.first).push_back(&one);
    }
    return parts;
}

}  // namespace

absl::Status OccludedDraw::draw(const ChannelDraw& channel, std::span<const OrderedPiece> pieces,
                                fabric::Occlusion mode, const DrawPieces& drawPieces,
                                fabric::FrameStatistics& statistics) {
    begin(channel);
    if (mode != fabric::Occlusion::Off) {
        occlusion::ChannelMemory& memory = memories_.of(channel.view, channel.range, channel.part);
        const bool isDue = memory.payoff.isDue();
        memory.isFresh = memory.isFresh && (memory.payoff.pays() || mode == fabric::Occlusion::On);
        if (isDue || mode == fabric::Occlusion::On)
            return drawLooking(channel, pieces, memory, drawPieces, statistics);
    }
    Pieces all;
    for (const OrderedPiece& one : pieces) all.push_back(&one);
    return drawPieces(all, statistics);
}

absl::Status OccludedDraw::drawLooking(const ChannelDraw& channel,
                                       std::span<const OrderedPiece> pieces,
                                       occlusion::ChannelMemory& memory,
                                       const DrawPieces& drawPieces,
                                       fabric::FrameStatistics& statistics) {
    Laps laps;
    occlusion::Payoff::Look look;
    auto [early, late] = expected(channel, pieces, memory);
    look.milliseconds += laps.lap();
    RETURN_IF_ERROR(drawPieces(early, statistics));
    glFinish();
    look.drawMilliseconds = laps.lap();
    look.drawn = statistics.triangles;

    remember(channel, memory);
    const std::vector<lod::ObjectView> views = objectViews(channel.view, channel);
    const auto isHidden = [&](const OrderedPiece* one) {
        const bool hidden = holds(channel, *one, [&](std::span<const fabric::Box> boxes) {
            return std::all_of(boxes.begin(), boxes.end(), [&](const fabric::Box& box) {
                return occlusion::isHidden(memory.pyramid, views[one->object], box);
            });
        });
        look.hidden += hidden ? one->piece.triangles : 0;
        return hidden;
    };
    statistics.nodesHidden += std::erase_if(late, isHidden);
    if (!memory.payoff.pays())
        static_cast<void>(std::count_if(early.begin(), early.end(), isHidden));
    bool isTie = false;
    if (!late.empty()) {
        ASSIGN_OR_RETURN(isTie, doTie(channel, late, drawPieces, statistics));
    }
    look.milliseconds += laps.lap();
    if (isTie) {
        RETURN_IF_ERROR(drawAgain(channel, std::move(early), late, drawPieces, statistics));
        look.milliseconds += laps.lap();
    } else {
        RETURN_IF_ERROR(drawPieces(late, statistics));
    }
    memory.payoff.add(look);
    return absl::OkStatus();
}

void OccludedDraw::remember(const ChannelDraw& channel, occlusion::ChannelMemory& memory) {
    memory.pyramid.build(channel.covered, channel.framebuffer.depth(channel.covered));
    memory.view = channel.view;
    memory.isFresh = true;
}

/// Whether any of `late` is just as near as what is there on a pixel of both. Draws nothing.
absl::StatusOr<bool> OccludedDraw::doTie(const ChannelDraw& channel, const Pieces& late,
                                         const DrawPieces& drawPieces,
                                         fabric::FrameStatistics& statistics) const {
    fabric::FrameStatistics looked;
    glDepthFunc(GL_EQUAL);
    glDepthMask(GL_FALSE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, anyTie_.id());
    const absl::Status drawn = drawPieces(late, looked);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    channel.state.apply();
    RETURN_IF_ERROR(drawn);
    statistics.pagesLoaded += looked.pagesLoaded;
    statistics.bytesLoaded += looked.bytesLoaded;
    GLuint any = GL_FALSE;
    glGetQueryObjectuiv(anyTie_.id(), GL_QUERY_RESULT, &any);
    return any != GL_FALSE;
}

absl::Status OccludedDraw::drawAgain(const ChannelDraw& channel, Pieces early, const Pieces& late,
                                     const DrawPieces& drawPieces,
                                     fabric::FrameStatistics& statistics) {
    const auto middle = static_cast<std::ptrdiff_t>(early.size());
    early.insert(early.end(), late.begin(), late.end());
    std::inplace_merge(early.begin(), early.begin() + middle, early.end());
    statistics.triangles = statistics.points = statistics.nodes = 0;
    statistics.normalErrorDegrees = statistics.normalErrorMeanDegrees = 0;
    begin(channel);
    return drawPieces(early, statistics);
}

}  // namespace eyrie::draw
