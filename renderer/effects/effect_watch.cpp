// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/effect_watch.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "fabric/log.h"
#include "fabric/status.h"
#include "renderer/effects/language/effect_loader.h"
#include "renderer/effects/language/glsl_writer.h"

namespace eyrie::effects {
namespace {

template <typename Declarations>
auto findName(const Declarations& list, const std::string& name) {
    return std::find_if(list.begin(), list.end(), [&](const auto& d) { return d.name == name; });
}

/// The declarations are compiled into C++: GLSL alone may change while it runs.
absl::Status checkUnchanged(const EffectSource& builtIn, const std::vector<Declaration>& edited) {
    for (const Declaration& now : edited) {
        const auto built = findName(builtIn.declarations, now.name);
        if (built == builtIn.declarations.end())
            return absl::InvalidArgumentError(messageAt(
                now.place, fmt::format("'{}' is new and nothing sets it; build Eyrie anew to use "
                                       "it",
                                       now.text)));
        if (built->text != now.text)
            return absl::InvalidArgumentError(
                messageAt(now.place, fmt::format("'{}' was built as '{}'; put it back, or build "
                                                 "Eyrie anew",
                                                 now.text, built->text)));
    }
    for (const BuiltDeclaration& built : builtIn.declarations)
        if (findName(edited, built.name) == edited.end())
            return absl::InvalidArgumentError(
                fmt::format("{}: '{}' is missing, and Eyrie was built to set it; put it back, or "
                            "build Eyrie anew",
                            builtIn.name, built.text));
    return absl::OkStatus();
}

}  // namespace

std::optional<std::filesystem::path> watchedFolder() {
    const char* folder = std::getenv("EYRIE_EFFECTS");
    if (folder == nullptr || *folder == '\0')
        return std::nullopt;
    return folder;
}

std::optional<EffectWatch::Stamp> EffectWatch::stampOf(const std::string& name) const {
    std::error_code error;
    Stamp stamp;
    stamp.time = std::filesystem::last_write_time(folder_ / name, error);
    if (!error)
        stamp.bytes = std::filesystem::file_size(folder_ / name, error);
    if (error)
        return std::nullopt;
    return stamp;
}

std::optional<absl::StatusOr<EffectSource>> EffectWatch::changed(Clock::time_point now) {
    if (lastLook_ && now - *lastLook_ < kInterval)
        return std::nullopt;
    const bool isFirst = !lastLook_;
    lastLook_ = now;
    const auto isSame = [&](const auto& known) { return stampOf(known.first) == known.second; };
    if (!isFirst && std::all_of(stamps_.begin(), stamps_.end(), isSame))
        return std::nullopt;
    return load();
}

absl::StatusOr<EffectSource> EffectWatch::load() {
    stamps_.clear();
    const ReadEffectFile read = effectFolder(folder_);
    // Stamped before it is read: an edit that comes between shows at the next look.
    const auto stampAndRead = [&](std::string_view name) {
        stamps_[std::string(name)] = stampOf(std::string(name));
        return read(name);
    };
    ASSIGN_OR_RETURN(const Effect effect, loadEffect(builtIn_.name, stampAndRead));
    RETURN_IF_ERROR(checkUnchanged(builtIn_, declarations(effect)));
    if (effect.has(StageKind::Compute) == builtIn_.compute.empty())
        return absl::InvalidArgumentError(fmt::format(
            "{}: its stages are not those that Eyrie was built with; put them back, or build Eyrie "
            "anew",
            builtIn_.name));
    return EffectSource{builtIn_.name,
                        sourceFiles(effect),
                        builtIn_.declarations,
                        stageText(effect, StageKind::Vertex),
                        stageText(effect, StageKind::Fragment),
                        stageText(effect, StageKind::Compute)};
}

void reportReload(const EffectSource& builtIn, const absl::Status& status) {
    if (status.ok()) {
        spdlog::info("{}: taken from EYRIE_EFFECTS", builtIn.name);
        return;
    }
    const auto message = status.message();
    spdlog::error("EYRIE_EFFECTS: {}\n{} stays as it was",
                  std::string_view(message.data(), message.size()), builtIn.name);
}

}  // namespace eyrie::effects
