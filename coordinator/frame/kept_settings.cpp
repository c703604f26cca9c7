// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/kept_settings.h"

#include <cstddef>

#include "coordinator/config/named.h"
#include "coordinator/frame/active_configuration.h"

namespace eyrie::coordinator {
namespace {

/// Calls `each(map's key, setting)` for all that `state` has.
template <typename State, typename OfEqualizer, typename OfHead, typename OfObserver,
          typename OfView>
void forAll(const ActiveConfiguration& active, State& state, OfEqualizer ofEqualizer, OfHead ofHead,
            OfObserver ofObserver, OfView ofView) {
    const config::Configuration& written = active.written();
    const std::vector<equalizer::EqualizerState> equalizers = active.equalizers();
    for (std::size_t i = 0; i < equalizers.size(); ++i)
        ofEqualizer(equalizers[i].name, state.equalizers[i]);
    for (std::size_t i = 0; i < written.observers.size(); ++i) {
        ofHead(config::called(written.observers, i), state.heads[i]);
        ofObserver(config::called(written.observers, i), state.observers[i]);
    }
    for (std::size_t i = 0; i < written.layouts.size(); ++i)
        for (std::size_t j = 0; j < written.layouts[i].views.size(); ++j)
            ofView(std::pair(config::called(written.layouts, i),
                             config::called(written.layouts[i].views, j)),
                   state.views[i][j]);
}

/// A function that puts what it is told into `map`.
template <typename Map>
auto into(Map& map) {
    return [&map](const auto& key, const auto& setting) { map.insert_or_assign(key, setting); };
}

/// A function that sets what it is told to what `map` has of it.
template <typename Map>
auto outOf(const Map& map) {
    return [&map](const auto& key, auto& setting) {
        if (const auto found = map.find(key); found != map.end())
            setting = found->second;
    };
}

}  // namespace

void KeptSettings::keep(const ActiveConfiguration& active) {
    forAll(active, active.state(), into(equalizers_), into(heads_), into(observers_), into(views_));
}

absl::Status KeptSettings::restore(ActiveConfiguration& active) const {
    config::ConfigurationState state = active.state();
    forAll(active, state, outOf(equalizers_), outOf(heads_), outOf(observers_), outOf(views_));
    return active.become(std::move(state));
}

}  // namespace eyrie::coordinator
