// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eyrie/v1/rest.pb.h"

namespace google::protobuf {
class MethodDescriptor;
}

namespace eyrie::api {

/// A way to make a call over HTTP.
struct Route {
    const google::protobuf::MethodDescriptor* call = nullptr;
    v1::Rest rest;
};

/// All ways of CoordinatorService, in its order.
const std::vector<Route>& restRoutes();

/// Whether it changes what can be read by GET at the same path.
bool changes(const v1::Rest& rest);

struct FoundRoute {
    const Route* route = nullptr;               ///< null: the path has none for this method
    std::map<std::string, std::string> fields;  ///< what stands in the path, decoded
    std::string allowed;  ///< methods that the path has, for an Allow header; empty: no such path
};

/// `path` below /api/v1, as it was sent. Of Rest::slashes a field at its end may have some.
FoundRoute findRoute(std::string_view method, std::string_view path);

/// Text with %XX for some of its bytes; nothing where what follows a % is not of that form.
std::optional<std::string> percentDecoded(std::string_view text);

}  // namespace eyrie::api
