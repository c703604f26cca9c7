// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/settings.h"

#include <fmt/format.h>

#include "coordinator/config/equalizer_limits.h"
#include "fabric/status.h"

namespace eyrie::equalizer {
namespace {

std::string text(double value) { return fmt::format("{}", value); }
std::string text(const fabric::Vec2& value) { return fmt::format("[ {} {} ]", value.x, value.y); }

template <typename Value, typename Target>
absl::Status set(const char* name, const std::optional<Value>& value,
                 bool (*isAllowed)(const Value&), const char* allowed, Target& target) {
    if (!value)
        return absl::OkStatus();
    if (!isAllowed(*value))
        return absl::InvalidArgumentError(
            fmt::format("{} is {}; it must be {}", name, text(*value), allowed));
    target = *value;
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<config::Equalizer> tuned(config::Equalizer settings, const Tuning& tuning) {
    constexpr const char* kPixels = "whole pixels from 0 to 1000000000, across and up";
    constexpr const char* kShare = "from 0 to 1";
    constexpr const char* kAboveZero = "above 0";
    settings.mode = tuning.mode.value_or(settings.mode);
    RETURN_IF_ERROR(set("damping", tuning.damping, config::isShare, kShare, settings.damping));
    RETURN_IF_ERROR(
        set("boundary", tuning.boundaryPixels, config::isPixels, kPixels, settings.boundaryPixels));
    RETURN_IF_ERROR(
        set("boundary", tuning.boundaryRange, config::isShare, kShare, settings.boundaryRange));
    RETURN_IF_ERROR(set("resistance", tuning.resistancePixels, config::isPixels, kPixels,
                        settings.resistancePixels));
    RETURN_IF_ERROR(set("resistance", tuning.resistanceRange, config::isShare, kShare,
                        settings.resistanceRange));
    RETURN_IF_ERROR(set("assemble_only_limit", tuning.assembleOnlyLimit, config::isAboveZero,
                        kAboveZero, settings.assembleOnlyLimit));
    RETURN_IF_ERROR(
        set("framerate", tuning.framerate, config::isAboveZero, kAboveZero, settings.framerate));
    RETURN_IF_ERROR(set("size", tuning.tileSize, config::isTileSize,
                        "a width and a height of a pixel or more", settings.tileSize));
    if (tuning.tileSize)
        settings.tileChunk.reset();
    RETURN_IF_ERROR(
        set("size", tuning.tileChunk, config::isChunk, "above 0, 1 at most", settings.tileChunk));
    return settings;
}

}  // namespace eyrie::equalizer
