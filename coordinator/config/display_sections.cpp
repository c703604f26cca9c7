// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "coordinator/config/attribute_table.h"
#include "coordinator/config/screen.h"
#include "coordinator/config/section_readers.h"

namespace eyrie::config {
namespace {

constexpr std::string_view kHeadByApi = "the head's position is set by the API";

void vector(const Statement& statement, ValueReader& reader, std::optional<fabric::Vec3>& target) {
    reader.optional(target, [&](fabric::Vec3& value) { reader.vector(statement, value); });
}

bool isCamera(const std::string& text) {
    return text == "ON" || text == "OFF" || text == "AUTO" ||
           (!text.empty() && text.size() < 10 &&
            text.find_first_not_of("0123456789") == std::string::npos);
}

View readView(const Statement& block, const Configuration& before, ValueReader& reader) {
    View view;
    view.place = block.place;
    reader.block(
        block, "a view",
        {{"name", [&](const auto& each) { reader.text(each, view.name); }},
         {"mode",
          [&](const auto& each) {
              reader.choice<bool>(each, {{"MONO", false}, {"STEREO", true}}, view.isStereo);
          }},
         {"viewport", [&](const auto& each) { reader.fraction(each, view.viewport); }},
         {"wall", [&](const auto& each) { view.surface = readWall(each, reader); }, false, "wall"},
         {"projection", [&](const auto& each) { view.surface = readProjection(each, reader); },
          false, "wall"},
         {"observer",
          [&](const auto& each) {
              view.observer = reader.reference(each, before.observers, "observer");
          }},
         {"DisplayCluster",  // as older versions wrote it
          [&](const auto& each) {
              readAttribute(each, AttributeScope::View, reader, view.attributes);
          },
          true},
         {"attributes", [&](const auto& each) {
              readAttributes(each, AttributeScope::View, reader, view.attributes);
          }}});
    return view;
}

Segment readSegment(const Statement& block, const Configuration& before, ValueReader& reader) {
    Segment segment;
    segment.place = block.place;
    reader.block(
        block, "a segment",
        {{"name", [&](const auto& each) { reader.text(each, segment.name); }},
         {"channel",
          [&](const auto& each) { segment.channel = readChannel(each, before, reader); }},
         {"viewport", [&](const auto& each) { reader.fraction(each, segment.viewport); }},
         {"eye",
          [&](const auto& each) {
              reader.flags(each, {{"CYCLOP", &segment.eyes.cyclop},
                                  {"LEFT", &segment.eyes.left},
                                  {"RIGHT", &segment.eyes.right}});
          }},
         {"wall", [&](const auto& each) { segment.surface = readWall(each, reader); }, false,
          "wall"},
         {"projection", [&](const auto& each) { segment.surface = readProjection(each, reader); },
          false, "wall"},
         {"swapbarrier",
          [&](const auto& each) { segment.swapBarrier = readSwapBarrier(each, reader); }, false,
          "swapbarrier"}});
    return segment;
}

void addLayout(const Statement& statement, const Configuration& before, ValueReader& reader,
               Canvas& canvas) {
    const Scalar* const value = ValueReader::single(statement);
    if (value != nullptr && value->isWord("OFF"))
        canvas.layouts.push_back(std::nullopt);
    else if (const auto layout = reader.reference(statement, before.layouts, "layout"))
        canvas.layouts.push_back(layout);
}

/// Walls measured to the centimetre are nearly rectangles.
void checkCorners(const Wall& wall, const Place& place, Findings& findings) {
    constexpr double kMostSkew = 2e-2;  // 1.1 degrees
    if (!(glm::distance(wall.bottomLeft, wall.bottomRight) > 0 &&
          glm::distance(wall.bottomLeft, wall.topLeft) > 0))
        return findings.error(place, "the wall's corners are no rectangle's: two are one");
    const double skew = std::abs(skewOf(wall));
    if (!(skew <= kMostSkew))
        findings.error(place,
                       "the wall's corners are no rectangle's: its sides do not meet at a right "
                       "angle in bottom_left");
    else if (skew > kRoundedSkew)
        findings.warning(
            place, fmt::format("the wall's sides meet at {:.2f} degrees in bottom_left: it is "
                               "taken for the rectangle with the lower side and as high",
                               glm::degrees(std::acos(skewOf(wall)))));
}

}  // namespace

Surface readWall(const Statement& block, ValueReader& reader) {
    Wall wall;
    reader.block(
        block, "a wall",
        {{"bottom_left", [&](const auto& each) { reader.vector(each, wall.bottomLeft); }},
         {"bottom_right", [&](const auto& each) { reader.vector(each, wall.bottomRight); }},
         {"top_left", [&](const auto& each) { reader.vector(each, wall.topLeft); }},
         {"type", [&](const auto& each) {
              reader.choice<bool>(each, {{"fixed", false}, {"HMD", true}}, wall.movesWithHead);
          }}});
    checkCorners(wall, block.place, reader.findings());
    return wall;
}

Surface readProjection(const Statement& block, ValueReader& reader) {
    Projection projection;
    reader.block(block, "a projection",
                 {{"origin", [&](const auto& each) { reader.vector(each, projection.origin); }},
                  {"distance", [&](const auto& each) { reader.number(each, projection.distance); }},
                  {"fov", [&](const auto& each) { reader.pair(each, projection.fovDegrees); }},
                  {"hpr", [&](const auto& each) {
                       reader.vector(each, projection.headingPitchRollDegrees);
                   }}});
    if (!(projection.distance > 0))
        reader.findings().error(block.place, fmt::format("a projection's distance is {}; it must "
                                                         "be above 0",
                                                         projection.distance));
    for (const double fov : {projection.fovDegrees.x, projection.fovDegrees.y})
        if (!(fov > 0 && fov < 180))
            reader.findings().error(block.place, fmt::format("a projection's fov is {} degrees; it "
                                                             "must be between 0 and 180",
                                                             fov));
    return projection;
}

SwapBarrier readSwapBarrier(const Statement& block, ValueReader& reader) {
    SwapBarrier barrier;
    const auto setting = [&](const Statement& each) {
        readAttribute(each, AttributeScope::SwapBarrier, reader, barrier.attributes);
    };
    reader.block(block, "a swapbarrier",
                 {{"name", [&](const auto& each) { reader.text(each, barrier.name); }},
                  {"NV_group", setting, true},
                  {"NV_barrier", setting, true}});
    return barrier;
}

Observer readObserver(const Statement& block, ValueReader& reader) {
    Observer observer;
    observer.place = block.place;
    reader.block(
        block, "an observer",
        {{"name", [&](const auto& each) { reader.text(each, observer.name); }},
         {"eye_base",
          [&](const auto& each) {
              reader.optional(observer.eyeBase, [&](double& value) { reader.number(each, value); });
          }},
         {"eye_left", [&](const auto& each) { vector(each, reader, observer.eyeLeft); }},
         {"eye_cyclop", [&](const auto& each) { vector(each, reader, observer.eyeCyclop); }},
         {"eye_right", [&](const auto& each) { vector(each, reader, observer.eyeRight); }},
         {"focus_distance", [&](const auto& each) { reader.number(each, observer.focusDistance); }},
         {"focus_mode",
          [&](const auto& each) {
              reader.choice<FocusMode>(each,
                                       {{"fixed", FocusMode::Fixed},
                                        {"relative_to_origin", FocusMode::RelativeToOrigin},
                                        {"relative_to_observer", FocusMode::RelativeToObserver}},
                                       observer.focusMode);
          }},
         {"opencv_camera",
          [&](const auto& each) {
              const Scalar* const value = ValueReader::single(each);
              if (value == nullptr || !isCamera(value->text))
                  return reader.expected(each, "ON, OFF, AUTO or a whole number");
              observer.openCvCamera = value->text;
              reader.hasNoEffect(each, kHeadByApi);
          }},
         {"vrpn_tracker", [&](const auto& each) {
              reader.text(each, observer.vrpnTracker);
              reader.hasNoEffect(each, kHeadByApi);
          }}});
    if (!(observer.focusDistance > 0 && observer.focusDistance <= kMostEyeMetres))
        reader.findings().error(block.place, fmt::format("an observer's focus distance is {}; it "
                                                         "must be above 0 and at most {}",
                                                         observer.focusDistance, kMostEyeMetres));
    return observer;
}

Layout readLayout(const Statement& block, const Configuration& before, ValueReader& reader) {
    Layout layout;
    layout.place = block.place;
    reader.block(block, "a layout",
                 {{"name", [&](const auto& each) { reader.text(each, layout.name); }},
                  {"view", [&](const auto& each) {
                       layout.views.push_back(readView(each, before, reader));
                   }}});
    if (layout.name == "OFF")
        reader.findings().warning(block.place,
                                  "the layout is called \"OFF\", which is how none is asked for: "
                                  "that finds this one, and "
                                  "its canvases are not turned off; call it otherwise");
    return layout;
}

Canvas readCanvas(const Statement& block, const Configuration& before, ValueReader& reader) {
    Canvas canvas;
    canvas.place = block.place;
    reader.block(
        block, "a canvas",
        {{"name", [&](const auto& each) { reader.text(each, canvas.name); }},
         {"layout", [&](const auto& each) { addLayout(each, before, reader, canvas); }, true},
         {"wall", [&](const auto& each) { canvas.surface = readWall(each, reader); }, false,
          "wall"},
         {"projection", [&](const auto& each) { canvas.surface = readProjection(each, reader); },
          false, "wall"},
         {"swapbarrier",
          [&](const auto& each) { canvas.swapBarrier = readSwapBarrier(each, reader); }, false,
          "swapbarrier"},
         {"segment", [&](const auto& each) {
              canvas.segments.push_back(readSegment(each, before, reader));
          }}});
    return canvas;
}

}  // namespace eyrie::config
