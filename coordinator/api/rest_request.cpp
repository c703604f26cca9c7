// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/rest_request.h"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "access/printable.h"
#include "coordinator/api/rest_routes.h"
#include "fabric/status.h"
#include "wire/json_error.h"

namespace eyrie::api {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

absl::Status noField(std::string_view path) {
    return absl::InvalidArgumentError(
        fmt::format("there is no field '{}' here; see /api for what there is", path));
}

/// `below` is what the JSON is of: "scene." or nothing.
absl::Status notOfTheKind(const wire::JsonError& error, std::string_view below,
                          const Message& message) {
    if (error.isUnknown)
        return noField(fmt::format("{}{}", below, error.field));
    if (error.field.empty())
        return absl::InvalidArgumentError(
            fmt::format("this is no JSON of {}: {}", message.GetDescriptor()->name(), error.what));
    return absl::InvalidArgumentError(
        fmt::format("{}{}; see /api for what it can be", below, error.text()));
}

absl::Status parseJson(const std::string& json, std::string_view below, Message& message) {
    const auto status = google::protobuf::util::JsonStringToMessage(json, &message);
    if (status.ok())
        return absl::OkStatus();
    return notOfTheKind(wire::jsonError({status.message().data(), status.message().size()}), below,
                        message);
}

const FieldDescriptor* fieldOf(std::string_view name, const Message& message) {
    const std::string text(name);
    const auto* field = message.GetDescriptor()->FindFieldByCamelcaseName(text);
    return field != nullptr ? field : message.GetDescriptor()->FindFieldByName(text);
}

bool isPlain(const FieldDescriptor& field) {
    return !field.is_repeated() && field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE;
}

/// Numbers and switches are the same with and without quotes but for these.
std::string asJson(const FieldDescriptor& field, const std::string& text) {
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL)
        return text;
    google::protobuf::Value value;
    value.set_string_value(text);
    std::string json;
    (void)google::protobuf::util::MessageToJsonString(value, &json);
    return json;
}

}  // namespace

absl::Status setField(std::string_view name, const std::string& text, Message& message) {
    const FieldDescriptor* field = fieldOf(name, message);
    if (field == nullptr || !isPlain(*field))
        return noField(name.substr(0, 64));
    if (!access::isUtf8(text))
        return absl::InvalidArgumentError(fmt::format("{} is '{}', which is not UTF-8",
                                                      field->json_name(),
                                                      access::printable(text.substr(0, 64))));
    const bool isWord =
        field->cpp_type() != FieldDescriptor::CPPTYPE_BOOL || text == "true" || text == "false";
    const auto made = std::unique_ptr<Message>(message.New());
    if (!isWord ||
        !parseJson(fmt::format("{{\"{}\":{}}}", field->json_name(), asJson(*field, text)), "",
                   *made)
             .ok())
        return absl::InvalidArgumentError(fmt::format("{} is '{}', which is no {}; see /api",
                                                      field->json_name(), text.substr(0, 64),
                                                      field->cpp_type_name()));
    const bool isThere = message.GetReflection()->HasField(message, field);
    const std::string before = isThere ? message.SerializeAsString() : "";
    message.MergeFrom(*made);
    if (isThere && message.SerializeAsString() != before)
        return absl::InvalidArgumentError(
            fmt::format("{} is '{}', and something else in another place of the request; give it "
                        "once",
                        field->json_name(), text.substr(0, 64)));
    return absl::OkStatus();
}

absl::Status setFromQuery(std::string_view query, Message& message) {
    std::set<std::string> seen;
    while (!query.empty()) {
        const std::string_view part = query.substr(0, query.find('&'));
        query.remove_prefix(std::min(query.size(), part.size() + 1));
        if (part.empty())
            continue;
        std::string raw(part.substr(std::min(part.size(), part.find('=') + 1)));
        if (part.find('=') == std::string_view::npos)
            raw.clear();
        std::ranges::replace(raw, '+', ' ');
        const std::optional<std::string> name = percentDecoded(part.substr(0, part.find('=')));
        const std::optional<std::string> value = percentDecoded(raw);
        if (!name || !value)
            return absl::InvalidArgumentError("the query has a % without two hexadecimal digits");
        if (!seen.insert(*name).second)
            return absl::InvalidArgumentError(
                fmt::format("{} is in the query twice; give it once", name->substr(0, 64)));
        RETURN_IF_ERROR(setField(*name, *value, message));
    }
    return absl::OkStatus();
}

absl::Status setFromBody(const std::string& body, const std::string& field, Message& message) {
    if (body.empty())
        return absl::OkStatus();
    if (field.empty())
        return parseJson(body, "", message);
    const FieldDescriptor* part = fieldOf(field, message);
    return parseJson(body, field + ".", *message.GetReflection()->MutableMessage(&message, part));
}

}  // namespace eyrie::api
