// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/problem_json.h"

#include <string_view>

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "coordinator/api/field_names.h"
#include "coordinator/stream/viewer_messages.h"

namespace eyrie::api {
namespace {

std::string_view titleOf(absl::StatusCode code) {
    switch (code) {
        case absl::StatusCode::kInvalidArgument:
        case absl::StatusCode::kOutOfRange:
            return "The request is wrong";
        case absl::StatusCode::kNotFound:
            return "There is no such thing";
        case absl::StatusCode::kAlreadyExists:
        case absl::StatusCode::kFailedPrecondition:
        case absl::StatusCode::kAborted:
            return "Things are not as the request needs them";
        case absl::StatusCode::kPermissionDenied:
        case absl::StatusCode::kUnauthenticated:
            return "This is not allowed";
        case absl::StatusCode::kResourceExhausted:
            return "There is too much to do";
        case absl::StatusCode::kUnavailable:
        case absl::StatusCode::kDeadlineExceeded:
            return "There is no picture or answer now";
        case absl::StatusCode::kUnimplemented:
            return "This server does not do that";
        case absl::StatusCode::kCancelled:
            return "The caller has gone";
        default:
            return "Something failed";
    }
}

/// That a message begins with, in JSON's names: "jpeg_quality" is "jpegQuality". One that the
/// request does not have is what is said not to be there.
std::string fieldOf(std::string_view message, const google::protobuf::Descriptor* request) {
    constexpr std::string_view kUnknown = "there is no field '";
    if (request == nullptr)
        return "";
    const bool isUnknown = message.starts_with(kUnknown);
    if (isUnknown)
        message.remove_prefix(kUnknown.size());
    const std::string_view path = message.substr(
        0, message.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_.[]"
                                     "0123456789"));
    if (isUnknown ? !message.substr(path.size()).starts_with('\'')
                  : !beginsWithField(path, *request))
        return "";
    std::string field;
    for (std::size_t i = 0; i < path.size(); ++i)
        if (path[i] == '_' && i + 1 < path.size() && path[i + 1] >= 'a' && path[i + 1] <= 'z')
            field += static_cast<char>(path[++i] - 'a' + 'A');
        else
            field += path[i];
    return field;
}

}  // namespace

int httpStatusOf(absl::StatusCode code) {
    switch (code) {
        case absl::StatusCode::kOk:
            return 200;
        case absl::StatusCode::kInvalidArgument:
        case absl::StatusCode::kOutOfRange:
            return 400;
        case absl::StatusCode::kUnauthenticated:
            return 401;
        case absl::StatusCode::kPermissionDenied:
            return 403;
        case absl::StatusCode::kNotFound:
            return 404;
        case absl::StatusCode::kAlreadyExists:
        case absl::StatusCode::kFailedPrecondition:
        case absl::StatusCode::kAborted:
            return 409;
        case absl::StatusCode::kResourceExhausted:
            return 429;
        case absl::StatusCode::kCancelled:
            return 499;
        case absl::StatusCode::kUnimplemented:
            return 501;
        case absl::StatusCode::kUnavailable:
            return 503;
        case absl::StatusCode::kDeadlineExceeded:
            return 504;
        default:
            return 500;
    }
}

std::string problemJson(const absl::Status& status, int httpStatus,
                        const google::protobuf::Descriptor* request) {
    // absl's names of its codes are gRPC's.
    const auto name = absl::StatusCodeToString(status.code());
    const std::string detail =
        stream::sanitised({status.message().data(), status.message().size()});
    google::protobuf::Struct problem;
    auto& members = *problem.mutable_fields();
    members["type"].set_string_value("/api#" + name);
    members["title"].set_string_value(std::string(titleOf(status.code())));
    members["status"].set_number_value(httpStatus);
    members["detail"].set_string_value(detail);
    members["code"].set_string_value(name);
    if (const std::string field = fieldOf(detail, request); !field.empty())
        members["field"].set_string_value(field);
    if (const std::size_t remedy = detail.rfind("; "); remedy != std::string::npos)
        members["remedy"].set_string_value(detail.substr(remedy + 2));
    std::string json;
    (void)google::protobuf::util::MessageToJsonString(problem, &json);
    return json + "\n";
}

}  // namespace eyrie::api
