// SPDX-License-Identifier: Apache-2.0
#include "cli/check/words.h"

#include <algorithm>

#include <fmt/format.h>

namespace eyrie::cli::check {
namespace {

using Flag = std::pair<bool, const char*>;

std::vector<std::string> those(std::initializer_list<Flag> flags) {
    std::vector<std::string> set;
    for (const auto& [isSet, name] : flags)
        if (isSet)
            set.emplace_back(name);
    return set;
}

}  // namespace

std::vector<std::string> words(const config::Tasks& tasks) {
    return those({{tasks.clear, "CLEAR"},
                  {tasks.draw, "DRAW"},
                  {tasks.assemble, "ASSEMBLE"},
                  {tasks.readback, "READBACK"}});
}

std::vector<std::string> words(const config::Eyes& eyes) {
    return those({{eyes.cyclop, "CYCLOP"}, {eyes.left, "LEFT"}, {eyes.right, "RIGHT"}});
}

std::vector<std::string> words(const config::Buffers& buffers) {
    return those({{buffers.colour, "COLOR"}, {buffers.depth, "DEPTH"}});
}

std::string_view word(config::EqualizerKind kind) {
    using Kind = config::EqualizerKind;
    switch (kind) {
        case Kind::Load:
            return "load_equalizer";
        case Kind::Tree:
            return "tree_equalizer";
        case Kind::Dfr:
            return "DFR_equalizer";
        case Kind::Tile:
            return "tile_equalizer";
        case Kind::View:
            return "view_equalizer";
        case Kind::Monitor:
            return "monitor_equalizer";
        case Kind::Framerate:
            break;
    }
    return "framerate_equalizer";
}

std::string_view word(config::SplitMode mode) {
    using Mode = config::SplitMode;
    switch (mode) {
        case Mode::TwoD:
            return "2D";
        case Mode::Db:
            return "DB";
        case Mode::Horizontal:
            return "HORIZONTAL";
        case Mode::Vertical:
            break;
    }
    return "VERTICAL";
}

std::string_view word(config::EyeSight::Eye eye) {
    using Eye = config::EyeSight::Eye;
    return eye == Eye::Cyclop ? "CYCLOP" : eye == Eye::Left ? "LEFT" : "RIGHT";
}

std::string called(const std::string& name, std::size_t position) {
    return name.empty() ? fmt::format("{}", position) : fmt::format("\"{}\"", name);
}

std::vector<std::string> hostsOf(const config::Node& node) {
    std::vector<std::string> hosts;
    const auto add = [&hosts](const std::string& host) {
        if (!host.empty() && std::ranges::find(hosts, host) == hosts.end())
            hosts.push_back(host);
    };
    add(node.host);
    for (const config::Connection& connection : node.connections) add(connection.hostname);
    return hosts;
}

const config::Channel& channelOf(const config::Configuration& configuration,
                                 const config::ChannelIndex& index) {
    return configuration.nodes[index.node]
        .pipes[index.pipe]
        .windows[index.window]
        .channels[index.channel];
}

std::string pathOf(const config::Configuration& configuration, const config::ChannelIndex& index) {
    const auto named = [](const std::string& name, std::size_t position) {
        return name.empty() ? fmt::format("{}", position) : name;
    };
    const config::Node& node = configuration.nodes[index.node];
    const config::Pipe& pipe = node.pipes[index.pipe];
    const config::Window& window = pipe.windows[index.window];
    return fmt::format("{}/{}/{}/{}", named(node.name, index.node), named(pipe.name, index.pipe),
                       named(window.name, index.window),
                       named(window.channels[index.channel].name, index.channel));
}

Counts countsOf(const config::Configuration& configuration,
                const config::ResolvedConfiguration& resolved) {
    Counts counts;
    counts.nodes = configuration.nodes.size();
    for (const config::Node& node : configuration.nodes) {
        counts.pipes += node.pipes.size();
        for (const config::Pipe& pipe : node.pipes) {
            counts.windows += pipe.windows.size();
            for (const config::Window& window : pipe.windows)
                counts.channels += window.channels.size();
        }
    }
    counts.observers = configuration.observers.size();
    counts.layouts = configuration.layouts.size();
    for (const config::Layout& layout : configuration.layouts) counts.views += layout.views.size();
    counts.canvases = configuration.canvases.size();
    for (const config::Canvas& canvas : configuration.canvases)
        counts.segments += canvas.segments.size();
    counts.destinations = resolved.destinations.size();
    counts.roots = configuration.compounds.size();
    for (const config::ResolvedCompound& compound : resolved.compounds)
        ++(compound.compound == nullptr ? counts.implicit : counts.compounds);
    return counts;
}

}  // namespace eyrie::cli::check
