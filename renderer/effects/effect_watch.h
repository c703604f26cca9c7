// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <absl/status/statusor.h>

#include "renderer/effects/effect_source.h"

namespace eyrie::effects {

/// The folder that EYRIE_EFFECTS names; none when it is unset or empty. Without one nothing reads
/// effect files at run time.
std::optional<std::filesystem::path> watchedFolder();

/// One effect's files in a folder where people edit them while a renderer draws.
class EffectWatch {
public:
    using Clock = std::chrono::steady_clock;
    /// Time stamps are looked at no more often.
    static constexpr std::chrono::seconds kInterval{1};

    /// `builtIn` outlives the watch.
    EffectWatch(std::filesystem::path folder, const EffectSource& builtIn)
        : folder_(std::move(folder)), builtIn_(builtIn) {}

    /// The effect as the folder has it, when its files changed since the last answer; the first
    /// answer comes at once. Each state of the files is answered once, also when it is an error:
    /// NotFound, or InvalidArgument with file, line and column, for text that is no effect or that
    /// declares other uniforms, inputs, parameters or passes than the program was built with.
    std::optional<absl::StatusOr<EffectSource>> changed(Clock::time_point now);

private:
    struct Stamp {
        std::filesystem::file_time_type time;
        std::uintmax_t bytes = 0;
        bool operator==(const Stamp&) const = default;
    };
    std::optional<Stamp> stampOf(const std::string& name) const;
    absl::StatusOr<EffectSource> load();

    std::filesystem::path folder_;
    const EffectSource& builtIn_;
    std::optional<Clock::time_point> lastLook_;
    std::map<std::string, std::optional<Stamp>> stamps_;  ///< of the files read last
};

/// Logs what became of an edited effect: one line.
void reportReload(const EffectSource& builtIn, const absl::Status& status);

}  // namespace eyrie::effects
