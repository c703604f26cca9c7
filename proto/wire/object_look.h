// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>
#include <google/protobuf/repeated_ptr_field.h>

#include "fabric/object_look.h"

namespace eyrie::v1 {
class ObjectLook;
}

namespace eyrie::wire {

void setObjectLooks(const fabric::ObjectLooks& looks,
                    google::protobuf::RepeatedPtrField<v1::ObjectLook>& messages);

/// In any order. InvalidArgument, naming the field, for more than kMaxObjectLooks, an object below
/// 0 or twice, and colours that are none.
absl::StatusOr<fabric::ObjectLooks> objectLooks(
    const google::protobuf::RepeatedPtrField<v1::ObjectLook>& messages);

}  // namespace eyrie::wire
