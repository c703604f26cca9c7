// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/default_config.h"

#include <algorithm>
#include <unordered_set>

#include <fmt/format.h>

#include "coordinator/config/default_layouts.h"

namespace eyrie::config {
namespace {

constexpr int kMostThreads = 1024;  // that any share is more than what it is rounded to

/// What a .eqc file can hold of it.
std::string writable(std::string_view text) {
    std::string result(text);
    for (char& each : result)
        if (each < ' ' || each > '~' || each == '"')
            each = '_';
    return result;
}

Node nodeOf(const RendererFacts& renderer, std::size_t index, std::string name) {
    Channel channel;
    channel.name = channelName(index);
    Window window;
    window.name = fmt::format("window{}", index + 1);
    window.channels.push_back(channel);
    Pipe pipe;
    pipe.name = fmt::format("pipe{}", index + 1);
    if (!renderer.device.empty())
        pipe.name += fmt::format(" ({})", writable(renderer.device));
    pipe.windows.push_back(window);
    Node node;
    node.name = std::move(name);
    node.isApplication = index == 0;
    node.host = writable(renderer.host);
    node.pipes.push_back(pipe);
    return node;
}

void addNodes(std::span<const RendererFacts> renderers, Configuration& configuration) {
    std::unordered_set<std::string> taken;
    for (std::size_t i = 0; i < renderers.size(); ++i) {
        std::string name = writable(renderers[i].id);
        if (name.empty() || !taken.insert(name).second) {
            name = fmt::format("{} ({})", name, i + 1);
            while (!taken.insert(name).second) name += '\'';
        }
        configuration.nodes.push_back(nodeOf(renderers[i], i, std::move(name)));
    }
}

std::vector<double> weightsOf(std::span<const RendererFacts> renderers) {
    const bool areThreads = std::ranges::all_of(
        renderers, [](const RendererFacts& renderer) { return renderer.threads > 0; });
    std::vector<double> weights;
    for (const RendererFacts& renderer : renderers)
        weights.push_back(areThreads ? std::min(renderer.threads, kMostThreads) : 1);
    return weights;
}

}  // namespace

Configuration defaultConfiguration(std::span<const RendererFacts> renderers) {
    Configuration configuration;
    if (renderers.empty())
        return configuration;
    addNodes(renderers, configuration);
    configuration.observers.emplace_back();
    Segment segment;
    segment.channel = ChannelIndex{};
    configuration.canvases.emplace_back().segments.push_back(segment);
    const auto add = [&](std::string name, Compound root) {
        root.channel = DestinationIndex{0, 0, configuration.layouts.size(), 0};
        root.name = name;  // its equalizer is called by it, whatever the number of renderers
        configuration.canvases[0].layouts.push_back(configuration.layouts.size());
        View view;
        view.observer = 0;
        configuration.layouts.push_back({std::move(name), {view}, {}});
        configuration.compounds.push_back(std::move(root));
    };
    const std::vector<double> weights = weightsOf(renderers);
    const std::size_t count = weights.size();
    if (count > 1)
        add("2D", balanced(parts(weights), SplitMode::TwoD));
    add("Simple", {});
    if (count > 1) {
        add("DB static", ranges(weights));
        add("DB dynamic", balanced(ranges(weights), SplitMode::Db));
    }
    if (count > 1 && count <= kMostDirectSend)
        add("direct-send", directSend(weights));
    if (count >= 4)
        add("DB-2D", rangesOfParts(weights));
    return configuration;
}

std::vector<std::string> layoutNames(const Configuration& configuration) {
    std::vector<std::string> names;
    for (const Layout& layout : configuration.layouts) names.push_back(layout.name);
    return names;
}

}  // namespace eyrie::config
