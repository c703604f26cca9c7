// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <absl/status/status.h>

#include "coordinator/config/configuration.h"
#include "coordinator/config/equalizer_tuning.h"
#include "fabric/vec.h"

/// What of a configuration changes while it runs, as a plain value, and what changes it. A change
/// is whole or not at all. Things are named by their names, of several the first, or by their
/// positions from 0 on; errors are NotFound, with the names that there are, and InvalidArgument.
namespace eyrie::config {

/// What a metre of the room may stand for: from an atom to the Sun.
inline constexpr double kLeastModelUnit = 1e-9;
inline constexpr double kMostModelUnit = 1e9;

/// Of a view; what is absent is as configured.
struct ViewState {
    std::optional<bool> isStereo;
    std::optional<StereoMode> stereoMode;  ///< how both eyes are shown in one picture
    double modelUnit = 1;                  ///< metres of the scene for one of the room
    std::optional<Surface> surface;

    bool operator==(const ViewState&) const = default;
};

/// Of an observer; what is absent is as configured.
struct ObserverState {
    std::optional<double> eyeBase;        ///< metres, from 0 on
    std::optional<double> focusDistance;  ///< metres, above 0
    std::optional<FocusMode> focusMode;

    bool operator==(const ObserverState&) const = default;
};

struct ConfigurationState {
    std::vector<std::optional<std::size_t>> layouts;  ///< shown by each canvas; none: OFF
    std::vector<EqualizerTuning> equalizers;    ///< of compounds from the roots down, as written
    std::vector<fabric::Mat4> heads;            ///< of observers: roomFromHead, rigid, metres
    std::vector<std::vector<ViewState>> views;  ///< of layouts
    std::vector<ObserverState> observers;

    bool operator==(const ConfigurationState&) const = default;
};

/// Each canvas shows its first layout, heads are at the origin, all else is as configured.
ConfigurationState initialState(const Configuration& configuration);

/// Shows one of the canvas's layouts, or, with "OFF", none.
absl::Status switchLayout(const Configuration& configuration, ConfigurationState& state,
                          std::string_view canvas, std::string_view layout);

/// Rotation and place of an observer's head.
absl::Status setHead(const Configuration& configuration, ConfigurationState& state,
                     std::string_view observer, const fabric::Mat4& roomFromHead);

/// Of the equalizers, from 0 on. Settings are limited as those of a file, and must be such as its
/// kind has; those that were changed before stay as they are.
absl::Status tuneEqualizer(const Configuration& configuration, ConfigurationState& state,
                           std::size_t equalizer, const EqualizerTuning& tuning);

/// In the place of what was set before.
absl::Status setView(const Configuration& configuration, ConfigurationState& state,
                     std::string_view layout, std::string_view view, const ViewState& settings);

/// In the place of what was set before.
absl::Status setObserver(const Configuration& configuration, ConfigurationState& state,
                         std::string_view observer, const ObserverState& settings);

/// Compounds and their equalizers in the order of ConfigurationState::equalizers.
struct PlacedEqualizer {
    const Compound* compound = nullptr;
    const Equalizer* equalizer = nullptr;
};
std::vector<PlacedEqualizer> equalizersOf(const Configuration& configuration);

/// With settings of equalizers, views and observers in the place of those configured, ready to be
/// resolved. Which layouts are shown, heads and model units are no part of a configuration.
Configuration applied(const Configuration& configuration, const ConfigurationState& state);

}  // namespace eyrie::config
