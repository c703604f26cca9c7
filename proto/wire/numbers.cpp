// SPDX-License-Identifier: Apache-2.0
#include "wire/numbers.h"

#include <cmath>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::wire {

absl::Status checkNumbers(const Numbers& numbers, int count, std::string_view field) {
    if (numbers.size() != count)
        return absl::InvalidArgumentError(
            fmt::format("{} has {} numbers; it must have {}", field, numbers.size(), count));
    for (int i = 0; i < count; ++i)
        if (!std::isfinite(numbers[i]))
            return absl::InvalidArgumentError(
                fmt::format("{}[{}] is {}; it must be finite", field, i, numbers[i]));
    return absl::OkStatus();
}

absl::StatusOr<fabric::Vec3> threeNumbers(const Numbers& numbers, std::string_view field) {
    RETURN_IF_ERROR(checkNumbers(numbers, 3, field));
    return fabric::Vec3(numbers[0], numbers[1], numbers[2]);
}

absl::StatusOr<fabric::Vec3> threeNumbersOr(const Numbers& numbers, const fabric::Vec3& absent,
                                            std::string_view field) {
    if (numbers.empty())
        return absent;
    return threeNumbers(numbers, field);
}

absl::StatusOr<fabric::Vec3> colourFrom(const Numbers& numbers, std::string_view field) {
    ASSIGN_OR_RETURN(const fabric::Vec3 colour, threeNumbers(numbers, field));
    for (int i = 0; i < 3; ++i)
        if (!(colour[i] >= 0 && colour[i] <= 1))
            return absl::InvalidArgumentError(
                fmt::format("{}[{}] is {}; it must be from 0 to 1 (sRGB)", field, i, colour[i]));
    return colour;
}

void setNumbers(const fabric::Vec3& value, Numbers& numbers) {
    numbers.Clear();
    for (int i = 0; i < 3; ++i) numbers.Add(value[i]);
}

}  // namespace eyrie::wire
