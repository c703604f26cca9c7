// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/scene_draw.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

#include "effects/object_block.h"
#include "fabric/status.h"
#include "renderer/draw/scene_lights.h"
#include "renderer/gl/pass_state.h"

namespace eyrie::draw {
namespace {

using Clock = std::chrono::steady_clock;

const gl::PassState& passState(fabric::Shading shading) {
    return shading == fabric::Shading::Wireframe ? effects::ObjectBlock::kWireframe
                                                 : effects::ObjectBlock::kSolid;
}

FrameState stateOf(const SceneFrame& frame, const fabric::Lights& lights,
                   const fabric::PixelViewport& part) {
    return {frame.view,         lights, frame.frameData.shading,  frame.frameData.look,
            frame.task.range,   part,   frame.task.pixelViewport, Layer::Opaque,
            frame.delivery.stop};
}

/// Surfaces, never lines. Tested against the opaque surfaces' depth, which stays: what is not
/// opaque has none.
absl::Status drawBlended(std::span<const OpenObject> objects, std::span<const OrderedPiece> pieces,
                         FrameState state, fabric::FrameStatistics& statistics) {
    if (pieces.empty())
        return absl::OkStatus();
    state.layer = Layer::Blended;
    effects::ObjectBlock::kSolid.apply();
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    absl::Status drawn;
    for (std::size_t i = 0; i < pieces.size() && drawn.ok(); ++i) {
        drawn = unlessStopped(state.stop);
        if (drawn.ok())
            drawn = objects[pieces[i].object].drawable->draw(
                std::span(&pieces[i].piece, 1), frameOf(state, pieces[i].object), statistics);
    }
    passState(state.shading).apply();
    return drawn;
}

}  // namespace

absl::Status unlessStopped(const std::stop_token& stop) {
    return stop.stop_requested() ? absl::CancelledError("nobody wants this picture any more")
                                 : absl::OkStatus();
}

absl::Status SceneDraw::drawPieces(std::span<const OpenObject> objects,
                                   const OccludedDraw::Pieces& pieces, const FrameState& frame,
                                   fabric::FrameStatistics& statistics) {
    std::vector<Piece> run;
    std::uint64_t triangles = 0;  // of the run
    const gl::PassState* state = &passState(frame.shading);
    const auto change = [&state](const gl::PassState& wanted) {
        if (std::exchange(state, &wanted) != &wanted)
            wanted.apply();
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        run.push_back(pieces[i]->piece);
        triangles += run.back().triangles;
        statistics.nodes += run.back().isNode ? 1 : 0;
        const bool isBatch = triangles >= Batches::kTriangles;
        if (!isBatch && i + 1 < pieces.size() && pieces[i + 1]->object == pieces[i]->object)
            continue;
        RETURN_IF_ERROR(unlessStopped(frame.stop));
        const FrameState own = frameOf(frame, pieces[i]->object);
        change(passState(own.shading));
        RETURN_IF_ERROR(objects[pieces[i]->object].drawable->draw(run, own, statistics));
        run.clear();
        batches_.add(std::exchange(triangles, 0));
    }
    change(passState(frame.shading));
    return absl::OkStatus();
}

absl::Status SceneDraw::draw(const SceneFrame& frame, fabric::FrameStatistics& statistics) {
    const auto& [scene, objects, selection, view, frameData, task, delivery] = frame;
    const fabric::Lights lights = lightsOf(scene, objects, frameData.look);
    const FrameState state = stateOf(frame, lights, task.pixelViewport);
    drawn_.clear();
    batches_.begin(delivery.nearlyDrawn != nullptr);
    RETURN_IF_ERROR(occludedDraw_.draw(
        {view, selection.worldFromObject,
         [&frame](const OrderedPiece& one) {
             return frame.objects[one.object].drawable->partBounds(one.piece);
         },
         task.pixelViewport, selection.covered, task.range, scene.background,
         passState(frameData.shading), framebuffer_},
        selection.pieces, hasLines(frameData) ? fabric::Occlusion::Off : frameData.occlusion,
        [&](const OccludedDraw::Pieces& pieces, fabric::FrameStatistics& drawn) {
            if (frame.task.measuresStages)
                drawn_.push_back(pieces);
            return drawPieces(frame.objects, pieces, state, drawn);
        },
        statistics));
    RETURN_IF_ERROR(drawBlended(objects, selection.blended, state, statistics));
    if (delivery.nearlyDrawn) {
        batches_.awaitMost();
        delivery.nearlyDrawn();
    }
    glFinish();
    return absl::OkStatus();
}

/// Draws what the frame drew once more, into a single pixel: a driver may leave out vertices that
/// it knows to make no pixels at all.
absl::Status SceneDraw::measureStages(const SceneFrame& frame,
                                      fabric::StageMilliseconds& milliseconds) {
    const auto& [scene, objects, selection, view, frameData, task, delivery] = frame;
    const fabric::PixelViewport pixel{selection.covered.x, selection.covered.y, 1, 1};
    const fabric::Lights lights = lightsOf(scene, objects, frameData.look);
    const FrameState state = stateOf(frame, lights, pixel);
    framebuffer_.begin(view.width, view.height, pixel, scene.background);
    passState(frameData.shading).apply();
    glFinish();
    const auto start = Clock::now();
    batches_.begin(false);
    fabric::FrameStatistics ignored;
    for (const OccludedDraw::Pieces& pieces : drawn_)
        RETURN_IF_ERROR(drawPieces(objects, pieces, state, ignored));
    RETURN_IF_ERROR(drawBlended(objects, selection.blended, state, ignored));
    glFinish();
    const std::chrono::duration<double, std::milli> took = Clock::now() - start;
    milliseconds.vertices = std::min(took.count(), milliseconds.draw);
    milliseconds.fill = milliseconds.draw - milliseconds.vertices;
    return absl::OkStatus();
}

}  // namespace eyrie::draw
