// SPDX-License-Identifier: Apache-2.0
#include "cli/json_object.h"

#include <fmt/format.h>

#include "fabric/json_text.h"

namespace eyrie::cli {
namespace {

std::string triple(const fabric::Vec3& v) {
    return fmt::format("[{}, {}, {}]", fabric::numberJson(v.x), fabric::numberJson(v.y),
                       fabric::numberJson(v.z));
}

}  // namespace

JsonObject& JsonObject::raw(std::string_view name, std::string_view json) {
    fields_ += fmt::format("{}{}: {}", fields_.empty() ? "" : ", ", fabric::quotedJson(name), json);
    return *this;
}

JsonObject& JsonObject::text(std::string_view name, std::string_view value) {
    return raw(name, fabric::quotedJson(value));
}

JsonObject& JsonObject::number(std::string_view name, double value) {
    return raw(name, fabric::numberJson(value));
}

JsonObject& JsonObject::count(std::string_view name, std::uint64_t value) {
    return raw(name, fmt::format("{}", value));
}

JsonObject& JsonObject::flag(std::string_view name, bool value) {
    return raw(name, value ? "true" : "false");
}

JsonObject& JsonObject::numbers(std::string_view name, std::span<const double> values) {
    std::string list;
    for (const double value : values)
        list += (list.empty() ? "" : ", ") + fabric::numberJson(value);
    return raw(name, "[" + list + "]");
}

JsonObject& JsonObject::texts(std::string_view name, const std::vector<std::string>& values) {
    std::string list;
    for (const std::string& value : values)
        list += (list.empty() ? "" : ", ") + fabric::quotedJson(value);
    return raw(name, "[" + list + "]");
}

JsonObject& JsonObject::object(std::string_view name, const JsonObject& value) {
    return raw(name, value.str());
}

JsonObject& JsonObject::objects(std::string_view name, const std::vector<JsonObject>& values) {
    std::string list;
    for (const JsonObject& value : values) list += (list.empty() ? "" : ", ") + value.str();
    return raw(name, "[" + list + "]");
}

JsonObject& JsonObject::box(std::string_view name, const fabric::Box& value) {
    return raw(name,
               fmt::format("{{\"min\": {}, \"max\": {}}}", triple(value.min), triple(value.max)));
}

}  // namespace eyrie::cli
