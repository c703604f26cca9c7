// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "coordinator/config/section_readers.h"

namespace eyrie::config {
namespace {

std::optional<ChannelIndex> channelNamed(const Statement& statement, const Configuration& before,
                                         ValueReader& reader) {
    std::string name;
    const std::size_t errors = reader.findings().errors();
    reader.text(statement, name);
    if (reader.findings().errors() > errors)
        return std::nullopt;
    for (std::size_t node = 0; node < before.nodes.size(); ++node) {
        const std::vector<Pipe>& pipes = before.nodes[node].pipes;
        for (std::size_t pipe = 0; pipe < pipes.size(); ++pipe) {
            const std::vector<Window>& windows = pipes[pipe].windows;
            for (std::size_t window = 0; window < windows.size(); ++window) {
                const std::vector<Channel>& channels = windows[window].channels;
                for (std::size_t channel = 0; channel < channels.size(); ++channel)
                    if (channels[channel].name == name)
                        return ChannelIndex{node, pipe, window, channel};
            }
        }
    }
    reader.findings().error(statement.place,
                            fmt::format("no channel named \"{}\" is defined before this", name));
    return std::nullopt;
}

/// The one that `keyword` stands for in `reference`; the first where it does not stand there.
template <typename T>
const T* member(const Statement& reference, std::string_view keyword, const std::vector<T>& members,
                ValueReader& reader, std::size_t& index) {
    for (const Statement& each : reference.statements)
        if (each.keyword == keyword) {
            const auto found = reader.reference(each, members, keyword);
            if (!found)
                return nullptr;
            index = *found;
        }
    if (index < members.size())
        return &members[index];
    reader.findings().error(reference.place, fmt::format("there is no {} of that", keyword));
    return nullptr;
}

}  // namespace

bool isPosition(const Statement& reference) {
    return reference.form == Statement::Form::Reference && !reference.statements.empty() &&
           reference.statements.front().keyword == "node";
}

std::optional<ChannelIndex> readChannel(const Statement& statement, const Configuration& before,
                                        ValueReader& reader) {
    if (!isPosition(statement))
        return channelNamed(statement, before, reader);
    for (const Statement& each : statement.statements)
        if (each.keyword != "node" && each.keyword != "pipe" && each.keyword != "window" &&
            each.keyword != "channel")
            reader.findings().error(each.place,
                                    fmt::format("'{}' in a channel's position; expected "
                                                "node, pipe, window or channel",
                                                each.keyword));
    ChannelIndex index;
    const Node* const node = member(statement, "node", before.nodes, reader, index.node);
    const Pipe* const pipe =
        node == nullptr ? nullptr : member(statement, "pipe", node->pipes, reader, index.pipe);
    const Window* const window =
        pipe == nullptr ? nullptr
                        : member(statement, "window", pipe->windows, reader, index.window);
    if (window == nullptr ||
        member(statement, "channel", window->channels, reader, index.channel) == nullptr)
        return std::nullopt;
    return index;
}

}  // namespace eyrie::config
