// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "cli/cache_options.h"
#include "renderer/renderer.h"

namespace eyrie::cli {

/// The options of every command that draws, be it by other processes: how a renderer does it.
struct DrawingOptions {
    CacheOptions cache;
    std::string memory = "2G";
    std::string hostMemory = "1G";
    TileDecoding decoding = TileDecoding::Auto;
};

void addDrawingOptions(CLI::App& command, DrawingOptions& options);

/// Errors: InvalidArgument, naming the option.
absl::StatusOr<RendererOptions> rendererOptionsOf(const DrawingOptions& options);

/// What `eyrie renderer` is given to draw so.
std::vector<std::string> argumentsOf(const DrawingOptions& options);

}  // namespace eyrie::cli
