// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/same_names.h"

#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

namespace eyrie::config {
namespace {

/// Names of one kind of thing.
class Names {
public:
    Names(std::string_view kind, Findings& findings) : kind_(kind), findings_(findings) {}

    template <typename T>
    void add(const T& thing) {
        if (thing.name.empty())
            return;
        const auto [first, isNew] = first_.try_emplace(thing.name, &thing.place);
        if (isNew)
            return;
        const std::string place = describe(*first->second);
        findings_.warning(thing.place,
                          fmt::format("another {} is named \"{}\" already{}{}; the name finds that",
                                      kind_, thing.name, place.empty() ? "" : ", at ", place));
    }
    template <typename T>
    void addAll(const std::vector<T>& things) {
        for (const T& thing : things) add(thing);
    }

private:
    std::string_view kind_;
    Findings& findings_;
    std::unordered_map<std::string_view, const Place*> first_;
};

}  // namespace

void warnOfSameNames(const Configuration& configuration, Findings& findings) {
    Names nodes("node", findings);
    Names pipes("pipe", findings);
    Names windows("window", findings);
    Names channels("channel", findings);
    nodes.addAll(configuration.nodes);
    for (const Node& node : configuration.nodes) {
        pipes.addAll(node.pipes);
        for (const Pipe& pipe : node.pipes) {
            windows.addAll(pipe.windows);
            for (const Window& window : pipe.windows) channels.addAll(window.channels);
        }
    }
    Names("observer", findings).addAll(configuration.observers);
    Names("layout", findings).addAll(configuration.layouts);
    for (const Layout& layout : configuration.layouts) Names("view", findings).addAll(layout.views);
    Names("canvas", findings).addAll(configuration.canvases);
    for (const Canvas& canvas : configuration.canvases)
        Names("segment", findings).addAll(canvas.segments);
}

}  // namespace eyrie::config
