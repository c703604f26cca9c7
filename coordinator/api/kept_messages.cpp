// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/kept_messages.h"

#include <utility>

#include "coordinator/config/state_message.h"
#include "eyrie/v1/kept_state.pb.h"
#include "fabric/log.h"

namespace eyrie::api {
namespace {

template <typename Map, typename Message>
void take(const typename Map::key_type& key, const Message& message, Map& map) {
    auto read = config::fromMessage(message);
    if (read.ok())
        map[key] = *std::move(read);
    else
        spdlog::warn("something that was set before is left out: {}",
                     std::string(read.status().message()));
}

}  // namespace

v1::KeptConfiguration toMessage(const coordinator::KeptConfiguration& kept,
                                const std::string& file) {
    v1::KeptConfiguration message;
    message.set_file(file);
    for (const auto& [canvas, switched] : kept.layouts) {
        v1::KeptLayout& layout = *message.add_layouts();
        layout.set_canvas(canvas);
        layout.set_first(switched.first);
        layout.set_layout(switched.layout);
    }
    for (const auto& [name, tuning] : kept.settings.equalizers) {
        if (tuning == config::EqualizerTuning())
            continue;
        v1::KeptEqualizer& equalizer = *message.add_equalizers();
        equalizer.set_name(name);
        *equalizer.mutable_tuning() = config::toMessage(tuning);
    }
    for (const auto& [observer, roomFromHead] : kept.settings.heads)
        if (roomFromHead != fabric::Mat4(1)) {
            v1::Head& head = *message.add_heads() = config::toMessage(roomFromHead);
            head.set_observer(observer);
        }
    for (const auto& [name, settings] : kept.settings.views)
        if (settings != config::ViewState()) {
            v1::ViewSetting& view = *message.add_views() = config::toMessage(settings);
            view.set_layout(name.first);
            view.set_view(name.second);
        }
    for (const auto& [name, settings] : kept.settings.observers)
        if (settings != config::ObserverState()) {
            v1::ObserverSetting& observer = *message.add_observers() = config::toMessage(settings);
            observer.set_observer(name);
        }
    return message;
}

coordinator::KeptConfiguration fromMessage(const v1::KeptConfiguration& message) {
    coordinator::KeptConfiguration kept;
    for (const v1::KeptLayout& layout : message.layouts())
        kept.layouts[layout.canvas()] = {layout.first(), layout.layout()};
    for (const v1::KeptEqualizer& equalizer : message.equalizers())
        take(equalizer.name(), equalizer.tuning(), kept.settings.equalizers);
    for (const v1::Head& head : message.heads()) take(head.observer(), head, kept.settings.heads);
    for (const v1::ViewSetting& view : message.views())
        take({view.layout(), view.view()}, view, kept.settings.views);
    for (const v1::ObserverSetting& observer : message.observers())
        take(observer.observer(), observer, kept.settings.observers);
    return kept;
}

}  // namespace eyrie::api
