// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/shares.h"

#include <string_view>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::compound {
namespace {

constexpr double kSlack = 1e-3;  // thirds are written as .3333 and .6667
constexpr double kMostZoom = 64;
constexpr std::int64_t kMostShares = 16384;

absl::Status wrong(std::string_view what, std::string_view name, std::string_view found,
                   std::string_view expected) {
    return absl::InvalidArgumentError(
        fmt::format("{} \"{}\" has {}; expected {}", what, name, found, expected));
}

bool isShare(double begin, double size) {
    return begin >= -kSlack && size >= 0 && begin + size <= 1 + kSlack;
}

absl::Status check(std::string_view what, std::string_view name, const config::Viewport& viewport,
                   double least) {
    if (isShare(viewport.x, viewport.width) && isShare(viewport.y, viewport.height) &&
        viewport.width >= least && viewport.height >= least)
        return absl::OkStatus();
    return wrong(what, name,
                 fmt::format("the viewport [ {} {} {} {} ]", viewport.x, viewport.y, viewport.width,
                             viewport.height),
                 "a part of [ 0 0 1 1 ]");
}

absl::Status checkZoom(std::string_view name, const fabric::Vec2& zoom) {
    if (zoom.x > 0 && zoom.y > 0 && zoom.x <= kMostZoom && zoom.y <= kMostZoom)
        return absl::OkStatus();
    return wrong("compound", name, fmt::format("the zoom [ {} {} ]", zoom.x, zoom.y),
                 fmt::format("numbers above 0, up to {}", kMostZoom));
}

bool isPart(std::int64_t index, std::int64_t count) {
    return index >= 0 && index < count && count <= kMostShares;
}

absl::Status check(const config::Compound& compound) {
    const std::string& name = compound.name;
    RETURN_IF_ERROR(check("compound", name, compound.viewport, 0));
    RETURN_IF_ERROR(checkZoom(name, compound.zoom));
    if (!(compound.range.begin >= 0 && compound.range.begin <= compound.range.end &&
          compound.range.end <= 1))
        return wrong("compound", name,
                     fmt::format("the range [ {} {} ]", compound.range.begin, compound.range.end),
                     "0 <= begin <= end <= 1");
    if (!isPart(compound.pixel.x, compound.pixel.width) ||
        !isPart(compound.pixel.y, compound.pixel.height) ||
        !isPart(compound.subpixel.index, compound.subpixel.count))
        return wrong("compound", name, "a pixel or subpixel share that is none",
                     "an index below the count");
    if (compound.period.value_or(1) < 1 || compound.phase.value_or(0) < 0)
        return wrong("compound", name, "a period below 1 or a phase below 0",
                     "0 <= phase < period");
    for (const auto* const frames : {&compound.outputFrames, &compound.inputFrames})
        for (const config::Frame& frame : *frames) {
            RETURN_IF_ERROR(check("frame", frame.name, frame.viewport, 0));
            RETURN_IF_ERROR(checkZoom(name, frame.zoom.value_or(fabric::Vec2(1, 1))));
        }
    for (const config::Compound& child : compound.children) RETURN_IF_ERROR(check(child));
    return absl::OkStatus();
}

}  // namespace

absl::Status checkShares(const config::Configuration& configuration) {
    constexpr double kLeast = 1e-6;  // of a canvas; it is divided by
    for (const config::Layout& layout : configuration.layouts)
        for (const config::View& view : layout.views)
            RETURN_IF_ERROR(check("view", view.name, view.viewport, kLeast));
    for (const config::Canvas& canvas : configuration.canvases)
        for (const config::Segment& segment : canvas.segments)
            RETURN_IF_ERROR(check("segment", segment.name, segment.viewport, kLeast));
    for (const config::Compound& compound : configuration.compounds)
        RETURN_IF_ERROR(check(compound));
    return absl::OkStatus();
}

}  // namespace eyrie::compound
