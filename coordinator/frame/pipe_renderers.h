// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "coordinator/config/configuration.h"
#include "coordinator/config/default_config.h"

namespace eyrie::coordinator {

/// A pipe of a configuration, by positions.
struct Pipe {
    std::size_t node = 0;
    std::size_t pipe = 0;
    auto operator<=>(const Pipe&) const = default;
};

/// By its id, the renderer that does what a pipe is to do.
using RendererOfPipe = std::map<Pipe, std::string>;

/// Decides which renderer does which pipe. A pair stays together while both are there, and is
/// remembered while the pipe has nothing to do: a renderer has its pipe's share of the data in
/// memory, and that another one dies or comes is no reason to read it anew.
class PipeRenderers {
public:
    /// One renderer, of `renderers`, for each of `pipes`; both hold no one twice, and `renderers`
    /// is not empty. A pipe of `nodes` goes to those that are to be its node, if there are any;
    /// else to those that are to be none of these nodes; else to anybody. Among these, what nobody
    /// has goes to the one with the fewest pipes, of several the first; then what was lent last
    /// moves on until none has two more than another.
    RendererOfPipe place(const std::vector<Pipe>& pipes,
                         const std::vector<config::RendererFacts>& renderers,
                         std::span<const config::Node> nodes);

private:
    struct Pair {
        Pipe pipe;
        std::string renderer;
    };
    std::vector<Pair> pairs_;  ///< the latest last
};

}  // namespace eyrie::coordinator
