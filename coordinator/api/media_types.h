// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace google::protobuf {
class Descriptor;
class Message;
}  // namespace google::protobuf

namespace eyrie::api {

/// What the bytes of a picture, a report's file or a trace are.
std::string mediaTypeOf(const google::protobuf::Message& answer);

/// What they may be, of all answers of that type.
std::vector<std::string_view> mediaTypesOf(const google::protobuf::Descriptor& answer);

/// Headers that come with them, and what these say.
std::vector<std::pair<std::string_view, std::string_view>> headersOfBytes(
    const google::protobuf::Descriptor& answer);

}  // namespace eyrie::api
