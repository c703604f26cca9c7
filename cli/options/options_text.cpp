// SPDX-License-Identifier: Apache-2.0
#include "cli/options/options_text.h"

#include <cctype>
#include <sstream>
#include <string>

#include <absl/status/status.h>
#include <absl/strings/ascii.h>
#include <fmt/format.h>

namespace eyrie::cli {
namespace {

/// Quotes stand around a value: an apostrophe within a word is none.
std::string_view beforeComment(std::string_view line) {
    char quote = 0, before = ' ';
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        const bool begins = std::isspace(static_cast<unsigned char>(before)) != 0 ||
                            before == '=' || before == '[' || before == ',';
        if (quote != 0)
            quote = c == quote ? 0 : quote;
        else if (c == '#')
            return line.substr(0, i);
        else if (begins && (c == '"' || c == '\''))
            quote = c;
        before = c;
    }
    return line;
}

/// Whether a line can be of no list: `[section]`, or `name = value`.
bool beginsAnew(std::string_view line) {
    if (line.starts_with('['))
        return true;
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos)
        return false;
    std::string name(line.substr(0, equals));
    absl::StripTrailingAsciiWhitespace(&name);
    return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-0123456789") ==
                                std::string_view::npos;
}

bool isOpenList(std::string_view line) {
    const std::size_t equals = line.find('=');
    if (line.starts_with('[') || equals == std::string_view::npos)
        return false;
    std::string value(line.substr(equals + 1));
    absl::StripLeadingAsciiWhitespace(&value);
    return value.starts_with('[') && !value.ends_with(']');
}

absl::Status endless(int line) {
    return absl::InvalidArgumentError(fmt::format(
        "the list that begins in line {} has no end; put a ']' after its last value, or quotes "
        "around a value that is no list",
        line));
}

}  // namespace

absl::StatusOr<std::string> withoutComments(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF"))
        text.remove_prefix(3);
    std::string kept, list;
    int number = 0, listNumber = 0;
    std::istringstream lines{std::string(text)};
    for (std::string whole; std::getline(lines, whole);) {
        ++number;
        std::string line(beforeComment(whole));
        absl::StripAsciiWhitespace(&line);
        if (!list.empty() && beginsAnew(line))
            return endless(listNumber);
        if (list.empty() && !isOpenList(line)) {
            kept.append(line).append("\n");
            continue;
        }
        listNumber = list.empty() ? number : listNumber;
        list += line;
        if (line.ends_with(']')) {
            kept.append(list).append("\n");
            list.clear();
        }
    }
    if (!list.empty())
        return endless(listNumber);
    return kept;
}

}  // namespace eyrie::cli
