// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/effect_loader.h"

#include <fstream>
#include <set>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/effects/language/effect_check.h"
#include "renderer/effects/language/effect_grammar.h"

namespace eyrie::effects {
namespace {

constexpr std::size_t kMaxIncludes = 16;

absl::StatusOr<EffectFile> loadFile(std::string_view name, const ReadEffectFile& read) {
    if (!isEffectFileName(name))
        return absl::InvalidArgumentError(fmt::format(
            "{}: an effect file is called lower_case.effect or lower_case.block", name));
    ASSIGN_OR_RETURN(const std::string text, read(name));
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // some editors begin files so
    std::string_view words = text;
    if (words.starts_with(kByteOrderMark))
        words.remove_prefix(kByteOrderMark.size());
    return parseEffectFile(words, name);
}

absl::Status checkInclude(const Include& include, std::set<std::string>& seen) {
    const auto error = [&](std::string_view message) {
        return absl::InvalidArgumentError(messageAt(include.place, message));
    };
    if (!isEffectFileName(include.file) || !include.file.ends_with(".block"))
        return error(
            fmt::format("\"{}\" is no block; blocks are called lower_case.block", include.file));
    if (!seen.insert(include.file).second)
        return error(fmt::format("\"{}\" is included twice", include.file));
    if (seen.size() > kMaxIncludes)
        return error(fmt::format("an effect includes at most {} blocks", kMaxIncludes));
    return absl::OkStatus();
}

}  // namespace

ReadEffectFile effectFolder(std::filesystem::path folder) {
    return [folder = std::move(folder)](std::string_view name) -> absl::StatusOr<std::string> {
        const std::string path = (folder / name).string();
        std::ifstream file(path, std::ios::binary);
        if (!file)
            return absl::NotFoundError(fmt::format("{}: cannot be opened", path));
        std::string text(kMaxEffectBytes + 1, '\0');
        file.read(text.data(), static_cast<std::streamsize>(text.size()));
        if (file.bad())
            return absl::NotFoundError(fmt::format("{}: cannot be read", path));
        text.resize(static_cast<std::size_t>(file.gcount()));
        return text;
    };
}

absl::StatusOr<EffectFile> loadBlock(std::string_view name, const ReadEffectFile& read) {
    ASSIGN_OR_RETURN(EffectFile block, loadFile(name, read));
    RETURN_IF_ERROR(checkBlock(block));
    return block;
}

absl::StatusOr<Effect> loadEffect(std::string_view name, const ReadEffectFile& read) {
    ASSIGN_OR_RETURN(EffectFile main, loadFile(name, read));
    Effect effect;
    std::set<std::string> seen;
    for (const Include& include : main.includes) {
        RETURN_IF_ERROR(checkInclude(include, seen));
        absl::StatusOr<EffectFile> block = loadFile(include.file, read);
        if (!block.ok() && block.status().code() == absl::StatusCode::kNotFound)
            return fabric::withContext(block.status(), messageAt(include.place, "include"));
        if (!block.ok())
            return block.status();
        effect.files.push_back(*std::move(block));
    }
    effect.files.push_back(std::move(main));
    RETURN_IF_ERROR(checkEffect(effect));
    return effect;
}

}  // namespace eyrie::effects
