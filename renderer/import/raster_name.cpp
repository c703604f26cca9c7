// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/raster_name.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMarks = ":\"";

bool exists(const std::string& path) {
    std::error_code none;
    return fs::exists(path, none);
}

/// Where in a name the path of its file is.
struct Place {
    std::size_t begin = 0;
    std::size_t size = 0;  ///< 0: no file that is there
};

/// Of pieces that happen to be files the longest: a table may be called as some file is.
Place placeOfPath(const std::string& name) {
    if (exists(name) || name.find_first_of(kMarks) == std::string::npos)
        return {0, name.size()};
    Place place;
    for (std::size_t begin = 0; begin < name.size();) {
        const std::size_t end = std::min(name.find_first_of(kMarks, begin), name.size());
        if (end - begin > place.size && exists(name.substr(begin, end - begin)))
            place = {begin, end - begin};
        begin = end + 1;
    }
    return place;
}

}  // namespace

bool isThere(const std::string& name) {
    const Place place = placeOfPath(name);
    return exists(name.substr(place.begin, place.size));
}

std::string absoluteName(const std::string& name) {
    const Place place = placeOfPath(name);
    if (place.size == 0)
        return name;
    const fs::path path = name.substr(place.begin, place.size);
    return std::string(name).replace(place.begin, place.size,
                                     fs::absolute(path).lexically_normal().string());
}

std::string partOfFile(const std::string& name) {
    const Place place = placeOfPath(name);
    return std::string(name).erase(place.begin, place.size);
}

}  // namespace eyrie::import
