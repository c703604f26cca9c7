// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/options/one_of.h"
#include "fabric/frame_data.h"

namespace eyrie::cli {

inline const std::map<std::string, fabric::Occlusion>& occlusionModes() {
    static const std::map<std::string, fabric::Occlusion> kModes = {
        {"auto", fabric::Occlusion::Auto},
        {"on", fabric::Occlusion::On},
        {"off", fabric::Occlusion::Off}};
    return kModes;
}

inline std::string nameOf(fabric::Occlusion occlusion) {
    for (const auto& [name, mode] : occlusionModes())
        if (mode == occlusion)
            return name;
    return "auto";
}

inline void addOcclusionOption(CLI::App& command, fabric::Occlusion& occlusion) {
    command
        .add_option("--occlusion", occlusion,
                    "Leave out what is hidden, by what the frame before showed; the picture is the "
                    "same [auto: where it pays]")
        ->transform(valueOf(occlusionModes()))
        ->type_name("auto|on|off");
}

}  // namespace eyrie::cli
