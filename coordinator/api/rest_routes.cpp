// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/rest_routes.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <google/protobuf/descriptor.h>

#include "eyrie/v1/coordinator_service.pb.h"

namespace eyrie::api {
namespace {

std::vector<Route> routesOfService() {
    const auto& service = *v1::GetStatusRequest::descriptor()->file()->service(0);
    std::vector<Route> routes;
    for (int i = 0; i < service.method_count(); ++i)
        for (const v1::Rest& rest : service.method(i)->options().GetRepeatedExtension(v1::rest))
            routes.push_back({service.method(i), rest});
    return routes;
}

/// The text up to the next slash, which goes with it.
std::string_view takeSegment(std::string_view& path) {
    const std::string_view segment = path.substr(0, path.find('/'));
    path.remove_prefix(std::min(path.size(), segment.size() + 1));
    return segment;
}

std::optional<std::map<std::string, std::string>> match(const v1::Rest& rest,
                                                        std::string_view path) {
    std::map<std::string, std::string> fields;
    std::string_view form = rest.path();
    while (!form.empty()) {
        const std::string_view expected = takeSegment(form);
        const bool isField = expected.starts_with('{');
        const bool takesAll = isField && form.empty() && rest.slashes();
        const std::string_view segment = takesAll ? std::exchange(path, {}) : takeSegment(path);
        if (!isField && segment != expected)
            return std::nullopt;
        if (!isField)
            continue;
        const std::optional<std::string> decoded = percentDecoded(segment);
        if (!decoded || decoded->empty())
            return std::nullopt;
        fields[std::string(expected.substr(1, expected.size() - 2))] = *decoded;
    }
    if (!path.empty())
        return std::nullopt;
    return fields;
}

}  // namespace

const std::vector<Route>& restRoutes() {
    static const std::vector<Route> routes = routesOfService();
    return routes;
}

bool changes(const v1::Rest& rest) {
    return rest.method() == "PUT" || rest.method() == "PATCH" || rest.method() == "DELETE";
}

FoundRoute findRoute(std::string_view method, std::string_view path) {
    FoundRoute found;
    for (const Route& route : restRoutes()) {
        auto fields = match(route.rest, path);
        if (!fields)
            continue;
        found.allowed += (found.allowed.empty() ? "" : ", ") + route.rest.method();
        const bool isMeant =
            method == route.rest.method() || (method == "HEAD" && route.rest.method() == "GET");
        if (isMeant && found.route == nullptr) {
            found.route = &route;
            found.fields = *std::move(fields);
        }
    }
    return found;
}

std::optional<std::string> percentDecoded(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        if (i + 2 >= text.size())
            return std::nullopt;
        unsigned byte = 0;
        const char* const first = text.data() + i + 1;
        if (std::from_chars(first, first + 2, byte, 16).ptr != first + 2)
            return std::nullopt;
        decoded += static_cast<char>(byte);
        i += 2;
    }
    return decoded;
}

}  // namespace eyrie::api
