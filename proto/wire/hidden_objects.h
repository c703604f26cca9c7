// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <absl/status/statusor.h>
#include <google/protobuf/repeated_field.h>

#include "fabric/hidden_objects.h"

namespace eyrie::wire {

void setHidden(const fabric::HiddenObjects& hidden,
               google::protobuf::RepeatedField<std::int32_t>& numbers);

/// In any order, some perhaps twice. InvalidArgument, naming `field`, for more than
/// kMaxHiddenObjects or one below 0.
absl::StatusOr<fabric::HiddenObjects> hiddenObjects(
    const google::protobuf::RepeatedField<std::int32_t>& numbers, std::string_view field);

}  // namespace eyrie::wire
