// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/config/configuration_message.h"
#include "coordinator/config/state_message.h"
#include "coordinator/frame/active_configuration.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

using coordinator::ActiveConfiguration;

/// With what equalizers are by default where nobody has changed it.
v1::ConfigurationState stateOf(const ActiveConfiguration& active) {
    v1::ConfigurationState state = config::toMessage(active.written(), active.state());
    const std::vector<equalizer::EqualizerState> equalizers = active.equalizers();
    for (v1::EqualizerTuning& tuning : *state.mutable_equalizers()) {
        const auto at = static_cast<std::size_t>(tuning.equalizer());
        tuning.set_on(equalizers[at].isOn);
        tuning.set_frozen(equalizers[at].isFrozen);
    }
    return state;
}

absl::Status apply(const v1::ConfigurationState& change, ActiveConfiguration& active) {
    config::ConfigurationState wanted = active.state();
    RETURN_IF_ERROR(config::change(change, active.written(), wanted));
    return active.become(std::move(wanted), change.layouts_size() > 0);
}

void addMeasured(const equalizer::EqualizerState& state, v1::EqualizerReport& report) {
    if (state.report.framesPerSecond > 0)
        report.set_frames_per_second(state.report.framesPerSecond);
    if (state.settings.kind == config::EqualizerKind::Dfr)
        report.set_zoom(state.report.zoom);
    if (state.report.imbalance > 0)
        report.set_imbalance(state.report.imbalance);
}

absl::StatusOr<v1::GetConfigurationResponse> get(coordinator::ConfigurationAccess& access,
                                                 const v1::GetConfigurationRequest& request) {
    v1::GetConfigurationResponse response;
    const absl::Status status = access.withConfiguration([&](ActiveConfiguration& active) {
        *response.mutable_configuration() = config::toMessage(active.written());
        *response.mutable_state() = stateOf(active);
        for (const equalizer::EqualizerState& state : active.equalizers()) {
            v1::EqualizerReport& report = *response.add_equalizers();
            report.set_name(state.name);
            report.set_on(state.isOn);
            report.set_frozen(state.isFrozen);
            if (request.measured())
                addMeasured(state, report);
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
        "GetConfiguration", [&configuration](const v1::GetConfigurationRequest& request,
                                             const Call&) { return get(configuration, request); });
    handlers.add<v1::ChangeConfigurationRequest, v1::ChangeConfigurationResponse>(
        "ChangeConfiguration",
        [&configuration](const v1::ChangeConfigurationRequest& request, const Call&) {
            return change(configuration, request);
        });
}

}  // namespace eyrie::api
