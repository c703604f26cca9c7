// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "coordinator/config/configuration.h"
#include "coordinator/frame/frame_source.h"

/// Which configuration frames are made by, and what of it is seen.
namespace eyrie::cli {

struct ConfigOptions {
    std::string file;             ///< .eqc or .json; empty: one is made of the renderers there are
    std::string compound = "2D";  ///< layout of that; not with a file
    std::string layout;           ///< of the canvas that is seen, in the place of its first one
    coordinator::Shown shown;
    bool oneChannel = false;  ///< without its compounds: each destination by its own channel
};

/// --config.
CLI::Option* addConfigFile(CLI::App& command, ConfigOptions& options);

/// That and --compound.
void addConfigOptions(CLI::App& command, ConfigOptions& options);

/// Which screen of it is seen, and by whom: --canvas, --segment, --layout, --eye.
void addScreenOptions(CLI::App& command, ConfigOptions& options);

/// Those, --stereo and --one-channel.
void addShownOptions(CLI::App& command, ConfigOptions& options);

/// What is seen, and by whom, in the words of those options; empty where none is given.
std::string wordsOf(const ConfigOptions& options);

/// What is told, on standard error, of what is found in a file.
enum class Told {
    All,
    Warnings,  ///< and errors, as --quiet asks
    Errors     ///< the rest is told by whoever reads the file as well
};
inline Told toldOf(bool isQuiet) { return isQuiet ? Told::Warnings : Told::All; }

/// The configuration that the file says; nothing without one. Errors: those of reading the file;
/// InvalidArgument, with all that is wrong with it.
absl::StatusOr<std::optional<config::Configuration>> configurationOf(const ConfigOptions& options,
                                                                     Told told);

/// Of all that it says, however its file is written; 0 without one.
std::uint64_t configurationHash(const std::optional<config::Configuration>& configuration);

/// What settings of the configuration are kept for: where its file lies; empty without one.
std::string configurationName(const ConfigOptions& options);

/// How many renderers what is shown at first, or by these canvases, can use.
int renderersOf(const config::Configuration& configuration,
                std::span<const coordinator::CanvasStatus> shown = {});

}  // namespace eyrie::cli
