// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/statusor.h>
#include <google/protobuf/repeated_field.h>

#include "fabric/vec.h"

/// Arrays of numbers in messages. For the sources of this folder only: it shows protobuf.
namespace eyrie::wire {

using Numbers = google::protobuf::RepeatedField<double>;

/// InvalidArgument, naming `field`, unless there are exactly `count` finite numbers.
absl::Status checkNumbers(const Numbers& numbers, int count, std::string_view field);

/// Three finite numbers.
absl::StatusOr<fabric::Vec3> threeNumbers(const Numbers& numbers, std::string_view field);

/// Three finite numbers, or `absent` where there are none.
absl::StatusOr<fabric::Vec3> threeNumbersOr(const Numbers& numbers, const fabric::Vec3& absent,
                                            std::string_view field);

/// Three numbers from 0 to 1: a colour as displayed.
absl::StatusOr<fabric::Vec3> colourFrom(const Numbers& numbers, std::string_view field);

void setNumbers(const fabric::Vec3& value, Numbers& numbers);

}  // namespace eyrie::wire
