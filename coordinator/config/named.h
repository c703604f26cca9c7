// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <unordered_map>
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

/// "2" as a position below `count`, written without zeros before it; nothing: it is none.
inline std::optional<std::size_t> positionIn(std::size_t count, std::string_view text) {
    std::size_t position = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, position);
    const bool isPlain = error == std::errc() && stop == end && fmt::format("{}", position) == text;
    return isPlain && position < count ? std::optional(position) : std::nullopt;
}

/// As findNamed; nothing: there is none.
template <typename T>
std::optional<std::size_t> positionNamed(const std::vector<T>& things, std::string_view name) {
    if (name.starts_with('#'))
        if (const auto position = positionIn(things.size(), name.substr(1)))
            return position;
    const auto named = name.empty() ? things.end() : std::ranges::find(things, name, &T::name);
    if (named != things.end())
        return static_cast<std::size_t>(named - things.begin());
    return positionIn(things.size(), name);
}

/// The position of the first that is called `name`, or of that whose position is so written: a name
/// comes before a position, so that what is called "1" is found by it; "#1" is always a position.
/// NotFound, with the names that there are; `what` says of what kind.
template <typename T>
absl::StatusOr<std::size_t> findNamed(const std::vector<T>& things, std::string_view what,
                                      std::string_view name) {
    if (const auto position = positionNamed(things, name))
        return *position;
    return absl::NotFoundError(
        fmt::format("no {} is called \"{}\"; there are {}", what, name, namesOf(things)));
}

/// What findNamed finds a thing by: its name, where that leads to it; else its position.
template <typename T>
std::string called(const std::vector<T>& things, std::size_t index) {
    for (const std::string& name : {things[index].name, fmt::format("{}", index)})
        if (positionNamed(things, name) == index)
            return name;
    return positionName(index);
}

/// All of them, of which there may be thousands.
template <typename T>
std::vector<std::string> allCalled(const std::vector<T>& things) {
    std::unordered_map<std::string_view, std::size_t> first;
    for (std::size_t i = 0; i < things.size(); ++i) first.try_emplace(things[i].name, i);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < things.size(); ++i) {
        const std::string& name = things[i].name;
        const std::string position = fmt::format("{}", i);
        if (name.starts_with('#'))
            names.push_back(called(things, i));
        else if (!name.empty() && first.at(name) == i)
            names.push_back(name);
        else
            names.push_back(first.contains(position) ? positionName(i) : position);
    }
    return names;
}

}  // namespace eyrie::config
