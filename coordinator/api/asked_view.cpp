// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/asked_view.h"

#include "coordinator/stream/home_camera.h"
#include "eyrie/v1/camera.pb.h"
#include "wire/camera.h"

namespace eyrie::api {

absl::StatusOr<fabric::Camera> cameraOf(const v1::Camera& message,
                                        const coordinator::FrameSource& frames,
                                        double exaggeration) {
    if (message.ByteSizeLong() > 0)
        return wire::fromMessage(message);
    const coordinator::Status status = frames.status();
    if (status.sceneInfo.bounds.isEmpty())
        return absl::UnavailableError(status.problem.empty() ? "no scene is open yet"
                                                             : status.problem);
    return stream::homeCamera(stream::exaggeratedBounds(status.sceneInfo, exaggeration));
}

}  // namespace eyrie::api
