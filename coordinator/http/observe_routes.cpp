// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/observe_routes.h"

#include <charconv>
#include <map>
#include <string>

#include "coordinator/http/status_json.h"

namespace eyrie::http {
namespace {

constexpr std::size_t kFramesWhenNotSaid = 10;
constexpr std::size_t kMostFrames = 1000;

Response dataResponse(std::string_view contentType, std::string body) {
    Response response;
    response.contentType = contentType;
    response.body = std::make_shared<const std::string>(std::move(body));
    return response;
}

Response metricsResponse(observe::Telemetry& telemetry, const coordinator::FrameSource& frames) {
    using coordinator::RendererCondition;
    std::map<std::string, int> conditions;
    for (const auto condition :
         {RendererCondition::Ready, RendererCondition::Opening, RendererCondition::Late,
          RendererCondition::Draining, RendererCondition::Dead, RendererCondition::Refused})
        conditions[std::string(nameOf(condition))] = 0;
    std::map<std::string, bool> present;
    for (const coordinator::RendererStatus& renderer : frames.status().renderers) {
        ++conditions[std::string(nameOf(renderer.condition))];
        if (renderer.isAlive())
            present[observe::rendererName(renderer.address)] = true;
    }
    return dataResponse(observe::Metrics::kContentType,
                        telemetry.metrics.text(conditions, present));
}

/// Nothing where the query is none that is known here.
std::optional<std::size_t> framesOf(std::string_view target) {
    const std::size_t question = target.find('?');
    if (question == std::string_view::npos)
        return kFramesWhenNotSaid;
    std::string_view query = target.substr(question + 1);
    constexpr std::string_view kName = "frames=";
    if (!query.starts_with(kName))
        return std::nullopt;
    query.remove_prefix(kName.size());
    std::size_t frames = 0;
    const char* const end = query.data() + query.size();
    const auto [stop, error] = std::from_chars(query.data(), end, frames);
    if (error != std::errc() || stop != end || frames < 1 || frames > kMostFrames)
        return std::nullopt;
    return frames;
}

}  // namespace

std::optional<Response> observationResponse(std::string_view method, std::string_view target,
                                            observe::Telemetry& telemetry,
                                            const coordinator::FrameSource& frames) {
    const std::string_view path = pathOf(target);
    if ((path != "/metrics" && path != "/api/v1/trace") || (method != "GET" && method != "HEAD"))
        return std::nullopt;
    if (path == "/metrics")
        return metricsResponse(telemetry, frames);
    if (const auto count = framesOf(target))
        return dataResponse("application/json", telemetry.traces.chromeJson(*count));
    return textResponse(400, "Ask for /api/v1/trace?frames=N, with N from 1 to 1000.");
}

}  // namespace eyrie::http
