// SPDX-License-Identifier: Apache-2.0
#include "wire/json.h"

#include <algorithm>

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/wrappers.pb.h>

#include "eyrie/v1/camera.pb.h"
#include "eyrie/v1/flight.pb.h"
#include "eyrie/v1/look.pb.h"
#include "eyrie/v1/scene.pb.h"
#include "fabric/json_text.h"
#include "fabric/status.h"
#include "wire/camera.h"
#include "wire/flight.h"
#include "wire/json_error.h"
#include "wire/look.h"

namespace eyrie::wire {
namespace {

using fabric::numberJson;
using google::protobuf::Descriptor;

/// The message that has the last field of `path`, such as "keys[2].camera.eye".
const Descriptor* holderOf(std::string_view path, const Descriptor* message) {
    for (std::size_t dot = path.find('.'); dot != path.npos; dot = path.find('.')) {
        const std::string_view name = path.substr(0, std::min(dot, path.find('[')));
        const auto* field = message->FindFieldByCamelcaseName(std::string(name));
        if (field == nullptr || field->message_type() == nullptr)
            return message;
        message = field->message_type();
        path.remove_prefix(dot + 1);
    }
    return message;
}

/// "eye, target, up, fovyDegrees".
std::string fieldsOf(const Descriptor& message) {
    std::string list;
    for (int i = 0; i < message.field_count(); ++i)
        list += fmt::format("{}{}", list.empty() ? "" : ", ", message.field(i)->json_name());
    return list;
}

absl::Status parse(std::string_view text, std::string_view name, std::string_view kind,
                   google::protobuf::Message& message) {
    const auto status =
        google::protobuf::util::JsonStringToMessage({text.data(), text.size()}, &message);
    if (status.ok())
        return absl::OkStatus();
    const JsonError error = jsonError({status.message().data(), status.message().size()});
    const std::string known =
        error.isUnknown ? fmt::format("; there is {}",
                                      fieldsOf(*holderOf(error.field, message.GetDescriptor())))
                        : "";
    return absl::InvalidArgumentError(
        fmt::format("{}: this is no {} file: {}{}", name, kind, error.text(), known));
}

std::string print(const google::protobuf::Message& message,
                  const google::protobuf::util::JsonPrintOptions& options) {
    std::string text;
    const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
    return status.ok() ? text : "{}";
}

std::string quoted(const std::string& text) {
    google::protobuf::StringValue value;
    value.set_value(text);
    return print(value, {});
}

std::string deviceJson(const fabric::DeviceInfo& device) {
    return fmt::format(
        R"({{"vendor": {}, "device": {}, "software": {}, "driver": {}, "platform": {}}})",
        quoted(device.vendor), quoted(device.renderer), device.software, quoted(device.driver),
        quoted(device.platform));
}

std::string millisecondsJson(const fabric::StageMilliseconds& milliseconds) {
    return fmt::format(
        R"({{"cull": {}, "draw": {}, "vertices": {}, "fill": {}, "readback": {}, "encode": {}, )"
        R"("total": {}}})",
        numberJson(milliseconds.cull), numberJson(milliseconds.draw),
        numberJson(milliseconds.vertices), numberJson(milliseconds.fill),
        numberJson(milliseconds.readback), numberJson(milliseconds.encode),
        numberJson(milliseconds.total));
}

}  // namespace

absl::StatusOr<v1::Scene> sceneMessageFromJson(std::string_view text, std::string_view name) {
    v1::Scene scene;
    RETURN_IF_ERROR(parse(text, name, "scene", scene));
    return scene;
}

absl::StatusOr<fabric::Camera> cameraFromJson(std::string_view text, std::string_view name) {
    v1::Camera message;
    RETURN_IF_ERROR(parse(text, name, "camera", message));
    absl::StatusOr<fabric::Camera> camera = fromMessage(message);
    if (!camera.ok())
        return fabric::withContext(camera.status(), name);
    return camera;
}

absl::StatusOr<fabric::Flight> flightFromJson(std::string_view text, std::string_view name) {
    v1::Flight message;
    RETURN_IF_ERROR(parse(text, name, "flight", message));
    absl::StatusOr<fabric::Flight> flight = fromMessage(message);
    if (!flight.ok())
        return fabric::withContext(flight.status(), name);
    return flight;
}

absl::StatusOr<fabric::Look> lookFromJson(std::string_view text, std::string_view name) {
    v1::Look message;
    RETURN_IF_ERROR(parse(text, name, "look", message));
    absl::StatusOr<fabric::Look> look = fromMessage(message);
    if (!look.ok())
        return fabric::withContext(look.status(), name);
    return look;
}

std::string toJson(const google::protobuf::Message& message) {
    google::protobuf::util::JsonPrintOptions options;
    options.add_whitespace = true;
    return print(message, options);
}

std::string statisticsJson(const fabric::FrameStatistics& statistics, int width, int height,
                           const fabric::DeviceInfo& device) {
    return fmt::format(
        R"({{
  "width": {},
  "height": {},
  "tauAsked": {},
  "tauAchieved": {},
  "complete": {},
  "memoryRaisedTau": {},
  "triangles": {},
  "points": {},
  "nodes": {},
  "nodesHidden": {},
  "pagesLoaded": {},
  "bytesLoaded": {},
  "pagesMissing": {},
  "pagesFailed": {},
  "tilesDecodedOnGpu": {},
  "normalErrorDegrees": {},
  "normalErrorMeanDegrees": {},
  "milliseconds": {},
  "limitingStage": "{}",
  "renderer": {}
}}
)",
        width, height, numberJson(statistics.tauAskedPixels),
        numberJson(statistics.tauAchievedPixels), statistics.complete, statistics.memoryRaisedTau,
        statistics.triangles, statistics.points, statistics.nodes, statistics.nodesHidden,
        statistics.pagesLoaded, statistics.bytesLoaded, statistics.pagesMissing,
        statistics.pagesFailed, statistics.tilesDecodedOnGpu,
        numberJson(statistics.normalErrorDegrees), numberJson(statistics.normalErrorMeanDegrees),
        millisecondsJson(statistics.milliseconds), fabric::limitingStage(statistics.milliseconds),
        deviceJson(device));
}

}  // namespace eyrie::wire
