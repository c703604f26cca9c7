// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/state.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/config/named.h"
#include "coordinator/config/section_readers.h"
#include "coordinator/config/statement_list.h"
#include "fabric/status.h"

namespace eyrie::config {
namespace {

std::string layoutsOf(const Configuration& configuration, const Canvas& canvas) {
    std::string names;
    for (const std::optional<std::size_t>& layout : canvas.layouts)
        if (layout)
            names += fmt::format("\"{}\", ", configuration.layouts[*layout].name.empty()
                                                 ? fmt::format("{}", *layout)
                                                 : configuration.layouts[*layout].name);
    return names + "OFF";
}

absl::Status firstError(const Findings& findings) {
    if (findings.all().empty())
        return absl::OkStatus();
    return absl::InvalidArgumentError(findings.all().front().message);
}

template <typename T, typename U>
void take(const std::optional<T>& setting, U& target) {
    if (setting)
        target = *setting;
}

absl::Status check(const Surface& surface) {
    if (std::holds_alternative<std::monostate>(surface))
        return absl::OkStatus();
    StatementList list;
    writeSurface(surface, list);
    Findings findings;
    ValueReader reader(findings);
    const Statement statement = list.take().front();
    std::holds_alternative<Wall>(surface) ? readWall(statement, reader)
                                          : readProjection(statement, reader);
    return firstError(findings);
}

void addEqualizers(const Compound& compound, std::vector<PlacedEqualizer>& found) {
    for (const Equalizer& equalizer : compound.equalizers) found.push_back({&compound, &equalizer});
    for (const Compound& child : compound.children) addEqualizers(child, found);
}

/// Who lets it divide data that the file does not has depths compared, too: what is far would cover
/// what is near.
void tune(Equalizer& equalizer, const EqualizerTuning& tuning, Compound& compound) {
    const bool dividedData = dividesData(equalizer);
    equalizer = tuned(equalizer, tuning).value_or(equalizer);
    if (dividesData(equalizer) && !dividedData)
        compound.buffers = Buffers{true, true};
}

void tuneAll(Compound& compound, const ConfigurationState& state, std::size_t& next) {
    for (Equalizer& equalizer : compound.equalizers)
        tune(equalizer, state.equalizers[next++], compound);
    for (Compound& child : compound.children) tuneAll(child, state, next);
}

}  // namespace

ConfigurationState initialState(const Configuration& configuration) {
    ConfigurationState state;
    for (const Canvas& canvas : configuration.canvases)
        state.layouts.push_back(canvas.layouts.empty() ? std::nullopt : canvas.layouts.front());
    state.equalizers.resize(equalizersOf(configuration).size());
    state.heads.resize(configuration.observers.size(), fabric::Mat4(1));
    state.observers.resize(configuration.observers.size());
    for (const Layout& layout : configuration.layouts)
        state.views.emplace_back(layout.views.size());
    return state;
}

absl::Status switchLayout(const Configuration& configuration, ConfigurationState& state,
                          std::string_view canvas, std::string_view layout) {
    ASSIGN_OR_RETURN(const std::size_t of, findNamed(configuration.canvases, "canvas", canvas));
    const Canvas& found = configuration.canvases[of];
    const absl::StatusOr<std::size_t> shown = findNamed(configuration.layouts, "layout", layout);
    const bool isKnown = shown.ok() && std::ranges::find(found.layouts, std::optional(*shown)) !=
                                           found.layouts.end();
    if (!isKnown && layout != "OFF")
        return absl::NotFoundError(
            fmt::format("canvas \"{}\" has no layout called \"{}\"; there are {}", canvas, layout,
                        layoutsOf(configuration, found)));
    state.layouts[of] = isKnown ? std::optional(*shown) : std::nullopt;
    return absl::OkStatus();
}

absl::Status setHead(const Configuration& configuration, ConfigurationState& state,
                     std::string_view observer, const fabric::Mat4& roomFromHead) {
    ASSIGN_OR_RETURN(const std::size_t of,
                     findNamed(configuration.observers, "observer", observer));
    constexpr double kSlack = 1e-4;    // of what trackers send in a few digits
    constexpr double kFarthest = 1e6;  // metres
    const fabric::Mat4 squared = glm::transpose(roomFromHead) * roomFromHead;
    bool isRigid = glm::determinant(roomFromHead) > 0;
    for (int i = 0; i < 3; ++i) {
        isRigid = isRigid && roomFromHead[i][3] == 0 && std::abs(roomFromHead[3][i]) <= kFarthest;
        for (int j = 0; j < 3; ++j)
            isRigid = isRigid && std::abs(squared[i][j] - (i == j ? 1 : 0)) <= kSlack;
    }
    if (!isRigid || roomFromHead[3][3] != 1)
        return absl::InvalidArgumentError(
            fmt::format("the head of observer \"{}\" is no rotation and place within {} metres",
                        observer, kFarthest));
    state.heads[of] = roomFromHead;
    return absl::OkStatus();
}

absl::Status tuneEqualizer(const Configuration& configuration, ConfigurationState& state,
                           std::size_t equalizer, const EqualizerTuning& tuning) {
    const std::vector<PlacedEqualizer> all = equalizersOf(configuration);
    if (equalizer >= all.size())
        return absl::NotFoundError(
            fmt::format("there is no equalizer {}; there are {}", equalizer, all.size()));
    const EqualizerTuning changed = together(state.equalizers[equalizer], tuning);
    RETURN_IF_ERROR(fabric::withContext(tuned(*all[equalizer].equalizer, changed).status(),
                                        fmt::format("equalizer {}", equalizer)));
    state.equalizers[equalizer] = changed;
    return absl::OkStatus();
}

absl::Status setView(const Configuration& configuration, ConfigurationState& state,
                     std::string_view layout, std::string_view view, const ViewState& settings) {
    ASSIGN_OR_RETURN(const std::size_t of, findNamed(configuration.layouts, "layout", layout));
    ASSIGN_OR_RETURN(const std::size_t index,
                     findNamed(configuration.layouts[of].views, "view", view));
    if (!(settings.modelUnit >= kLeastModelUnit && settings.modelUnit <= kMostModelUnit))
        return absl::InvalidArgumentError(
            fmt::format("the model unit is {}; it must be from {:g} "
                        "to {:g}",
                        settings.modelUnit, kLeastModelUnit, kMostModelUnit));
    if (settings.surface)
        RETURN_IF_ERROR(check(*settings.surface));
    state.views[of][index] = settings;
    return absl::OkStatus();
}

absl::Status setObserver(const Configuration& configuration, ConfigurationState& state,
                         std::string_view observer, const ObserverState& settings) {
    ASSIGN_OR_RETURN(const std::size_t of,
                     findNamed(configuration.observers, "observer", observer));
    const double base = settings.eyeBase.value_or(0);
    if (!(base >= 0 && base <= kMostEyeMetres))
        return absl::InvalidArgumentError(
            fmt::format("the eye base is {}; it must be from 0 to {}", base, kMostEyeMetres));
    const double distance = settings.focusDistance.value_or(1);
    if (!(distance > 0 && distance <= kMostEyeMetres))
        return absl::InvalidArgumentError(
            fmt::format("the focus distance is {}; it must be above 0 and at most {}", distance,
                        kMostEyeMetres));
    state.observers[of] = settings;
    return absl::OkStatus();
}

std::vector<PlacedEqualizer> equalizersOf(const Configuration& configuration) {
    std::vector<PlacedEqualizer> found;
    for (const Compound& root : configuration.compounds) addEqualizers(root, found);
    return found;
}

Configuration applied(const Configuration& configuration, const ConfigurationState& state) {
    Configuration result = configuration;
    for (std::size_t layout = 0; layout < result.layouts.size(); ++layout)
        for (std::size_t view = 0; view < result.layouts[layout].views.size(); ++view) {
            take(state.views[layout][view].isStereo, result.layouts[layout].views[view].isStereo);
            take(state.views[layout][view].surface, result.layouts[layout].views[view].surface);
            take(state.views[layout][view].stereoMode,
                 result.layouts[layout].views[view].stereoMode);
        }
    for (std::size_t i = 0; i < result.observers.size(); ++i) {
        if (state.observers[i].eyeBase)
            result.observers[i].eyeBase = state.observers[i].eyeBase;
        take(state.observers[i].focusDistance, result.observers[i].focusDistance);
        take(state.observers[i].focusMode, result.observers[i].focusMode);
    }
    std::size_t next = 0;
    for (Compound& root : result.compounds) tuneAll(root, state, next);
    return result;
}

}  // namespace eyrie::config
