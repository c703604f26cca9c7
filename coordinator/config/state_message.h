// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

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
