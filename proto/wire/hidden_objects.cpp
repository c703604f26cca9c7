// SPDX-License-Identifier: Apache-2.0
#include "wire/hidden_objects.h"

#include <algorithm>

#include <fmt/format.h>

namespace eyrie::wire {

void setHidden(const fabric::HiddenObjects& hidden,
               google::protobuf::RepeatedField<std::int32_t>& numbers) {
    numbers.Add(hidden.positions.begin(), hidden.positions.end());
}

absl::StatusOr<fabric::HiddenObjects> hiddenObjects(
    const google::protobuf::RepeatedField<std::int32_t>& numbers, std::string_view field) {
    if (numbers.size() > fabric::kMaxHiddenObjects)
        return absl::InvalidArgumentError(fmt::format("{} has {} objects; at most {} are allowed",
                                                      field, numbers.size(),
                                                      fabric::kMaxHiddenObjects));
    fabric::HiddenObjects hidden{{numbers.begin(), numbers.end()}};
    std::ranges::sort(hidden.positions);
    hidden.positions.erase(std::unique(hidden.positions.begin(), hidden.positions.end()),
                           hidden.positions.end());
    if (!hidden.positions.empty() && hidden.positions.front() < 0)
        return absl::InvalidArgumentError(fmt::format("{} has object {}; positions count from 0",
                                                      field, hidden.positions.front()));
    return hidden;
}

}  // namespace eyrie::wire
