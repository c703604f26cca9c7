// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/statement_list.h"

namespace eyrie::config {
namespace {

void vector(std::string_view keyword, const std::optional<fabric::Vec3>& value,
            StatementList& list) {
    if (value)
        list.vector(keyword, *value);
}

std::string_view wordOf(FocusMode mode) {
    switch (mode) {
        case FocusMode::Fixed:
            return "fixed";
        case FocusMode::RelativeToOrigin:
            return "relative_to_origin";
        case FocusMode::RelativeToObserver:
            break;
    }
    return "relative_to_observer";
}

void writeView(const Configuration& all, const View& view, StatementList& list) {
    StatementList inner;
    inner.text("name", view.name);
    if (view.isStereo)
        inner.word("mode", "STEREO");
    if (view.viewport != Viewport{})
        inner.viewport("viewport", view.viewport);
    writeSurface(view.surface, inner);
    if (view.observer)
        writeReference("observer", all.observers, *view.observer, inner);
    inner.attributes("attributes", view.attributes);
    list.block("view", std::move(inner));
}

void writeSegment(const Configuration& all, const Segment& segment, StatementList& list) {
    StatementList inner;
    inner.text("name", segment.name);
    if (segment.channel)
        writeChannel(all, *segment.channel, inner);
    if (segment.viewport != Viewport{})
        inner.viewport("viewport", segment.viewport);
    if (segment.eyes != Eyes{true, true, true})
        inner.eyes("eye", segment.eyes);
    writeSurface(segment.surface, inner);
    writeSwapBarrier(segment.swapBarrier, inner);
    list.block("segment", std::move(inner));
}

}  // namespace

void writeSurface(const Surface& surface, StatementList& list) {
    StatementList inner;
    if (const auto* wall = std::get_if<Wall>(&surface)) {
        inner.vector("bottom_left", wall->bottomLeft);
        inner.vector("bottom_right", wall->bottomRight);
        inner.vector("top_left", wall->topLeft);
        if (wall->movesWithHead)
            inner.word("type", "HMD");
        list.block("wall", std::move(inner));
    } else if (const auto* projection = std::get_if<Projection>(&surface)) {
        inner.vector("origin", projection->origin);
        inner.number("distance", std::optional(projection->distance));
        inner.pair("fov", projection->fovDegrees);
        inner.vector("hpr", projection->headingPitchRollDegrees);
        list.block("projection", std::move(inner));
    }
}

void writeSwapBarrier(const std::optional<SwapBarrier>& barrier, StatementList& list) {
    if (!barrier)
        return;
    StatementList inner;
    inner.text("name", barrier->name);
    inner.attributes(barrier->attributes);
    list.block("swapbarrier", std::move(inner));
}

void writeObserver(const Observer& observer, StatementList& list) {
    StatementList inner;
    inner.text("name", observer.name);
    inner.number("eye_base", observer.eyeBase);
    vector("eye_left", observer.eyeLeft, inner);
    vector("eye_cyclop", observer.eyeCyclop, inner);
    vector("eye_right", observer.eyeRight, inner);
    inner.number("focus_distance", observer.focusDistance, 1.0);
    if (observer.focusMode != FocusMode::Fixed)
        inner.word("focus_mode", wordOf(observer.focusMode));
    if (!observer.openCvCamera.empty())
        inner.word("opencv_camera", observer.openCvCamera);
    inner.text("vrpn_tracker", observer.vrpnTracker);
    list.block("observer", std::move(inner));
}

void writeLayout(const Configuration& all, const Layout& layout, StatementList& list) {
    StatementList inner;
    inner.text("name", layout.name);
    for (const View& view : layout.views) writeView(all, view, inner);
    list.block("layout", std::move(inner));
}

void writeCanvas(const Configuration& all, const Canvas& canvas, StatementList& list) {
    StatementList inner;
    inner.text("name", canvas.name);
    for (const std::optional<std::size_t>& layout : canvas.layouts)
        if (layout)
            writeReference("layout", all.layouts, *layout, inner);
        else
            inner.word("layout", "OFF");
    writeSurface(canvas.surface, inner);
    writeSwapBarrier(canvas.swapBarrier, inner);
    for (const Segment& segment : canvas.segments) writeSegment(all, segment, inner);
    list.block("canvas", std::move(inner));
}

}  // namespace eyrie::config
