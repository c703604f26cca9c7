// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/field_names.h"

#include <string>

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

namespace eyrie::api {

bool beginsWithField(std::string_view path, const google::protobuf::Descriptor& message) {
    const std::string first(path.substr(
        0,
        path.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789")));
    return message.FindFieldByName(first) != nullptr ||
           message.FindFieldByCamelcaseName(first) != nullptr;
}

absl::Status inRequest(const absl::Status& status, std::string_view below,
                       const google::protobuf::Descriptor& message) {
    constexpr std::string_view kShared = "frame_data.";
    std::string_view text(status.message().data(), status.message().size());
    if (text.starts_with(kShared))
        text.remove_prefix(kShared.size());
    if (!beginsWithField(text, message))
        return status;
    return {status.code(), fmt::format("{}{}", below, text)};
}

}  // namespace eyrie::api
