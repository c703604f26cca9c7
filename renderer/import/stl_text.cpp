// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/stl_text.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace eyrie::import {
namespace {

constexpr std::string_view kBlank = " \t\r\n\v\f";
constexpr std::string_view kSolid = "solid";

char lowered(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }
bool isCapital(char c) { return c >= 'A' && c <= 'Z'; }
bool isLetter(char c) { return lowered(c) >= 'a' && lowered(c) <= 'z'; }

std::string_view fromFirstWord(std::string_view stl) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (stl.starts_with(kByteOrderMark))
        stl.remove_prefix(kByteOrderMark.size());
    return stl.substr(std::min(stl.find_first_not_of(kBlank), stl.size()));
}

/// Whether a word has a capital letter, but for the names of solids. That of an exponent is none.
bool hasCapitals(std::string_view stl) {
    while (!stl.empty()) {
        std::string_view line = stl.substr(0, stl.find_first_of("\r\n"));
        stl.remove_prefix(std::min(line.size() + 1, stl.size()));
        line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
        if (line.starts_with(kSolid) || line.starts_with("endsolid"))
            continue;
        const auto areOfAWord = [](char a, char b) {
            return isLetter(a) && isLetter(b) && (isCapital(a) || isCapital(b));
        };
        if (std::ranges::adjacent_find(line, areOfAWord) != line.end())
            return true;
    }
    return false;
}

}  // namespace

bool isStlText(std::string_view stl) {
    constexpr std::size_t kBinaryHeader = 84, kBinaryFacet = 50;
    if (stl.size() > kBinaryHeader) {
        std::uint32_t facets = 0;
        std::memcpy(&facets, stl.data() + kBinaryHeader - sizeof facets, sizeof facets);
        if (stl.size() == kBinaryHeader + kBinaryFacet * facets)
            return false;
    }
    const std::string_view text = fromFirstWord(stl);
    return std::ranges::equal(text.substr(0, kSolid.size()), kSolid, {}, lowered) &&
           stl.substr(0, kBinaryHeader).find('\0') == std::string_view::npos;
}

std::optional<std::string> stlTextForAssimp(std::string_view stl) {
    if (!isStlText(stl))
        return std::nullopt;
    const std::string_view whole = fromFirstWord(stl);
    const bool isInCapitals = hasCapitals(whole);
    if (whole.size() == stl.size() && !isInCapitals)
        return std::nullopt;
    std::string text(whole);
    if (isInCapitals)
        std::ranges::transform(text, text.begin(), lowered);
    return text;
}

}  // namespace eyrie::import
