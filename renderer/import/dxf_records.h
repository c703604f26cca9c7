// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <span>
#include <string_view>

#include <glm/vec3.hpp>

/// The records of a DXF file's text.
namespace eyrie::import {

/// Without the line's end, and blanks before it.
inline std::string_view dxfLineAt(std::string_view text, std::size_t& at) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = std::min(end + 1, text.size());
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line;
}

template <typename Number>
Number dxfNumberOf(std::string_view text, Number otherwise) {
    if (text.starts_with('+'))
        text.remove_prefix(1);
    std::from_chars(text.data(), text.data() + text.size(), otherwise);
    return otherwise;
}

/// Two lines: the code that says what a value is, and the value.
struct DxfGroup {
    int code;
    std::string_view value;
};

inline DxfGroup dxfGroupAt(std::string_view dxf, std::size_t& at) {
    const int code = dxfNumberOf(dxfLineAt(dxf, at), -1);
    return {code, dxfLineAt(dxf, at)};
}

/// What a group of the code 0 begins: an entity, a block's begin or end, and so on.
struct DxfRecord {
    std::string_view section;
    std::string_view kind;
    std::size_t begin;
    std::string_view text;

    /// Of the last group of that code; empty without one.
    std::string_view value(int code) const {
        std::string_view found;
        for (std::size_t at = 0; at < text.size();)
            if (const DxfGroup group = dxfGroupAt(text, at); group.code == code)
                found = group.value;
        return found;
    }
    double number(int code, double otherwise = 0) const {
        return dxfNumberOf(value(code), otherwise);
    }
    /// That of the codes 10, 20 and 30 is the first.
    glm::dvec3 vector(int code, int step, double otherwise) const {
        return {number(code, otherwise), number(code + step, otherwise),
                number(code + 2 * step, otherwise)};
    }
};

/// The sections that have something to draw.
inline constexpr std::array<std::string_view, 2> kDxfDrawn = {"BLOCKS", "ENTITIES"};

/// Calls `use` with the records of these sections.
template <typename Use>
void forEachDxfRecord(std::string_view dxf, std::span<const std::string_view> sections,
                      const Use& use) {
    DxfRecord record{};
    const auto finish = [&](std::size_t end) {
        record.text = dxf.substr(record.begin, end - record.begin);
        if (record.kind == "SECTION")
            record.section = record.value(2);
        else if (record.kind == "ENDSEC")
            record.section = {};
        else if (std::ranges::count(sections, record.section) > 0)
            use(record);
    };
    for (std::size_t at = 0; at < dxf.size();) {
        const std::size_t begin = at;
        const DxfGroup group = dxfGroupAt(dxf, at);
        if (group.code != 0)
            continue;
        finish(begin);
        record.kind = group.value;
        record.begin = begin;
    }
    finish(dxf.size());
}

}  // namespace eyrie::import
