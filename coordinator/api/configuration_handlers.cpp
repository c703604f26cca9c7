// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/config/configuration_message.h"
#include "coordinator/config/state_message.h"
#include "coordinator/frame/active_configuration.h"
#include "eyrie/v1/eyrie_service.pb.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

using coordinator::ActiveConfiguration;

/// As config::change has read it: numbers are in their ranges, lists of their lengths.
equalizer::Tuning tuningOf(const v1::EqualizerTuning& message) {
    const auto pair = [](const auto& numbers) -> std::optional<fabric::Vec2> {
        if (numbers.size() != 2)
            return std::nullopt;
        return fabric::Vec2(numbers[0], numbers[1]);
    };
    equalizer::Tuning tuning;
    tuning.isOn = !message.off();
    tuning.isFrozen = message.frozen();
    if (message.mode() != v1::SPLIT_MODE_UNSPECIFIED)
        tuning.mode = static_cast<config::SplitMode>(static_cast<int>(message.mode()) - 1);
    if (message.has_damping())
        tuning.damping = message.damping();
    tuning.boundaryPixels = pair(message.boundary());
    if (message.has_boundary_range())
        tuning.boundaryRange = message.boundary_range();
    tuning.resistancePixels = pair(message.resistance());
    if (message.has_resistance_range())
        tuning.resistanceRange = message.resistance_range();
    if (message.has_assemble_only_limit())
        tuning.assembleOnlyLimit = message.assemble_only_limit();
    if (message.has_framerate())
        tuning.framerate = message.framerate();
    tuning.tileSize = pair(message.tile_size());
    return tuning;
}

/// The equalizers' settings are their own.
v1::ConfigurationState stateOf(const ActiveConfiguration& active) {
    v1::ConfigurationState state = config::toMessage(active.written(), active.state());
    const std::vector<equalizer::EqualizerState> equalizers = active.equalizers();
    for (v1::EqualizerTuning& tuning : *state.mutable_equalizers()) {
        const auto at = static_cast<std::size_t>(tuning.equalizer());
        tuning.set_off(!equalizers[at].isOn);
        tuning.set_frozen(equalizers[at].isFrozen);
    }
    return state;
}

absl::Status apply(const v1::ConfigurationState& change, ActiveConfiguration& active) {
    if (change.views_size() > 0)
        return absl::UnimplementedError(
            "change.views cannot be set while the configuration is at work; change its file");
    // All of it is checked before anything is done.
    config::ConfigurationState wanted = active.state();
    RETURN_IF_ERROR(config::change(change, active.written(), wanted));
    for (const v1::LayoutSwitch& layout : change.layouts())
        RETURN_IF_ERROR(active.switchLayout(layout.canvas(), layout.layout()));
    for (const v1::EqualizerTuning& tuning : change.equalizers())
        RETURN_IF_ERROR(active.tune(fmt::format("{}", tuning.equalizer()), tuningOf(tuning)));
    if (change.heads_size() == 0)
        return absl::OkStatus();
    for (std::size_t i = 0; i < wanted.heads.size(); ++i)
        if (wanted.heads[i] != active.state().heads[i])
            RETURN_IF_ERROR(active.setHead(fmt::format("{}", i), wanted.heads[i]));
    return absl::OkStatus();
}

absl::StatusOr<v1::GetConfigurationResponse> get(coordinator::ConfigurationAccess& access) {
    v1::GetConfigurationResponse response;
    const absl::Status status = access.withConfiguration([&](ActiveConfiguration& active) {
        *response.mutable_configuration() = config::toMessage(active.written());
        *response.mutable_state() = stateOf(active);
        for (const equalizer::EqualizerState& state : active.equalizers()) {
            v1::EqualizerReport& report = *response.add_equalizers();
            report.set_name(state.name);
            report.set_on(state.isOn);
            report.set_frozen(state.isFrozen);
        }
        return absl::OkStatus();
    });
    RETURN_IF_ERROR(status);
    return response;
}

absl::StatusOr<v1::ChangeConfigurationResponse> change(
    coordinator::ConfigurationAccess& access, const v1::ChangeConfigurationRequest& request) {
    v1::ChangeConfigurationResponse response;
    const absl::Status status = access.withConfiguration([&](ActiveConfiguration& active) {
        absl::Status applied = apply(request.change(), active);
        *response.mutable_state() = stateOf(active);
        return applied;
    });
    RETURN_IF_ERROR(status);
    return response;
}

}  // namespace

void addConfigurationHandlers(Handlers& handlers, coordinator::ConfigurationAccess& configuration) {
    handlers.add<v1::GetConfigurationRequest, v1::GetConfigurationResponse>(
        "GetConfiguration", [&configuration](const v1::GetConfigurationRequest&, const Call&) {
            return get(configuration);
        });
    handlers.add<v1::ChangeConfigurationRequest, v1::ChangeConfigurationResponse>(
        "ChangeConfiguration",
        [&configuration](const v1::ChangeConfigurationRequest& request, const Call&) {
            return change(configuration, request);
        });
}

}  // namespace eyrie::api
