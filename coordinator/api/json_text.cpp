// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/json_text.h"

#include <fmt/format.h>

#include "fabric/json_text.h"

namespace eyrie::api {

JsonMembers& JsonMembers::text(std::string_view name, std::string_view value) {
    return raw(name, fabric::quotedJson(value));
}

JsonMembers& JsonMembers::raw(std::string_view name, std::string_view json) {
    members_ += fmt::format("{}{}:{}", members_.empty() ? "" : ",", fabric::quotedJson(name), json);
    return *this;
}

std::string jsonList(const std::vector<std::string>& elements) {
    std::string list;
    for (const std::string& element : elements) list += (list.empty() ? "" : ",") + element;
    return "[" + list + "]";
}

}  // namespace eyrie::api
