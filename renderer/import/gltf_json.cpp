// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/gltf_json.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <system_error>

namespace eyrie::import {
namespace {

std::string_view afterSpace(std::string_view text) {
    return text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
}

}  // namespace

std::string_view gltfJsonOf(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::size_t kLengthAt = 12;
    constexpr std::size_t kJsonAt = 20;
    if (!text.starts_with("glTF") || text.size() < kJsonAt)
        return text;
    std::uint32_t length = 0;
    std::memcpy(&length, text.data() + kLengthAt, sizeof length);
    return text.substr(kJsonAt, length);
}

bool take(std::string_view& text, char mark) {
    const std::string_view rest = afterSpace(text);
    if (!rest.starts_with(mark))
        return false;
    text = rest.substr(1);
    return true;
}

std::vector<std::string_view> objectsAt(std::string_view json, std::string_view key,
                                        std::size_t most) {
    std::vector<std::string_view> objects;
    std::string_view rest = json.substr(std::min(json.find(key), json.size()));
    rest.remove_prefix(std::min(key.size(), rest.size()));
    if (!take(rest, ':') || !take(rest, '['))
        return objects;
    std::size_t depth = 0, begin = 0;
    bool isText = false;
    for (std::size_t i = 0; i < rest.size() && objects.size() < most; ++i) {
        const char c = rest[i];
        if (isText && c == '\\') {
            ++i;
            continue;
        }
        if (c == '"')
            isText = !isText;
        if (isText)
            continue;
        if (c == '{' && depth++ == 0)
            begin = i;
        if (c == ']' && depth == 0)
            break;
        if (c == '}' && depth != 0 && --depth == 0)
            objects.push_back(rest.substr(begin, i + 1 - begin));
    }
    return objects;
}

std::optional<std::size_t> numberAfter(std::string_view json, std::string_view key) {
    const std::size_t at = json.find(key);
    if (at == std::string_view::npos)
        return std::nullopt;
    std::string_view rest = json.substr(at + key.size());
    if (!take(rest, ':'))
        return std::nullopt;
    rest = afterSpace(rest);
    std::size_t number = 0;
    const auto parsed = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    return parsed.ec == std::errc() ? std::optional(number) : std::nullopt;
}

}  // namespace eyrie::import
