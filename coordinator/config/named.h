// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>
#include <fmt/format.h>

namespace eyrie::config {

/// "left", "1", "right": names, positions where there are none.
template <typename T>
std::string namesOf(const std::vector<T>& things) {
    std::string names;
    for (std::size_t i = 0; i < things.size(); ++i)
        names += fmt::format("{}\"{}\"", i == 0 ? "" : ", ",
                             things[i].name.empty() ? fmt::format("{}", i) : things[i].name);
    return names.empty() ? "none" : names;
}

/// "#2": the position 2, whatever is called so.
inline std::string positionName(std::size_t index) { return fmt::format("#{}", index); }

/// The position of the first that is called `name`, or of that whose position is so written: a name
/// comes before a position, so that what is called "1" is found by it; "#1" is always a position.
/// NotFound, with the names that there are; `what` says of what kind.
template <typename T>
absl::StatusOr<std::size_t> findNamed(const std::vector<T>& things, std::string_view what,
                                      std::string_view name) {
    for (std::size_t i = 0; i < things.size(); ++i)
        if (name == positionName(i))
            return i;
    const auto named = name.empty() ? things.end() : std::ranges::find(things, name, &T::name);
    if (named != things.end())
        return static_cast<std::size_t>(named - things.begin());
    for (std::size_t i = 0; i < things.size(); ++i)
        if (fmt::format("{}", i) == name)
            return i;
    return absl::NotFoundError(
        fmt::format("no {} is called \"{}\"; there are {}", what, name, namesOf(things)));
}

/// What findNamed finds a thing by: its name, where that leads to it; else its position.
template <typename T>
std::string called(const std::vector<T>& things, std::size_t index) {
    for (const std::string& name : {things[index].name, fmt::format("{}", index)}) {
        const absl::StatusOr<std::size_t> found = findNamed(things, "", name);
        if (found.ok() && *found == index)
            return name;
    }
    return positionName(index);
}

}  // namespace eyrie::config
