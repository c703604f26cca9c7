// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "coordinator/config/state.h"

namespace eyrie::v1 {
class ConfigurationState;
class EqualizerTuning;
class Head;
class LayoutSwitch;
class ObserverSetting;
class ViewSetting;
}  // namespace eyrie::v1

/// What changes while a configuration runs, as messages. Errors are those of state.h, and
/// InvalidArgument for lists of another length, which name their field.
namespace eyrie::config {

v1::ConfigurationState toMessage(const Configuration& configuration,
                                 const ConfigurationState& state);

/// Without what they are set for.
v1::EqualizerTuning toMessage(const EqualizerTuning& tuning);
v1::Head toMessage(const fabric::Mat4& roomFromHead);
v1::ViewSetting toMessage(const ViewState& state);
v1::ObserverSetting toMessage(const ObserverState& state);

/// Whatever they are set for; whether that can be set so is what change() and state.h's functions
/// find.
absl::StatusOr<EqualizerTuning> fromMessage(const v1::EqualizerTuning& message);
absl::StatusOr<fabric::Mat4> fromMessage(const v1::Head& message);
absl::StatusOr<ViewState> fromMessage(const v1::ViewSetting& message);
absl::StatusOr<ObserverState> fromMessage(const v1::ObserverSetting& message);

absl::Status change(const v1::LayoutSwitch& message, const Configuration& configuration,
                    ConfigurationState& state);
absl::Status change(const v1::EqualizerTuning& message, const Configuration& configuration,
                    ConfigurationState& state);
absl::Status change(const v1::Head& message, const Configuration& configuration,
                    ConfigurationState& state);
absl::Status change(const v1::ViewSetting& message, const Configuration& configuration,
                    ConfigurationState& state);
absl::Status change(const v1::ObserverSetting& message, const Configuration& configuration,
                    ConfigurationState& state);

/// All of it, or, with an error, nothing.
absl::Status change(const v1::ConfigurationState& message, const Configuration& configuration,
                    ConfigurationState& state);

}  // namespace eyrie::config
