// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/stream/viewer_messages.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/version.h"

namespace eyrie::api {

void addStatusHandlers(Handlers& handlers, coordinator::FrameSource& frames) {
    handlers.add<v1::GetStatusRequest, v1::GetStatusResponse>(
        "GetStatus",
        [&frames](const v1::GetStatusRequest&,
                  const Call&) -> absl::StatusOr<v1::GetStatusResponse> {
            const coordinator::Status status = frames.status();
            v1::GetStatusResponse response;
            response.set_ready(status.problem.empty() && !status.sceneInfo.bounds.isEmpty());
            response.set_software_version(std::string(fabric::kVersion));
            *response.mutable_session() = stream::sessionState(status, "");
            return response;
        });
}

}  // namespace eyrie::api
