// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/shares.h"

#include <string_view>

#include <fmt/format.h>

#include "coordinator/config/equalizer_limits.h"

namespace eyrie::compound {
namespace {

constexpr double kSlack = 1e-3;  // thirds are written as .3333 and .6667
constexpr std::int64_t kMostShares = 16384;

bool isShare(double begin, double size) {
    return begin >= -kSlack && size >= 0 && begin + size <= 1 + kSlack;
}

bool isZoom(const fabric::Vec2& zoom) {
    return zoom.x > 0 && zoom.y > 0 && zoom.x <= config::kMostZoom && zoom.y <= config::kMostZoom;
}

bool isPart(std::int64_t index, std::int64_t count) {
    return index >= 0 && index < count && count <= kMostShares;
}

class Checker {
public:
    explicit Checker(config::Findings& findings) : findings_(findings) {}

    template <typename T>
    void viewport(std::string_view what, const T& of, double least) {
        const config::Viewport& viewport = of.viewport;
        if (isShare(viewport.x, viewport.width) && isShare(viewport.y, viewport.height) &&
            viewport.width >= least && viewport.height >= least)
            return;
        wrong(what, of,
              fmt::format("the viewport [ {} {} {} {} ]", viewport.x, viewport.y, viewport.width,
                          viewport.height),
              "a part of [ 0 0 1 1 ]");
    }

    void compound(const config::Compound& own) {
        viewport("compound", own, 0);
        zoom("compound", own, own.zoom);
        if (!(own.range.begin >= 0 && own.range.begin <= own.range.end && own.range.end <= 1))
            wrong("compound", own,
                  fmt::format("the range [ {} {} ]", own.range.begin, own.range.end),
                  "0 <= begin <= end <= 1");
        if (!isPart(own.pixel.x, own.pixel.width) || !isPart(own.pixel.y, own.pixel.height) ||
            !isPart(own.subpixel.index, own.subpixel.count))
            wrong("compound", own, "a pixel or subpixel share that is none",
                  fmt::format("an index below the count, and {} shares at most", kMostShares));
        if (own.period.value_or(1) < 1 || own.phase.value_or(0) < 0)
            wrong("compound", own, "a period below 1 or a phase below 0", "0 <= phase < period");
        for (const auto* const frames : {&own.outputFrames, &own.inputFrames})
            for (const config::Frame& frame : *frames) {
                viewport("frame", frame, 0);
                zoom("frame", frame, frame.zoom.value_or(fabric::Vec2(1, 1)));
            }
        for (const config::Compound& child : own.children) compound(child);
    }

private:
    template <typename T>
    void zoom(std::string_view what, const T& of, const fabric::Vec2& zoom) {
        if (!isZoom(zoom))
            wrong(what, of, fmt::format("the zoom [ {} {} ]", zoom.x, zoom.y),
                  fmt::format("numbers above 0, up to {}", config::kMostZoom));
    }

    template <typename T>
    void wrong(std::string_view what, const T& of, std::string_view found,
               std::string_view expected) {
        findings_.error(
            of.place, fmt::format("{} \"{}\" has {}; expected {}", what, of.name, found, expected));
    }

    config::Findings& findings_;
};

}  // namespace

void checkShares(const config::Configuration& configuration, config::Findings& findings) {
    constexpr double kLeast = 1e-6;  // of a canvas; it is divided by
    Checker checker(findings);
    for (const config::Layout& layout : configuration.layouts)
        for (const config::View& view : layout.views) checker.viewport("view", view, kLeast);
    for (const config::Canvas& canvas : configuration.canvases)
        for (const config::Segment& segment : canvas.segments)
            checker.viewport("segment", segment, kLeast);
    for (const config::Compound& compound : configuration.compounds) checker.compound(compound);
}

}  // namespace eyrie::compound
