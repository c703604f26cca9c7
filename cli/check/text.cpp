// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include "cli/check/report.h"
#include "cli/check/words.h"

namespace eyrie::cli::check {
namespace {

using config::Configuration;

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& each : words) text += (text.empty() ? "" : " ") + each;
    return text.empty() ? "none" : text;
}

std::string counted(std::size_t count, std::string_view one, std::string_view more = "") {
    if (count == 1)
        return fmt::format("1 {}", one);
    return more.empty() ? fmt::format("{} {}s", count, one) : fmt::format("{} {}", count, more);
}

std::string summary(const Checked& checked) {
    const Counts counts = countsOf(checked.configuration, checked.resolved);
    return fmt::format(
        "{}, {}, {}, {}\n{}, {}, {}, {}, {}\n{}\n{} in {}, {}\n", counted(counts.nodes, "node"),
        counted(counts.pipes, "pipe"), counted(counts.windows, "window"),
        counted(counts.channels, "channel"), counted(counts.observers, "observer"),
        counted(counts.layouts, "layout"), counted(counts.views, "view"),
        counted(counts.canvases, "canvas", "canvases"), counted(counts.segments, "segment"),
        counted(counts.destinations, "destination channel"), counted(counts.compounds, "compound"),
        counted(counts.roots, "tree"), counted(counts.implicit, "implicit one"));
}

std::string resources(const Configuration& configuration) {
    std::string text = "\nResources\n";
    for (std::size_t i = 0; i < configuration.nodes.size(); ++i) {
        const config::Node& node = configuration.nodes[i];
        text +=
            fmt::format("  {} {}", node.isApplication ? "appNode" : "node", called(node.name, i));
        for (const std::string& host : hostsOf(node)) text += ", " + host;
        text += "\n";
        for (std::size_t j = 0; j < node.pipes.size(); ++j) {
            const config::Pipe& pipe = node.pipes[j];
            text += fmt::format("    pipe {}", called(pipe.name, j));
            text += pipe.device ? fmt::format(", device {}\n", *pipe.device) : "\n";
            for (std::size_t k = 0; k < pipe.windows.size(); ++k) {
                text += fmt::format("      window {}\n", called(pipe.windows[k].name, k));
                const std::vector<config::Channel>& channels = pipe.windows[k].channels;
                for (std::size_t l = 0; l < channels.size(); ++l)
                    text += fmt::format("        channel {}\n", called(channels[l].name, l));
            }
        }
    }
    return text;
}

std::string canvases(const Configuration& configuration) {
    std::string text = "\nCanvases\n";
    for (std::size_t i = 0; i < configuration.canvases.size(); ++i) {
        const config::Canvas& canvas = configuration.canvases[i];
        std::vector<std::string> layouts;
        for (const std::optional<std::size_t>& layout : canvas.layouts)
            layouts.push_back(layout ? called(configuration.layouts[*layout].name, *layout)
                                     : "OFF");
        text += fmt::format("  {}: layouts {}\n", called(canvas.name, i), joined(layouts));
        for (std::size_t j = 0; j < canvas.segments.size(); ++j) {
            const config::Segment& segment = canvas.segments[j];
            const config::Viewport& at = segment.viewport;
            text += fmt::format(
                "    segment {}: {}, viewport [ {:.4g} {:.4g} {:.4g} {:.4g} ], eyes {}\n",
                called(segment.name, j),
                segment.channel ? pathOf(configuration, *segment.channel) : "no channel", at.x,
                at.y, at.width, at.height, joined(words(segment.eyes)));
        }
    }
    return text;
}

std::string display(const Checked& checked) {
    const Configuration& configuration = checked.configuration;
    std::string text = canvases(configuration) + "\nDestination channels\n";
    for (const config::Destination& each : checked.resolved.destinations) {
        const config::Canvas& canvas = configuration.canvases[each.index.canvas];
        const config::Layout& layout = configuration.layouts[each.index.layout];
        text += fmt::format(
            "  {} x {} pixels of {}: canvas {}, segment {}, layout {}, view {}, eyes {}\n",
            each.pixelViewport.width, each.pixelViewport.height,
            pathOf(configuration, each.channel), called(canvas.name, each.index.canvas),
            called(canvas.segments[each.index.segment].name, each.index.segment),
            called(layout.name, each.index.layout),
            called(layout.views[each.index.view].name, each.index.view), joined(words(each.eyes)));
    }
    return text;
}

