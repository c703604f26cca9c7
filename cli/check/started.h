// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/json_object.h"
#include "coordinator/config/configuration.h"

namespace eyrie::cli::check {

/// What of a configuration starts with so many renderers, as the coordinator does it: pipes that
/// draw something of what is shown at first take renderers in turn; others are not started.
struct Started {
    std::size_t renderers = 0;  ///< that are there
    struct Pipe {
        std::string name;          ///< node/pipe, by their names or positions
        std::size_t renderer = 0;  ///< from 0 on
    };
    std::vector<Pipe> pipes;             ///< that are used, as written
    std::vector<std::string> notNeeded;  ///< pipes that draw nothing of what is shown at first

    /// Renderers without which pipes share others.
    std::size_t missing() const { return pipes.size() > renderers ? pipes.size() - renderers : 0; }
};

Started startedWith(const config::Configuration& configuration, std::size_t renderers);

std::string text(const Started& started);
JsonObject jsonOf(const Started& started);

}  // namespace eyrie::cli::check
