// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <google/protobuf/descriptor.h>

namespace eyrie::api {

/// CoordinatorService as it is written, comments included; those that programs have compiled in
/// have none.
const google::protobuf::ServiceDescriptor& documentedService();

/// The comment before something, as one paragraph.
template <typename Described>
std::string commentOf(const Described& described) {
    google::protobuf::SourceLocation location;
    if (!described.GetSourceLocation(&location))
        return "";
    std::string text;
    for (const char c : location.leading_comments)
        if (c != '\n')
            text += c;
    return text.empty() ? text : text.substr(text.front() == ' ' ? 1 : 0);
}

}  // namespace eyrie::api