/// Nothing where rounding left almost nothing.
double shown(double edge) { return std::abs(edge) < 1e-12 ? 0 : edge; }

/// What a compound does otherwise than all of the picture.
std::string shareOf(const config::ResolvedCompound& compound) {
    std::string text =
        fmt::format("{} x {}", compound.pixelViewport.width, compound.pixelViewport.height);
    if (!(compound.viewport == config::Viewport{}))
        text += fmt::format(", viewport [ {:.4g} {:.4g} {:.4g} {:.4g} ]", compound.viewport.x,
                            compound.viewport.y, compound.viewport.width, compound.viewport.height);
    if (!compound.range.isWhole())
        text += fmt::format(", range [ {:.4g} {:.4g} ]", compound.range.begin, compound.range.end);
    if (!(compound.pixel == config::PixelShare{}))
        text += fmt::format(", pixel [ {} {} {} {} ]", compound.pixel.x, compound.pixel.y,
                            compound.pixel.width, compound.pixel.height);
    if (!(compound.subpixel == config::SubPixelShare{}))
        text +=
            fmt::format(", subpixel [ {} {} ]", compound.subpixel.index, compound.subpixel.count);
    if (compound.zoom != fabric::Vec2(1, 1))
        text += fmt::format(", zoom [ {:.4g} {:.4g} ]", compound.zoom.x, compound.zoom.y);
    if (compound.period > 1)
        text += fmt::format(", frames {} of {}", compound.phase, compound.period);
    return text + fmt::format(", eyes {}", joined(words(compound.eyes)));
}

std::string framesOf(const char* arrow, const std::vector<config::ResolvedFrame>& frames) {
    std::string text;
    for (const config::ResolvedFrame& frame : frames)
        text += fmt::format(" {} {}{}", arrow, frame.name, frame.isMatched ? "" : " (unmatched)");
    return text;
}

std::string said(const config::Equalizer& equalizer) {
    using Kind = config::EqualizerKind;
    const std::string kind(word(equalizer.kind));
    if (equalizer.kind == Kind::Load || equalizer.kind == Kind::Tree)
        return fmt::format("{} {}", kind, word(equalizer.mode));
    return equalizer.kind == Kind::Dfr
               ? fmt::format("{} at {:.4g} frames/s", kind, equalizer.framerate)
               : kind;
}

std::string compounds(const Checked& checked) {
    std::string text = "\nCompounds\n";
    for (const config::ResolvedCompound& compound : checked.resolved.compounds) {
        const std::string indent(2 * static_cast<std::size_t>(compound.depth) + 2, ' ');
        text += indent;
        if (compound.compound == nullptr)
            text += "implicit, ";
        text += compound.channel ? pathOf(checked.configuration, *compound.channel) : "group";
        if (compound.channel)
            text += fmt::format(": {}; {}", joined(words(compound.tasks)), shareOf(compound));
        text += framesOf("<-", compound.inputFrames) + framesOf("->", compound.outputFrames);
        if (compound.compound != nullptr)
            for (const config::Equalizer& equalizer : compound.compound->equalizers)
                text += ", " + said(equalizer);
        text += "\n";
        for (const config::EyeSight& sight : compound.sights)
            if (sight.sight) {
                const fabric::Frustum& frustum = sight.sight->frustum;
                text += fmt::format(
                    "{}  {} eye: left {:.4g}, right {:.4g}, bottom {:.4g}, top "
                    "{:.4g} at distance 1\n",
                    indent, word(sight.eye), shown(frustum.left), shown(frustum.right),
                    shown(frustum.bottom), shown(frustum.top));
            }
    }
    return text;
}

}  // namespace

std::string text(const Checked& checked) {
    return summary(checked) + resources(checked.configuration) + display(checked) +
           compounds(checked) + (checked.started ? text(*checked.started) : "");
}

}  // namespace eyrie::cli::check
