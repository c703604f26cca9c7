// SPDX-License-Identifier: Apache-2.0
#include "cli/check/started.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/check/words.h"
#include "coordinator/frame/active_configuration.h"

namespace eyrie::cli::check {
namespace {

using Pipe = coordinator::ActiveConfiguration::Pipe;

std::string nameOf(const config::Configuration& configuration, const Pipe& pipe) {
    const config::Node& node = configuration.nodes[pipe.node];
    return fmt::format("{}/{}", called(node.name, pipe.node),
                       called(node.pipes[pipe.pipe].name, pipe.pipe));
}

std::vector<std::string> pipesOf(const Started& started, std::size_t renderer) {
    std::vector<std::string> names;
    for (const Started::Pipe& pipe : started.pipes)
        if (pipe.renderer == renderer)
            names.push_back(pipe.name);
    return names;
}

std::string joined(const std::vector<std::string>& names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

Started startedWith(const config::Configuration& configuration, std::size_t renderers) {
    const coordinator::ActiveConfiguration active(configuration);
    Started started{renderers, {}, {}};
    for (std::size_t i = 0; i < active.pipes().size(); ++i)
        started.pipes.push_back({nameOf(configuration, active.pipes()[i]), i % renderers});
    for (std::size_t node = 0; node < configuration.nodes.size(); ++node)
        for (std::size_t i = 0; i < configuration.nodes[node].pipes.size(); ++i) {
            const Pipe pipe{node, i};
            if (std::ranges::find(active.pipes(), pipe) == active.pipes().end())
                started.notNeeded.push_back(nameOf(configuration, pipe));
        }
    return started;
}

std::string text(const Started& started) {
    std::string text = fmt::format("\nStarted with {} renderer{}, by what is shown at first\n",
                                   started.renderers, started.renderers == 1 ? "" : "s");
    for (std::size_t i = 0; i < std::min(started.renderers, started.pipes.size()); ++i)
        text += fmt::format("  renderer {}: pipe {}\n", i + 1, joined(pipesOf(started, i)));
    if (started.missing() > 0)
        text += fmt::format("  missing: {} of {} renderers; all is drawn, by fewer, and so later\n",
                            started.missing(), started.pipes.size());
    if (started.renderers > started.pipes.size())
        text +=
            fmt::format("  without work: {} renderer{}\n", started.renderers - started.pipes.size(),
                        started.renderers - started.pipes.size() == 1 ? "" : "s");
    if (!started.notNeeded.empty())
        text += fmt::format("  not started: pipe {}\n", joined(started.notNeeded));
    return text;
}

JsonObject jsonOf(const Started& started) {
    std::vector<JsonObject> used;
    for (std::size_t i = 0; i < std::min(started.renderers, started.pipes.size()); ++i)
        used.push_back(JsonObject().count("renderer", i + 1).texts("pipes", pipesOf(started, i)));
    return JsonObject()
        .count("renderers", started.renderers)
        .objects("used", used)
        .count("missing", started.missing())
        .texts("notStarted", started.notNeeded);
}

}  // namespace eyrie::cli::check
