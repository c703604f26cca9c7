// SPDX-License-Identifier: Apache-2.0
#include "service/data_places.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <system_error>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "renderer/page/remote_name.h"

namespace eyrie::service {
namespace {

/// Whether `path` is `folder` or lies beneath it, and not beside it.
bool isIn(std::string_view path, std::string_view folder) {
    return path.starts_with(folder) &&
           (path.size() == folder.size() || folder.ends_with('/') || path[folder.size()] == '/');
}

/// Of a file of another machine: the longest end of its path that lies in `folder`.
std::optional<std::string> foundIn(const std::filesystem::path& folder, std::string_view path) {
    if (folder.empty() || page::isVirtual(path))
        return std::nullopt;
    const std::string normal = std::filesystem::path(path).lexically_normal().string();
    for (std::size_t slash = normal.find('/'); slash != std::string::npos;
         slash = normal.find('/', slash + 1)) {
        std::filesystem::path place = folder / normal.substr(slash + 1);
        std::error_code error;
        if (std::filesystem::is_regular_file(place, error))
            return std::move(place).string();
    }
    return std::nullopt;
}

}  // namespace

absl::StatusOr<DataPlaces> DataPlaces::parse(std::span<const std::string> rules) {
    DataPlaces places;
    for (const std::string& rule : rules) {
        const std::size_t equals = rule.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == rule.size())
            return absl::InvalidArgumentError(fmt::format(
                "\"{}\": expected FROM=TO: what scenes name, and where this machine has it, such "
                "as /data=/mnt/fast/data",
                rule));
        Rule next{rule.substr(0, equals), rule.substr(equals + 1)};
        if (std::ranges::find(places.rules_, next.from, &Rule::from) != places.rules_.end())
            return absl::InvalidArgumentError(
                fmt::format("\"{}\": {} has a place already; name one", rule, next.from));
        places.rules_.push_back(std::move(next));
    }
    std::ranges::stable_sort(places.rules_, std::greater<>(),
                             [](const Rule& rule) { return rule.from.size(); });
    return places;
}

absl::Status DataPlaces::lookIn(std::filesystem::path folder) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        return absl::InvalidArgumentError(fmt::format(
            "{}: is no folder; name the one that has the scenes' files", folder.string()));
    folder_ = std::move(folder);
    return absl::OkStatus();
}

std::string DataPlaces::placed(std::string_view path) const {
    const auto rule =
        std::ranges::find_if(rules_, [&](const Rule& one) { return isIn(path, one.from); });
    if (rule != rules_.end())
        return rule->to + std::string(path.substr(rule->from.size()));
    return foundIn(folder_, path).value_or(std::string(path));
}

}  // namespace eyrie::service
