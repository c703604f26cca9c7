// SPDX-License-Identifier: Apache-2.0
#include "wire/camera.h"

#include "eyrie/v1/camera.pb.h"
#include "fabric/status.h"
#include "wire/numbers.h"

namespace eyrie::wire {

v1::Camera toMessage(const fabric::Camera& camera) {
    v1::Camera message;
    setNumbers(camera.eye, *message.mutable_eye());
    setNumbers(camera.target, *message.mutable_target());
    setNumbers(camera.up, *message.mutable_up());
    message.set_fovy_degrees(camera.fovYDegrees);
    return message;
}

absl::StatusOr<fabric::Camera> fromMessage(const v1::Camera& message) {
    fabric::Camera camera;
    ASSIGN_OR_RETURN(camera.eye, threeNumbers(message.eye(), "camera.eye"));
    ASSIGN_OR_RETURN(camera.target, threeNumbers(message.target(), "camera.target"));
    ASSIGN_OR_RETURN(camera.up, threeNumbersOr(message.up(), camera.up, "camera.up"));
    if (message.fovy_degrees() != 0)
        camera.fovYDegrees = message.fovy_degrees();
    RETURN_IF_ERROR(fabric::validate(camera));
    return camera;
}

}  // namespace eyrie::wire
