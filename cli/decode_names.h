// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/options/one_of.h"
#include "renderer/tile_decoding.h"

namespace eyrie::cli {

/// What `--decode` may be.
inline const std::map<std::string, TileDecoding>& decodeNames() {
    static const std::map<std::string, TileDecoding> names = {
        {"auto", TileDecoding::Auto}, {"cpu", TileDecoding::Cpu}, {"gpu", TileDecoding::Gpu}};
    return names;
}

inline std::string nameOf(TileDecoding decoding) {
    for (const auto& [name, value] : decodeNames())
        if (value == decoding)
            return name;
    return "auto";
}

inline void addDecodeOption(CLI::App& command, TileDecoding& decoding) {
    command
        .add_option("--decode", decoding,
                    "What makes terrain's vertices; auto: what a measurement finds faster [auto]")
        ->transform(valueOf(decodeNames()))
        ->type_name("auto|cpu|gpu");
}

}  // namespace eyrie::cli
