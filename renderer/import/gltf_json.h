// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// A glTF's JSON, for the sources that look into it.
namespace eyrie::import {

using Json = nlohmann::json;

/// Discarded where it is no JSON. Deeper parts are left out: no glTF has them.
inline Json parsedGltf(std::string_view json) {
    constexpr int kDeepest = 64;
    const auto isNear = [](int depth, Json::parse_event_t, Json&) { return depth < kDeepest; };
    return Json::parse(json, isNear, false);
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
