// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/call_roles.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/api/scene_desk.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/status.h"

namespace eyrie::api {

void addSceneHandlers(Handlers& handlers, SceneDesk& scenes) {
    handlers.add<v1::GetSceneRequest, v1::GetSceneResponse>(
        "GetScene",
        [&scenes](const v1::GetSceneRequest&,
                  const Call& call) -> absl::StatusOr<v1::GetSceneResponse> {
            v1::GetSceneResponse response;
            const bool mayShowAgain = call.role >= roleFor("SetScene");
            *response.mutable_scene() = mayShowAgain ? scenes.scene() : scenes.sceneForAnybody();
            return response;
        });
    handlers.add<v1::SetSceneRequest, v1::SetSceneResponse>(
        "SetScene",
        [&scenes](const v1::SetSceneRequest& request,
                  const Call& call) -> absl::StatusOr<v1::SetSceneResponse> {
            RETURN_IF_ERROR(scenes.show(request.scene(), call.stop));
            v1::SetSceneResponse response;
            *response.mutable_scene() = scenes.scene();
            return response;
        });
}

}  // namespace eyrie::api
