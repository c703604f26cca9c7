// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "access/printable.h"
#include "fabric/utf8.h"

/// A glTF's JSON, for the sources that look into it.
namespace eyrie::import {

using Json = nlohmann::json;

/// Discarded where it is no JSON. Deeper parts are left out: no glTF has them. Bytes
/// that are no UTF-8, as of names in Latin-1, are written as URIs do, with percents: so files are
/// found by them.
inline Json parsedGltf(std::string_view json) {
    constexpr int kDeepest = 64;
    const auto isNear = [](int depth, Json::parse_event_t, Json&) { return depth < kDeepest; };
    if (access::isUtf8(json))
        return Json::parse(json, isNear, false);
    std::string mended;
    while (!json.empty()) {
        const std::size_t length = fabric::utf8Length(json);
        if (length == 0)
            mended += fmt::format("%{:02X}", static_cast<unsigned char>(json.front()));
        else
            mended += json.substr(0, length);
        json.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return Json::parse(mended, isNear, false);
}

/// The value of `key` in an object; null where there is none.
inline const Json& at(const Json& object, const char* key) {
    static const Json kNothing;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && found != object.end() ? *found : kNothing;
}

inline std::string textAt(const Json& object, const char* key) {
    const Json& value = at(object, key);
    return value.is_string() ? value.get<std::string>() : std::string();
}

}  // namespace eyrie::import
