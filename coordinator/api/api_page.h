// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace eyrie::api {

/// CoordinatorService over HTTP for people to read: each call with its fields and a command that
/// makes it, each kind of error. Made of the schema, as openApiJson() is. `folder`: where /api/ is
/// as seen from the page, which a proxy may have anywhere: "" or "api/".
std::string apiPage(std::string_view folder);

/// Its style, and where the page expects it.
std::string apiStyle();
inline constexpr std::string_view kApiStylePath = "/api/style.css";

}  // namespace eyrie::api
