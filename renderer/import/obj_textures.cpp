// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/obj_textures.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "renderer/import/mended_text.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kBlank = " \t";

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
    return text.substr(0, text.find_last_not_of(kBlank) + 1);
}

/// Takes a word from the front of `text`, which has no blanks at its ends.
std::string_view takeWord(std::string_view& text) {
    const std::string_view word = text.substr(0, text.find_first_of(kBlank));
    text = trimmed(text.substr(word.size()));
    return word;
}

/// Takes a line from the front of `text`.
std::string_view takeLine(std::string_view& text) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return trimmed(line);
}

/// Takes up to three numbers from the front of `text`, but not its last word, which is a name.
/// The first two go to `numbers`, as far as they are there.
void takeNumbers(std::string_view& text, glm::vec2& numbers) {
    for (int i = 0; i < 3; ++i) {
        std::string_view rest = text;
        const std::string_view word = takeWord(rest);
        float number = 0;
        const auto parsed = std::from_chars(word.data(), word.data() + word.size(), number);
        if (rest.empty() || parsed.ec != std::errc() || parsed.ptr != word.data() + word.size())
            return;
        if (i < 2)
            numbers[i] = number;
        text = rest;
    }
}

/// Takes `word` from the front of `text`, or nothing.
bool takeWordIf(std::string_view& text, std::string_view word) {
    std::string_view rest = text;
    if (takeWord(rest) != word)
        return false;
    text = rest;
    return true;
}

bool isNumber(std::string_view word) {
    float number = 0;
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), number);
    return parsed.ec == std::errc() && parsed.ptr == word.data() + word.size();
}

bool isInAnyCase(std::string_view word, std::string_view lowerCase) {
    return std::ranges::equal(word, lowerCase, {},
                              [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
}

/// In whatever case, as Assimp takes it.
bool isMapKd(std::string_view keyword) { return isInAnyCase(keyword, "map_kd"); }

bool endsLibrary(std::string_view word) {
    constexpr std::string_view kEnding = ".mtl";
    return word.size() > kEnding.size() &&
           isInAnyCase(word.substr(word.size() - kEnding.size()), kEnding);
}

/// Of a colour that is given otherwise than by red, green and blue.
bool isOfOtherKind(std::string_view colour) {
    return takeWordIf(colour, "xyz") || takeWordIf(colour, "spectral");
}

struct Option {
    std::string_view name;
    int words;
};
/// Those that are passed over, with the words that follow them.
constexpr std::array kOptions = {
    Option{"-blendu", 1}, Option{"-blendv", 1}, Option{"-bm", 1},      Option{"-boost", 1},
    Option{"-cc", 1},     Option{"-clamp", 1},  Option{"-imfchan", 1}, Option{"-mm", 2},
    Option{"-texres", 1}, Option{"-type", 1},
};

}  // namespace

ObjTexture parseMapKd(std::string_view arguments) {
    ObjTexture texture;
    std::string_view rest = trimmed(arguments);
    while (rest.starts_with('-')) {
        std::string_view after = rest;
        const std::string_view name = takeWord(after);
        glm::vec2 ignored{0};
        const auto* const option = std::ranges::find(kOptions, name, &Option::name);
        if (name == "-s" || name == "-o" || name == "-t")
            takeNumbers(after, name == "-s"   ? texture.scale
                               : name == "-o" ? texture.offset
                                              : ignored);
        else if (option == kOptions.end())
            break;  // a name that begins so
        else
            for (int i = 0; i < option->words; ++i) takeWord(after);
        rest = after;
    }
    texture.name = rest;
    return texture;
}

std::vector<std::string> texturesOfMtl(std::string_view mtl) {
    std::vector<std::string> names;
    while (!mtl.empty()) {
        std::string_view line = takeLine(mtl);
        if (isMapKd(takeWord(line)))
            names.push_back(parseMapKd(line).name);
    }
    std::ranges::sort(names);
    const auto again = std::ranges::unique(names);
    names.erase(again.begin(), again.end());
    return names;
}

std::vector<std::string> namesOfLibraries(std::string_view arguments) {
    std::vector<std::string> names;
    std::string_view name = trimmed(arguments);
    for (std::string_view rest = name; !rest.empty();) {
        const std::string_view word = takeWord(rest);
        if (!rest.empty() && !endsLibrary(word))
            continue;
        names.emplace_back(name.data(), word.data() + word.size());
        name = rest;
    }
    return names;
}

std::vector<std::string> librariesOfObj(std::string_view obj) {
    constexpr std::string_view kLibrary = "mtllib";
    std::vector<std::string> names;
    for (std::size_t at = obj.find(kLibrary); at != std::string_view::npos;) {
        const std::size_t line = obj.find_last_of("\r\n", at) + 1;
        std::string_view rest = obj.substr(at + kLibrary.size());
        const std::string_view libraries = takeLine(rest);
        if (obj.substr(line, at - line).find('#') == std::string_view::npos)  // no comment
            std::ranges::move(namesOfLibraries(libraries), std::back_inserter(names));
        at = obj.find(kLibrary, obj.size() - rest.size());
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::string_view fromFirstMaterial(std::string_view mtl) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (mtl.starts_with(kByteOrderMark))
        mtl.remove_prefix(kByteOrderMark.size());
    while (!mtl.empty()) {
        std::string_view rest = mtl;
        std::string_view line = takeLine(rest);
        if (takeWord(line) == "newmtl" && !line.empty())
            return mtl.substr(mtl.find_first_not_of(kBlank));
        mtl = rest;
    }
    return mtl;
}

std::string mtlForAssimp(std::string_view mtl) {
    constexpr std::array<std::string_view, 6> kColours = {"Kd", "kd", "Ka", "Ks", "Ke", "Tf"};
    constexpr std::string_view kHalo = "-halo";
    const std::string_view whole = fromFirstMaterial(mtl);
    MendedText mended(whole);
    for (std::string_view left = whole; !left.empty();) {
        std::string_view rest = takeLine(left);
        rest = trimmed(rest.substr(0, rest.find('#')));
        const std::string_view keyword = takeWord(rest);
        const auto at = static_cast<std::size_t>(rest.data() - whole.data());
        const bool isColour = std::ranges::count(kColours, keyword) > 0;
        if (isColour && isNumber(rest))
            mended.replace(at + rest.size(), 0, fmt::format(" {} {}", rest, rest));
        if (isColour && isOfOtherKind(rest)) {
            const auto begin = static_cast<std::size_t>(keyword.data() - whole.data());
            mended.replace(begin, at + rest.size() - begin, "");
        }
        while (keyword == "d" && takeWordIf(rest, kHalo)) {
        }
        if (const auto end = static_cast<std::size_t>(rest.data() - whole.data()); end > at)
            mended.replace(at, end - at, "");
    }
    return mended.finish().value_or(std::string(whole));
}

std::map<std::string, ObjMaterial> objMaterialsOf(std::string_view mtl) {
    std::map<std::string, ObjMaterial> materials;
    ObjMaterial* material = nullptr;  // which the first line makes
    mtl = fromFirstMaterial(mtl);
    while (!mtl.empty()) {
        std::string_view line = takeLine(mtl);
        const std::string_view keyword = takeWord(line);
        if (keyword == "newmtl")
            material = &materials[std::string(line)];
        else if (keyword == "Kd" || keyword == "kd")
            (isOfOtherKind(line) ? material->hasOtherColour : material->hasColour) = true;
        else if (isMapKd(keyword))
            material->texture = parseMapKd(line);
    }
    return materials;
}

}  // namespace eyrie::import
