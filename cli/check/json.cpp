// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "cli/check/report.h"
#include "cli/check/words.h"
#include "cli/json_object.h"

namespace eyrie::cli::check {
namespace {

using config::Configuration;
using Rectangle = std::array<double, 4>;

Rectangle rectangle(const config::Viewport& viewport) {
    return {viewport.x, viewport.y, viewport.width, viewport.height};
}

Rectangle rectangle(const fabric::PixelViewport& pixels) {
    return {static_cast<double>(pixels.x), static_cast<double>(pixels.y),
            static_cast<double>(pixels.width), static_cast<double>(pixels.height)};
}

std::array<double, 3> triple(const fabric::Vec3& v) { return {v.x, v.y, v.z}; }

JsonObject countsJson(const Checked& checked) {
    const Counts counts = countsOf(checked.configuration, checked.resolved);
    return JsonObject()
        .count("nodes", counts.nodes)
        .count("pipes", counts.pipes)
        .count("windows", counts.windows)
        .count("channels", counts.channels)
        .count("observers", counts.observers)
        .count("layouts", counts.layouts)
        .count("views", counts.views)
        .count("canvases", counts.canvases)
        .count("segments", counts.segments)
        .count("destinationChannels", counts.destinations)
        .count("compoundRoots", counts.roots)
        .count("compounds", counts.compounds)
        .count("implicitCompounds", counts.implicit);
}

JsonObject windowJson(const config::Window& window) {
    JsonObject json;
    json.text("name", window.name);
    if (window.viewport)
        json.numbers("viewport", rectangle(*window.viewport));
    std::vector<JsonObject> channels;
    for (const config::Channel& channel : window.channels) {
        channels.push_back(JsonObject().text("name", channel.name));
        if (channel.viewport)
            channels.back().numbers("viewport", rectangle(*channel.viewport));
    }
    return json.objects("channels", channels);
}

JsonObject nodeJson(const config::Node& node) {
    std::vector<JsonObject> pipes;
    for (const config::Pipe& pipe : node.pipes) {
        JsonObject json;
        json.text("name", pipe.name);
        if (pipe.device)
            json.count("device", static_cast<std::uint64_t>(*pipe.device));
        std::vector<JsonObject> windows;
        for (const config::Window& window : pipe.windows) windows.push_back(windowJson(window));
        pipes.push_back(json.objects("windows", windows));
    }
    return JsonObject()
        .text("name", node.name)
        .flag("isApplication", node.isApplication)
        .texts("hosts", hostsOf(node))
        .objects("pipes", pipes);
}

JsonObject layoutJson(const config::Layout& layout) {
    std::vector<JsonObject> views;
    for (const config::View& view : layout.views) {
        views.push_back(JsonObject()
                            .text("name", view.name)
                            .flag("isStereo", view.isStereo)
                            .numbers("viewport", rectangle(view.viewport)));
        if (view.observer)
            views.back().count("observer", *view.observer);
    }
    return JsonObject().text("name", layout.name).objects("views", views);
}

JsonObject canvasJson(const Configuration& configuration, const config::Canvas& canvas) {
    std::vector<std::string> layouts;
    for (const auto& layout : canvas.layouts)
        layouts.push_back(layout ? called(configuration.layouts[*layout].name, *layout) : "OFF");
    std::vector<JsonObject> segments;
    for (const config::Segment& segment : canvas.segments) {
        segments.push_back(JsonObject()
                               .text("name", segment.name)
                               .numbers("viewport", rectangle(segment.viewport))
                               .texts("eyes", words(segment.eyes)));
        if (segment.channel)
            segments.back().text("channel", pathOf(configuration, *segment.channel));
    }
    return JsonObject()
        .text("name", canvas.name)
        .texts("layouts", layouts)
        .objects("segments", segments);
}

JsonObject wallJson(const config::Wall& wall) {
    return JsonObject()
        .numbers("bottomLeft", triple(wall.bottomLeft))
        .numbers("bottomRight", triple(wall.bottomRight))
        .numbers("topLeft", triple(wall.topLeft))
        .flag("movesWithHead", wall.movesWithHead);
}

JsonObject destinationJson(const Configuration& configuration,
                           const config::Destination& destination) {
    JsonObject json;
    json.text("name", destination.name)
        .count("canvas", destination.index.canvas)
        .count("segment", destination.index.segment)
        .count("layout", destination.index.layout)
        .count("view", destination.index.view)
        .text("channel", pathOf(configuration, destination.channel))
        .numbers("viewport", rectangle(destination.viewport))
        .numbers("pixelViewport", rectangle(destination.pixelViewport))
        .texts("eyes", words(destination.eyes));
    if (destination.wall)
        json.object("wall", wallJson(*destination.wall));
    return json;
}

std::vector<JsonObject> framesJson(const std::vector<config::ResolvedFrame>& frames) {
    std::vector<JsonObject> json;
    for (const config::ResolvedFrame& frame : frames) {
        json.push_back(JsonObject()
                           .text("name", frame.name)
                           .flag("isMatched", frame.isMatched)
                           .numbers("viewport", rectangle(frame.frame->viewport)));
        if (const auto& zoom = frame.frame->zoom)
            json.back().numbers("zoom", std::array{zoom->x, zoom->y});
    }
    return json;
}

std::vector<JsonObject> frustaJson(const std::vector<config::EyeSight>& sights) {
    std::vector<JsonObject> json;
    for (const config::EyeSight& sight : sights) {
        if (!sight.sight)
            continue;
        const fabric::Frustum& frustum = sight.sight->frustum;
        const fabric::Mat4 viewFromCamera = fabric::viewFromCamera(*sight.sight);
        std::array<double, 16> matrix{};
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                matrix[static_cast<std::size_t>(4 * row + column)] = viewFromCamera[column][row];
        json.push_back(JsonObject()
                           .text("eye", word(sight.eye))
                           .number("left", frustum.left)
                           .number("right", frustum.right)
                           .number("bottom", frustum.bottom)
                           .number("top", frustum.top)
                           .numbers("viewFromCamera", matrix));
    }
    return json;
}

JsonObject compoundJson(const Configuration& configuration,
                        const config::ResolvedCompound& compound) {
    JsonObject json;
    json.count("depth", static_cast<std::uint64_t>(compound.depth))
        .flag("isImplicit", compound.compound == nullptr)
        .text("name", compound.compound == nullptr ? "" : compound.compound->name);
    if (compound.destination)
        json.count("destination", *compound.destination);
    if (compound.channel)
        json.text("channel", pathOf(configuration, *compound.channel));
    json.texts("tasks", words(compound.tasks))
        .texts("eyes", words(compound.eyes))
        .texts("buffers", words(compound.buffers))
        .numbers("viewport", rectangle(compound.viewport))
        .numbers("pixelViewport", rectangle(compound.pixelViewport))
        .numbers("range", std::array{compound.range.begin, compound.range.end})
        .numbers("pixel", std::array{static_cast<double>(compound.pixel.x),
                                     static_cast<double>(compound.pixel.y),
                                     static_cast<double>(compound.pixel.width),
                                     static_cast<double>(compound.pixel.height)})
        .numbers("subpixel", std::array{static_cast<double>(compound.subpixel.index),
                                        static_cast<double>(compound.subpixel.count)})
        .numbers("zoom", std::array{compound.zoom.x, compound.zoom.y})
        .count("period", static_cast<std::uint64_t>(compound.period))
        .count("phase", static_cast<std::uint64_t>(compound.phase))
        .objects("outputFrames", framesJson(compound.outputFrames))
        .objects("inputFrames", framesJson(compound.inputFrames));
    std::vector<std::string> equalizers;
    if (compound.compound != nullptr)
        for (const config::Equalizer& equalizer : compound.compound->equalizers)
            equalizers.emplace_back(word(equalizer.kind));
    return json.texts("equalizers", equalizers).objects("frusta", frustaJson(compound.sights));
}

std::vector<JsonObject> findingsJson(const config::Findings& findings) {
    using Kind = config::Finding::Kind;
    std::vector<JsonObject> json;
    const auto word = [](Kind kind) {
        switch (kind) {
            case Kind::Error:
                return "error";
            case Kind::Warning:
                return "warning";
            case Kind::OnScreen:
                return "onScreenOnly";
            case Kind::Note:
                break;
        }
        return "note";
    };
    for (const config::Finding& finding : findings.all())
        json.push_back(JsonObject()
                           .text("kind", word(finding.kind))
                           .count("line", finding.place.line)
                           .count("column", finding.place.column)
                           .text("field", finding.place.field)
                           .text("message", finding.message));
    return json;
}

template <typename Things, typename ToJson>
std::vector<JsonObject> each(const Things& things, const ToJson& toJson) {
    std::vector<JsonObject> json;
    for (const auto& thing : things) json.push_back(toJson(thing));
    return json;
}

}  // namespace

std::string json(const Checked& checked) {
    const Configuration& configuration = checked.configuration;
    JsonObject object;
    object.text("file", checked.file)
        .text("version", configuration.version)
        .flag("isUsable", !checked.findings.hasErrors())
        .count("latency", static_cast<std::uint64_t>(configuration.latency))
        .object("counts", countsJson(checked))
        .objects("nodes", each(configuration.nodes, nodeJson))
        .objects("layouts", each(configuration.layouts, layoutJson))
        .objects("canvases", each(configuration.canvases,
                                  [&](const config::Canvas& canvas) {
                                      return canvasJson(configuration, canvas);
                                  }))
        .objects("destinationChannels", each(checked.resolved.destinations,
                                             [&](const config::Destination& destination) {
                                                 return destinationJson(configuration, destination);
                                             }))
        .objects("compounds", each(checked.resolved.compounds,
                                   [&](const config::ResolvedCompound& compound) {
                                       return compoundJson(configuration, compound);
                                   }))
        .objects("findings", findingsJson(checked.findings));
    if (checked.started)
        object.object("started", jsonOf(*checked.started));
    return object.str();
}

}  // namespace eyrie::cli::check
