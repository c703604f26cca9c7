// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/config/resolved.h"

/// A configuration's values in the words of its file.
namespace eyrie::cli::check {

std::vector<std::string> words(const config::Tasks& tasks);
std::vector<std::string> words(const config::Eyes& eyes);
std::vector<std::string> words(const config::Buffers& buffers);
std::string_view word(config::EqualizerKind kind);
std::string_view word(config::SplitMode mode);
std::string_view word(config::EyeSight::Eye eye);

/// "name", or its position where it has none.
std::string called(const std::string& name, std::size_t position);

/// Where a node is, each once: its host, by which renderers find it, then those of its connections.
std::vector<std::string> hostsOf(const config::Node& node);

const config::Channel& channelOf(const config::Configuration& configuration,
                                 const config::ChannelIndex& index);
/// Names from the node on, where they have none positions, such as appNode/0/window1/channel1.
std::string pathOf(const config::Configuration& configuration, const config::ChannelIndex& index);

/// How many there are of each kind of thing.
struct Counts {
    std::size_t nodes = 0;
    std::size_t pipes = 0;
    std::size_t windows = 0;
    std::size_t channels = 0;
    std::size_t observers = 0;
    std::size_t layouts = 0;
    std::size_t views = 0;
    std::size_t canvases = 0;
    std::size_t segments = 0;
    std::size_t destinations = 0;
    std::size_t roots = 0;
    std::size_t compounds = 0;  ///< as written
    std::size_t implicit = 0;   ///< plain pictures of views that no compound makes
};
Counts countsOf(const config::Configuration& configuration,
                const config::ResolvedConfiguration& resolved);

}  // namespace eyrie::cli::check
