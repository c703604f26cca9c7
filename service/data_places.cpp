// SPDX-License-Identifier: Apache-2.0
#include "service/data_places.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>

namespace eyrie::service {
namespace {

/// Whether `path` is `folder` or lies beneath it, and not beside it.
bool isIn(std::string_view path, std::string_view folder) {
    return path.starts_with(folder) &&
           (path.size() == folder.size() || folder.ends_with('/') || path[folder.size()] == '/');
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

std::string DataPlaces::placed(std::string_view path) const {
    const auto rule =
        std::ranges::find_if(rules_, [&](const Rule& one) { return isIn(path, one.from); });
    return rule == rules_.end() ? std::string(path)
                                : rule->to + std::string(path.substr(rule->from.size()));
}

}  // namespace eyrie::service
