// SPDX-License-Identifier: Apache-2.0
#include "cli/config_options.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

#include "cli/compound_names.h"
#include "cli/configuration_file.h"
#include "cli/log.h"
#include "cli/options/one_of.h"
#include "coordinator/compound/plan_check.h"
#include "coordinator/config/configuration_message.h"
#include "coordinator/config/findings.h"
#include "coordinator/config/named.h"
#include "coordinator/config/one_channel.h"
#include "coordinator/frame/active_configuration.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

using compound::Eye;
using compound::Stereo;

/// Not of std::optional<Eye>, which CLI11 would turn into no text at all.
const std::map<std::string, Eye>& eyeNames() {
    static const std::map<std::string, Eye> names = {
        {"cyclop", Eye::Cyclop}, {"left", Eye::Left}, {"right", Eye::Right}};
    return names;
}

const std::map<std::string, Stereo>& stereoNames() {
    static const std::map<std::string, Stereo> names = {{"anaglyph", Stereo::Anaglyph},
                                                        {"side-by-side", Stereo::SideBySide},
                                                        {"top-bottom", Stereo::TopBottom}};
    return names;
}

/// Empty where none of the names is that of `value`.
template <typename Value, typename Known>
std::string nameIn(const std::map<std::string, Known>& names, const Value& value) {
    const auto found =
        std::ranges::find_if(names, [&](auto& each) { return each.second == value; });
    return found == names.end() ? "" : found->first;
}

/// The layout goes to the front of the list of the canvas that is seen.
absl::Status showLayout(const ConfigOptions& options, config::Configuration& configuration) {
    if (options.layout.empty())
        return absl::OkStatus();
    auto& canvases = configuration.canvases;
    std::size_t canvas = 0;
    if (!options.shown.canvas.empty()) {
        const auto found = config::findNamed(canvases, "canvas", options.shown.canvas);
        RETURN_IF_ERROR(fabric::withContext(found.status(), "--canvas"));
        canvas = *found;
    }
    config::ConfigurationState state = config::initialState(configuration);
    RETURN_IF_ERROR(
        fabric::withContext(config::switchLayout(configuration, state,
                                                 config::called(canvases, canvas), options.layout),
                            "--layout"));
    auto& layouts = canvases[canvas].layouts;
    const auto shown = std::ranges::find(layouts, state.layouts[canvas]);
    if (shown != layouts.end())
        std::rotate(layouts.begin(), shown, shown + 1);
    else  // OFF, which every canvas can be
        layouts.insert(layouts.begin(), state.layouts[canvas]);
    return absl::OkStatus();
}

void tellFindings(const config::Findings& findings, const std::string& file, Told told) {
    using Kind = config::Finding::Kind;
    if (findings.hasErrors())
        return tellErrors(config::describe(findings, file));
    if (told != Told::Errors)
        tellWarnings(config::describe(findings, file, Kind::Warning, Kind::Warning));
    if (told == Told::All)
        tell(config::describe(findings, file, Kind::OnScreen, Kind::Note));
}

}  // namespace

CLI::Option* addConfigFile(CLI::App& command, ConfigOptions& options) {
    return command
        .add_option("--config", options.file,
                    "How renderers share the work and what is seen: an .eqc file of Equalizer, or "
                    ".json (`eyrie check` explains it)")
        ->type_name("FILE");
}

void addConfigOptions(CLI::App& command, ConfigOptions& options) {
    CLI::Option* const file = addConfigFile(command, options);
    command.add_option("--compound", options.compound, kCompoundHelp)
        ->check(oneOf(namesOf(compoundNames())))
        ->type_name("2D|DB|DB-static|direct-send|DB-2D")
        ->excludes(file);
}

