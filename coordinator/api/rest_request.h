// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include <absl/status/status.h>

namespace google::protobuf {
class Message;
}

namespace eyrie::api {

/// Sets a number, text, switch or enumeration of `message` by its name of JSON or of the schema.
/// InvalidArgument, naming the field: there is none, it is no such field, `text` is not of its
/// kind, or `message` has something else there already.
absl::Status setField(std::string_view name, const std::string& text,
                      google::protobuf::Message& message);

/// Sets what a query has: "width=320&height=180". Errors: those of setField, InvalidArgument where
/// something comes twice.
absl::Status setFromQuery(std::string_view query, google::protobuf::Message& message);

/// Sets `field` of `message`, or, where it is empty, all of it, from protobuf JSON. An empty body
/// sets nothing. InvalidArgument: this is no JSON, or has a field that there is not.
absl::Status setFromBody(const std::string& body, const std::string& field,
                         google::protobuf::Message& message);

}  // namespace eyrie::api
