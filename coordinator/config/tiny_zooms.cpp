// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/tiny_zooms.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "coordinator/config/pixels.h"

namespace eyrie::config {
namespace {

struct Pixels {
    double width = 0;
    double height = 0;
};

/// As it is drawn: whole pixels, one at least.
double zoomed(double pixels, double by) { return std::max(1.0, std::floor(pixels * by + .5)); }

Pixels zoomed(const Pixels& of, const fabric::Vec2& by) {
    return {zoomed(of.width, by.x), zoomed(of.height, by.y)};
}

void check(const Pixels& before, const fabric::Vec2& zoom, const Place& place, Findings& findings) {
    constexpr double kMany = 16;
    const Pixels after = zoomed(before, zoom);
    if ((after.width > 1 || before.width < kMany) && (after.height > 1 || before.height < kMany))
        return;
    findings.warning(
        place, fmt::format("the zoom leaves {}x{} of {}x{} pixels; it says how many there are for "
                           "each one, as [ .5 .5 ] for half of them across and along",
                           after.width, after.height, before.width, before.height));
}

/// Those of an output frame before its own zoom.
Pixels pixelsOf(const ResolvedCompound& compound, const Frame& output) {
    const fabric::PixelViewport part = config::part(compound.pixelViewport, output.viewport);
    return {static_cast<double>(part.width), static_cast<double>(part.height)};
}

/// Those of the first frame of a name, as it is read back.
std::optional<Pixels> pixelsOf(std::span<const ResolvedCompound> tree, const std::string& name) {
    for (const ResolvedCompound& each : tree)
        for (const ResolvedFrame& output : each.outputFrames)
            if (output.name == name)
                return zoomed(pixelsOf(each, *output.frame),
                              output.frame->zoom.value_or(fabric::Vec2(1, 1)));
    return std::nullopt;
}

}  // namespace

void warnOfTinyZooms(std::span<const ResolvedCompound> tree, Findings& findings) {
    for (const ResolvedCompound& each : tree) {
        if (!each.destination || each.compound == nullptr)
            continue;
        if (each.compound->zoom != fabric::Vec2(1, 1) && !each.pixelViewport.isEmpty()) {
            const fabric::PixelViewport& before = each.regriddings.back().of;
            check({static_cast<double>(before.width), static_cast<double>(before.height)},
                  each.compound->zoom, each.place(), findings);
        }
        for (const ResolvedFrame& output : each.outputFrames)
            if (output.frame->zoom)
                check(pixelsOf(each, *output.frame), *output.frame->zoom, output.frame->place,
                      findings);
        for (const ResolvedFrame& input : each.inputFrames)
            if (const auto before = input.frame->zoom ? pixelsOf(tree, input.name) : std::nullopt)
                check(*before, *input.frame->zoom, input.frame->place, findings);
    }
}

}  // namespace eyrie::config
