// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/shader_log.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "renderer/effects/language/glsl_writer.h"

namespace eyrie::effects {
namespace {

/// Takes `prefix` off the front of `text` if it is there.
bool take(std::string_view& text, std::string_view prefix) {
    if (!text.starts_with(prefix))
        return false;
    text.remove_prefix(prefix.size());
    return true;
}

std::optional<std::size_t> takeNumber(std::string_view& text) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc())
        return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// "FILE:LINE: message" of one line, if it begins with a place.
std::optional<std::string> named(std::string_view line, std::span<const std::string> files) {
    const std::string_view kind = take(line, "ERROR: ")     ? "error: "
                                  : take(line, "WARNING: ") ? "warning: "
                                                            : "";
    if (!takeNumber(line))
        return std::nullopt;
    const bool bracketed = take(line, "(");
    if (!bracketed && !take(line, ":"))
        return std::nullopt;
    const auto number = takeNumber(line);
    if (!number || *number / kLinesPerFile >= files.size() || (bracketed && !take(line, ")")))
        return std::nullopt;
    std::string column;
    if (std::string_view rest = line; take(rest, "("))
        if (const auto at = takeNumber(rest); at && take(rest, ")")) {
            column = fmt::format(":{}", *at);
            line = rest;
        }
    while (take(line, " ") || take(line, ":")) {
    }
    return fmt::format("{}:{}{}: {}{}", files[*number / kLinesPerFile], *number % kLinesPerFile,
                       column, kind, line);
}

}  // namespace

std::string namedLog(std::string_view log, std::span<const std::string> files) {
    std::string text;
    while (!log.empty()) {
        const std::string_view line = log.substr(0, log.find('\n'));
        log.remove_prefix(std::min(line.size() + 1, log.size()));
        if (line.empty() || line[0] == '\0')
            continue;
        text += named(line, files).value_or(std::string(line));
        text += '\n';
    }
    while (text.ends_with('\n')) text.pop_back();
    return text;
}

}  // namespace eyrie::effects
