// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <absl/status/statusor.h>

#include "coordinator/config/configuration.h"

namespace eyrie::config {

/// What somebody changes of an equalizer while it runs; what is absent stays.
struct EqualizerTuning {
    std::optional<bool> isOn;      ///< off: its compounds are as they are configured
    std::optional<bool> isFrozen;  ///< on, but what it has chosen stays
    std::optional<SplitMode> mode;
    std::optional<double> damping;  ///< 0 to 1
    std::optional<fabric::Vec2> boundaryPixels;
    std::optional<double> boundaryRange;
    std::optional<fabric::Vec2> resistancePixels;
    std::optional<double> resistanceRange;
    std::optional<double> assembleOnlyLimit;  ///< above 0
    std::optional<double> framerate;          ///< frames a second, above 0
    std::optional<fabric::Vec2> tileSize;     ///< whole pixels; ends chunks
    std::optional<double> tileChunk;          ///< share of the range

    bool operator==(const EqualizerTuning&) const = default;
};

/// `settings` with what `tuning` changes of them. Errors: InvalidArgument, naming the setting and
/// what it may be, by the limits of configuration files; or a setting that its kind has not.
absl::StatusOr<Equalizer> tuned(Equalizer settings, const EqualizerTuning& tuning);

/// Both, one after the other.
EqualizerTuning together(EqualizerTuning first, const EqualizerTuning& then);

/// Whether it leaves its compound's children parts of the data while frames are drawn.
bool dividesData(const Equalizer& equalizer);

}  // namespace eyrie::config
