// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/status_json.h"

#include <algorithm>
#include <chrono>
#include <string_view>

#include <fmt/format.h>

#include "fabric/json_text.h"

namespace eyrie::http {
namespace {

std::string rendererJson(const coordinator::RendererStatus& renderer) {
    return fmt::format(
        R"({{"id":{},"address":{},"alive":{},"condition":"{}","why":{},"sinceUnixMilliseconds":{},)"
        R"("device":{},"driver":{},"platform":{},"software":{}}})",
        fabric::quotedJson(renderer.id), fabric::quotedJson(renderer.address), renderer.isAlive(),
        nameOf(renderer.condition), fabric::quotedJson(renderer.why),
        std::chrono::duration_cast<std::chrono::milliseconds>(renderer.since.time_since_epoch())
            .count(),
        fabric::quotedJson(renderer.device.renderer), fabric::quotedJson(renderer.device.driver),
        fabric::quotedJson(renderer.device.platform), renderer.device.software);
}

/// The elements as `toJson` writes them, with commas between.
template <typename Elements, typename ToJson>
std::string joined(const Elements& elements, ToJson toJson) {
    std::string result;
    for (const auto& element : elements) {
        if (!result.empty())
            result += ',';
        result += toJson(element);
    }
    return result;
}

}  // namespace

std::string_view nameOf(coordinator::RendererCondition condition) {
    using enum coordinator::RendererCondition;
    switch (condition) {
        case Ready:
            return "ready";
        case Opening:
            return "opening";
        case Late:
            return "late";
        case Draining:
            return "draining";
        case Dead:
            return "dead";
        case Refused:
            break;
    }
    return "refused";
}

bool isReady(const coordinator::Status& status) {
    const bool hasRenderer =
        std::any_of(status.renderers.begin(), status.renderers.end(),
                    [](const coordinator::RendererStatus& renderer) { return renderer.isAlive(); });
    return hasRenderer && status.problem.empty() && !status.sceneInfo.bounds.isEmpty();
}

std::string statusJson(const coordinator::Status& status) {
    return fmt::format(
        R"({{"ready":{},"problem":{},"note":{},"renderers":[{}],"scene":{{"objects":[{}],"triangles":{}}}}})"
        "\n",
        isReady(status), fabric::quotedJson(status.problem), fabric::quotedJson(status.note),
        joined(status.renderers, rendererJson),
        joined(status.scene.objects,
               [](const fabric::SceneObject& object) { return fabric::quotedJson(object.name); }),
        status.sceneInfo.triangles);
}

}  // namespace eyrie::http
