// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/kept_settings.h"

#include <cstddef>
#include <utility>

#include "coordinator/compound/plan_check.h"
#include "coordinator/config/named.h"
#include "coordinator/frame/active_configuration.h"
#include "fabric/status.h"

namespace eyrie::coordinator {
namespace {

absl::Status tune(const config::Configuration& written, config::ConfigurationState& state,
                  std::size_t equalizer, const config::EqualizerTuning& tuning) {
    config::ConfigurationState tuned = state;
    RETURN_IF_ERROR(config::tuneEqualizer(written, tuned, equalizer, tuning));
    RETURN_IF_ERROR(compound::checkDivision(written, tuned, equalizer));
    state = std::move(tuned);
    return absl::OkStatus();
}

}  // namespace

void KeptSettings::keep(const ActiveConfiguration& active) {
    const config::Configuration& written = active.written();
    const config::ConfigurationState& state = active.state();
    const std::vector<equalizer::EqualizerState> named = active.equalizers();
    for (std::size_t i = 0; i < named.size(); ++i)
        equalizers.insert_or_assign(config::called(named, i), state.equalizers[i]);
    for (std::size_t i = 0; i < written.observers.size(); ++i) {
        heads.insert_or_assign(config::called(written.observers, i), state.heads[i]);
        observers.insert_or_assign(config::called(written.observers, i), state.observers[i]);
    }
    for (std::size_t i = 0; i < written.layouts.size(); ++i)
        for (std::size_t j = 0; j < written.layouts[i].views.size(); ++j)
            views.insert_or_assign(std::pair(config::called(written.layouts, i),
                                             config::called(written.layouts[i].views, j)),
                                   state.views[i][j]);
}

std::vector<absl::Status> KeptSettings::restore(ActiveConfiguration& active) const {
    const config::Configuration& written = active.written();
    const std::vector<equalizer::EqualizerState> named = active.equalizers();
    config::ConfigurationState state = active.state();
    std::vector<absl::Status> failures;
    const auto note = [&failures](absl::Status status) {
        if (!status.ok())
            failures.push_back(std::move(status));
    };
    for (const auto& [name, tuning] : equalizers) {
        const absl::StatusOr<std::size_t> found = config::findNamed(named, "equalizer", name);
        note(found.ok() ? tune(written, state, *found, tuning) : found.status());
    }
    for (const auto& [name, head] : heads) note(config::setHead(written, state, name, head));
    for (const auto& [name, settings] : observers)
        note(config::setObserver(written, state, name, settings));
    for (const auto& [name, settings] : views)
        note(config::setView(written, state, name.first, name.second, settings));
    note(active.become(std::move(state)));
    return failures;
}

}  // namespace eyrie::coordinator
