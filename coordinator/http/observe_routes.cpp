// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/observe_routes.h"

#include <map>
#include <memory>
#include <string>

#include "access/failed_handshakes.h"
#include "coordinator/http/status_json.h"

namespace eyrie::http {
namespace {

Response metricsResponse(observe::Telemetry& telemetry, const access::Gate* gate,
                         const coordinator::FrameSource& frames) {
    using coordinator::RendererCondition;
    std::map<std::string, int> conditions;
    for (const auto condition :
         {RendererCondition::Ready, RendererCondition::Opening, RendererCondition::Late,
          RendererCondition::Draining, RendererCondition::Dead, RendererCondition::Refused})
        conditions[std::string(nameOf(condition))] = 0;
    std::map<std::string, std::string> ids;
    for (const coordinator::RendererStatus& renderer : frames.status().renderers) {
        ++conditions[std::string(nameOf(renderer.condition))];
        if (renderer.isAlive())
            ids[renderer.address] = renderer.id;
    }
    if (gate != nullptr)
        telemetry.metrics.turnedAway(access::Door::Http, gate->refusals(access::Door::Http));
    access::Refusals grpc =
        gate == nullptr ? access::Refusals() : gate->refusals(access::Door::Grpc);
    grpc.handshakes = access::FailedHandshakes::atGrpcPorts().soFar();
    telemetry.metrics.turnedAway(access::Door::Grpc, grpc);
    Response response;
    response.contentType = observe::Metrics::kContentType;
    response.body = std::make_shared<const std::string>(telemetry.metrics.text(conditions, ids));
    return response;
}

}  // namespace

std::optional<Response> observationResponse(std::string_view method, std::string_view target,
                                            observe::Telemetry& telemetry, const access::Gate* gate,
                                            const coordinator::FrameSource& frames) {
    if (pathOf(target) != "/metrics" || (method != "GET" && method != "HEAD"))
        return std::nullopt;
    return metricsResponse(telemetry, gate, frames);
}

}  // namespace eyrie::http
