// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/gltf_places.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "renderer/import/gltf_json.h"

namespace eyrie::import {
namespace {

/// Which accessors are texture coordinates.
std::set<std::size_t> placesIn(std::string_view json) {
    constexpr std::string_view kKey = "\"TEXCOORD_";
    std::set<std::size_t> accessors;
    for (std::size_t at = json.find(kKey); at != std::string_view::npos;
         at = json.find(kKey, at + 1)) {
        const std::size_t end = json.find('"', at + kKey.size());
        if (end == std::string_view::npos)
            break;
        if (const auto accessor = numberAfter(json.substr(at), json.substr(at, end + 1 - at)))
            accessors.insert(*accessor);
    }
    return accessors;
}

}  // namespace

bool hasWholeTexturePlaces(std::string_view json) {
    constexpr std::size_t kFloat = 5126;
    const std::set<std::size_t> places = placesIn(json);
    if (places.empty())
        return false;
    const std::vector<std::string_view> accessors =
        objectsAt(json, "\"accessors\"", *places.rbegin() + 1);
    return std::ranges::any_of(places, [&](std::size_t place) {
        return place < accessors.size() &&
               numberAfter(accessors[place], "\"componentType\"").value_or(kFloat) != kFloat;
    });
}

}  // namespace eyrie::import
