// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

constexpr int kFramesWhenNotSaid = 10;
constexpr int kMostFrames = 1000;

}  // namespace

void addTraceHandlers(Handlers& handlers, observe::SharedTelemetry telemetry,
                      const QuotaKeeper& quotas) {
    handlers.add<v1::GetTraceRequest, v1::GetTraceResponse>(
        "GetTrace",
        [telemetry = std::move(telemetry), &quotas](
            const v1::GetTraceRequest& request,
            const Call& call) -> absl::StatusOr<v1::GetTraceResponse> {
            const int frames = request.has_frames() ? request.frames() : kFramesWhenNotSaid;
            if (frames < 1 || frames > kMostFrames)
                return absl::InvalidArgumentError(
                    fmt::format("frames is {}; it must be from 1 to {}", frames, kMostFrames));
            v1::GetTraceResponse response;
            response.set_content(telemetry->traces.chromeJson(static_cast<std::size_t>(frames)));
            ASSIGN_OR_RETURN(std::shared_ptr<void> share,
                             quotas.documentShare(call.taking(std::ssize(response.content()))));
            call.keep(std::move(share));
            return response;
        });
}

}  // namespace eyrie::api
