// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/obj_text.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "renderer/import/mended_text.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kBlank = " \t";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

/// Whether a line without blanks at its begin has numbers after its keyword, not names, which may
/// have any marks.
bool hasNumbers(std::string_view line) {
    constexpr std::array<std::string_view, 8> kKeywords = {"v", "vn", "vt", "vp",
                                                           "f", "fo", "l",  "p"};
    return std::ranges::count(kKeywords, line.substr(0, line.find_first_of(kBlank))) > 0;
}

/// What begins otherwise goes on with the line before it, or says nothing.
bool hasKeyword(std::string_view line) { return !line.empty() && line[0] >= 'a' && line[0] <= 'z'; }

/// Of the line that begins at `first`.
void mendNumbers(std::string_view line, std::size_t first, MendedText& mended) {
    const std::size_t comment = std::min(line.find('#'), line.size());
    const std::string_view numbers = line.substr(0, comment);
    for (std::size_t at = numbers.find('.'); at != std::string_view::npos;
         at = numbers.find('.', at + 1))
        if (at > 0 && kBlank.find(numbers[at - 1]) != std::string_view::npos)
            mended.replace(first + at, 0, "0");
    if (comment < line.size())
        mended.replace(first + comment, line.size() - comment, "");
}

void mendLine(std::string_view line, std::size_t first, MendedText& mended) {
    const std::size_t indent = std::min(line.find_first_not_of(kBlank), line.size());
    line.remove_prefix(indent);
    if (indent > 0 && hasKeyword(line))
        mended.replace(first, indent, "");
    if (hasNumbers(line))
        mendNumbers(line, first + indent, mended);
}

}  // namespace

std::optional<std::string> objForAssimp(std::string_view obj) {
    MendedText mended(obj);
    std::size_t at = 0;
    while (obj.substr(at).starts_with(kByteOrderMark)) {
        mended.replace(at, kByteOrderMark.size(), "");
        at += kByteOrderMark.size();
    }
    while (at < obj.size()) {
        const std::size_t end = std::min(obj.find_first_of("\r\n", at), obj.size());
        mendLine(obj.substr(at, end - at), at, mended);
        at = end + 1;
    }
    return mended.finish();
}

}  // namespace eyrie::import
