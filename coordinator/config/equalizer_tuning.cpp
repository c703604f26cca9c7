// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/equalizer_tuning.h"

#include <initializer_list>
#include <string>

#include <fmt/format.h>

#include "coordinator/config/equalizer_limits.h"
#include "coordinator/config/statement_list.h"
#include "fabric/status.h"

namespace eyrie::config {
namespace {

using Kind = EqualizerKind;

std::string text(double value) { return fmt::format("{}", value); }
std::string text(const fabric::Vec2& value) { return fmt::format("[ {} {} ]", value.x, value.y); }

/// A setting by its name in EqualizerTuning messages, and the kinds that have it.
struct Setting {
    const char* name;
    std::initializer_list<Kind> kinds;
};

absl::Status checkKind(const Setting& setting, Kind kind) {
    std::string having;
    for (const Kind each : setting.kinds) {
        if (each == kind)
            return absl::OkStatus();
        having += fmt::format("{}a {}", having.empty() ? "" : " or ", keywordOf(each));
    }
    return absl::InvalidArgumentError(
        fmt::format("{} is a setting of {}, and this is a {}; leave it out", setting.name, having,
                    keywordOf(kind)));
}

template <typename Value, typename Target>
absl::Status set(const Setting& setting, Kind kind, const std::optional<Value>& value,
                 bool (*isAllowed)(const Value&), const char* allowed, Target& target) {
    if (!value)
        return absl::OkStatus();
    RETURN_IF_ERROR(checkKind(setting, kind));
    if (!isAllowed(*value))
        return absl::InvalidArgumentError(
            fmt::format("{} is {}; it must be {}", setting.name, text(*value), allowed));
    target = *value;
    return absl::OkStatus();
}

template <typename T>
void take(const std::optional<T>& then, std::optional<T>& target) {
    if (then)
        target = then;
}

}  // namespace

absl::StatusOr<Equalizer> tuned(Equalizer settings, const EqualizerTuning& tuning) {
    constexpr const char* kPixels = "whole pixels from 0 to 1000000000, across and up";
    constexpr const char* kShare = "from 0 to 1";
    constexpr const char* kAboveZero = "above 0";
    const Kind kind = settings.kind;
    if (tuning.mode) {
        RETURN_IF_ERROR(checkKind({"mode", {Kind::Load, Kind::Tree}}, kind));
        settings.mode = *tuning.mode;
    }
    RETURN_IF_ERROR(set({"damping", {Kind::Load, Kind::Tree, Kind::Dfr}}, kind, tuning.damping,
                        isShare, kShare, settings.damping));
    RETURN_IF_ERROR(set({"boundary", {Kind::Load, Kind::Tree}}, kind, tuning.boundaryPixels,
                        isPixels, kPixels, settings.boundaryPixels));
    RETURN_IF_ERROR(set({"boundaryRange", {Kind::Load, Kind::Tree}}, kind, tuning.boundaryRange,
                        isShare, kShare, settings.boundaryRange));
    RETURN_IF_ERROR(set({"resistance", {Kind::Load, Kind::Tree}}, kind, tuning.resistancePixels,
                        isPixels, kPixels, settings.resistancePixels));
    RETURN_IF_ERROR(set({"resistanceRange", {Kind::Load, Kind::Tree}}, kind, tuning.resistanceRange,
                        isShare, kShare, settings.resistanceRange));
    RETURN_IF_ERROR(set({"assembleOnlyLimit", {Kind::Load}}, kind, tuning.assembleOnlyLimit,
                        isAboveZero, kAboveZero, settings.assembleOnlyLimit));
    RETURN_IF_ERROR(set({"framerate", {Kind::Dfr}}, kind, tuning.framerate, isAboveZero, kAboveZero,
                        settings.framerate));
    RETURN_IF_ERROR(set({"tileSize", {Kind::Tile}}, kind, tuning.tileSize, isTileSize,
                        "a width and a height of a pixel or more", settings.tileSize));
    if (tuning.tileSize)
        settings.tileChunk.reset();
    RETURN_IF_ERROR(set({"tileChunk", {Kind::Tile}}, kind, tuning.tileChunk, isChunk,
                        "above 0, 1 at most", settings.tileChunk));
    return settings;
}

bool dividesData(const Equalizer& equalizer) {
    return equalizer.kind == EqualizerKind::Tile ? equalizer.tileChunk.has_value()
                                                 : equalizer.mode == SplitMode::Db;
}

EqualizerTuning together(EqualizerTuning first, const EqualizerTuning& then) {
    take(then.isOn, first.isOn);
    take(then.isFrozen, first.isFrozen);
    take(then.mode, first.mode);
    take(then.damping, first.damping);
    take(then.boundaryPixels, first.boundaryPixels);
    take(then.boundaryRange, first.boundaryRange);
    take(then.resistancePixels, first.resistancePixels);
    take(then.resistanceRange, first.resistanceRange);
    take(then.assembleOnlyLimit, first.assembleOnlyLimit);
    take(then.framerate, first.framerate);
    if (then.tileSize)
        first.tileChunk.reset();
    take(then.tileSize, first.tileSize);
    take(then.tileChunk, first.tileChunk);
    return first;
}

}  // namespace eyrie::config
