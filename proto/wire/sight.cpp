// SPDX-License-Identifier: Apache-2.0
#include "wire/sight.h"

#include "eyrie/v1/frame.pb.h"
#include "fabric/status.h"
#include "wire/numbers.h"

namespace eyrie::wire {
namespace {

absl::StatusOr<fabric::Mat3> rotationFrom(const Numbers& numbers) {
    fabric::Mat3 rotation(1.0);
    if (numbers.empty())
        return rotation;
    RETURN_IF_ERROR(checkNumbers(numbers, 9, "sight.view_from_camera"));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            rotation[column][row] = numbers[3 * row + column];
    return rotation;
}

}  // namespace

v1::Sight toMessage(const fabric::Sight& sight) {
    v1::Sight message;
    setNumbers(sight.eye, *message.mutable_eye());
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            message.add_view_from_camera(sight.viewFromCamera[column][row]);
    v1::Frustum& frustum = *message.mutable_frustum();
    frustum.set_left(sight.frustum.left);
    frustum.set_right(sight.frustum.right);
    frustum.set_bottom(sight.frustum.bottom);
    frustum.set_top(sight.frustum.top);
    return message;
}

absl::StatusOr<fabric::Sight> fromMessage(const v1::Sight& message) {
    fabric::Sight sight;
    ASSIGN_OR_RETURN(sight.eye, threeNumbersOr(message.eye(), sight.eye, "sight.eye"));
    ASSIGN_OR_RETURN(sight.viewFromCamera, rotationFrom(message.view_from_camera()));
    const v1::Frustum& frustum = message.frustum();
    sight.frustum = {frustum.left(), frustum.right(), frustum.bottom(), frustum.top()};
    RETURN_IF_ERROR(fabric::validate(sight));
    return sight;
}

}  // namespace eyrie::wire
