// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/on_display.h"

#include <cstddef>
#include <utility>
#include <variant>

#include "coordinator/config/one_channel.h"

namespace eyrie::config {

OnDisplay onDisplay(const Configuration& shown, const ConfigurationState& state) {
    const std::vector<Compound> compounds = oneChannel(shown).compounds;
    OnDisplay seen{{}, shown.observers, state.heads};
    for (std::size_t i = 0; i < shown.canvases.size(); ++i) {
        OnDisplay::Canvas& canvas = seen.canvases.emplace_back();
        if (!state.layouts[i])
            continue;
        const std::size_t layout = *state.layouts[i];
        canvas.views = shown.layouts[layout].views;
        for (const ViewState& view : state.views[layout])
            canvas.modelUnits.push_back(view.modelUnit);
        for (Compound compound : compounds) {
            auto& destination = std::get<DestinationIndex>(compound.channel);
            if (destination.canvas != i || destination.layout != layout)
                continue;
            destination.layout = 0;
            canvas.drawn.push_back(std::move(compound));
        }
    }
    return seen;
}

}  // namespace eyrie::config