void addScreenOptions(CLI::App& command, ConfigOptions& options) {
    command
        .add_option("--canvas", options.shown.canvas,
                    "Which of the configuration's canvases, by name or position (0, or #0 where "
                    "another is named 0) [the first]")
        ->type_name("NAME");
    command
        .add_option("--segment", options.shown.segment,
                    "Which of its segments, by name or position, as canvases [the whole canvas]")
        ->type_name("NAME");
    command
        .add_option(
            "--layout", options.layout,
            "Which of its layouts it shows, by name or position among all layouts [its first]")
        ->type_name("NAME");
    command.add_option("--eye", options.shown.eye, "What one eye sees [what the view shows]")
        ->transform(valueOf(eyeNames()))
        ->type_name("left|right|cyclop");
}

void addShownOptions(CLI::App& command, ConfigOptions& options) {
    addScreenOptions(command, options);
    command
        .add_option("--stereo", options.shown.stereo,
                    "How two eyes are put into one picture [as the configuration says]")
        ->transform(valueOf(stereoNames()))
        ->excludes("--eye")
        ->type_name("anaglyph|side-by-side|top-bottom");
    command.add_flag("--one-channel", options.oneChannel,
                     "Draw each destination by its own channel, without compounds: what every "
                     "configuration's picture is to equal");
}

std::string wordsOf(const ConfigOptions& options) {
    std::vector<std::string> words;
    const auto add = [&](std::string_view option, const std::string& value) {
        if (!value.empty())
            words.push_back(fmt::format("{} {}", option, value));
    };
    add("--config", std::filesystem::path(options.file).filename().string());
    add("--canvas", options.shown.canvas);
    add("--segment", options.shown.segment);
    add("--layout", options.layout);
    add("--eye", nameIn(eyeNames(), options.shown.eye));
    add("--stereo", nameIn(stereoNames(), options.shown.stereo));
    if (options.oneChannel)
        words.emplace_back("--one-channel");
    return fmt::format("{}", fmt::join(words, " "));
}

absl::StatusOr<std::optional<config::Configuration>> configurationOf(const ConfigOptions& options,
                                                                     Told told) {
    if (options.file.empty()) {
        if (!options.layout.empty() || options.oneChannel)
            return absl::InvalidArgumentError(
                "--layout and --one-channel are of a configuration; name one with --config");
        return std::optional<config::Configuration>();
    }
    config::Findings findings;
    ASSIGN_OR_RETURN(config::Configuration configuration,
                     readConfiguration(options.file, findings));
    if (!findings.hasErrors())
        config::resolve(configuration, findings);
    if (!findings.hasErrors())
        compound::checkPlans(configuration, findings);
    tellFindings(findings, options.file, told);
    if (findings.hasErrors())
        return absl::InvalidArgumentError(
            fmt::format("--config: {} has {} error{}; `eyrie check` explains it", options.file,
                        findings.errors(), findings.errors() == 1 ? "" : "s"));
    if (configuration.canvases.empty())
        return absl::InvalidArgumentError(
            fmt::format("--config: {} has no canvas, so it shows nothing", options.file));
    RETURN_IF_ERROR(showLayout(options, configuration));
    if (options.oneChannel)
        configuration = config::oneChannel(configuration);
    return std::optional(std::move(configuration));
}

std::uint64_t configurationHash(const std::optional<config::Configuration>& configuration) {
    if (!configuration)
        return 0;
    const std::string text = config::writeJson(*configuration);
    return XXH64(text.data(), text.size(), 0);
}

std::string configurationName(const ConfigOptions& options) {
    if (options.file.empty())
        return {};
    std::error_code error;
    const std::filesystem::path path = std::filesystem::absolute(options.file, error);
    return error ? options.file : path.lexically_normal().string();
}

int renderersOf(const config::Configuration& configuration,
                std::span<const coordinator::CanvasStatus> shown) {
    coordinator::ActiveConfiguration active(configuration);
    for (const coordinator::CanvasStatus& canvas : shown)
        (void)active.switchLayout(canvas.name, canvas.layout);  // which shows it: it has it
    return std::max(1, static_cast<int>(active.pipes().size()));
}

}  // namespace eyrie::cli
