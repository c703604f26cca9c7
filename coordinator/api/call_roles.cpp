// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/call_roles.h"

#include <google/protobuf/descriptor.h>

#include "coordinator/api/rest_routes.h"

namespace eyrie::api {

access::Role roleFor(std::string_view call) {
    const auto isOne = [call](auto... names) { return ((call == names) || ...); };
    if (call.starts_with("Get") || call.starts_with("List") || call.starts_with("Watch") ||
        isOne("RenderImage", "PickPoint", "MeasureProfile"))
        return access::Role::View;
    if (isOne("SetScene", "ChangeConfiguration", "ChangeSession", "PutFlight", "DeleteFlight"))
        return access::Role::Control;
    return access::Role::Admin;
}

access::Role roleForRest(std::string_view method, std::string_view path) {
    if (const FoundRoute found = findRoute(method, path); found.route != nullptr)
        return roleFor(found.route->call->name());
    return method == "GET" || method == "HEAD" ? access::Role::View : access::Role::Admin;
}

}  // namespace eyrie::api
