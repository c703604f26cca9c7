// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fabric/box.h"

namespace eyrie::cli {

/// Writes one JSON object, fields in the order they are added, numbers as fabric::numberJson has
/// them: an error without a bound is "Infinity".
class JsonObject {
public:
    JsonObject& text(std::string_view name, std::string_view value);
    JsonObject& number(std::string_view name, double value);
    JsonObject& count(std::string_view name, std::uint64_t value);
    JsonObject& flag(std::string_view name, bool value);
    JsonObject& numbers(std::string_view name, std::span<const double> values);
    JsonObject& texts(std::string_view name, const std::vector<std::string>& values);
    JsonObject& object(std::string_view name, const JsonObject& value);
    JsonObject& objects(std::string_view name, const std::vector<JsonObject>& values);
    /// {"min": [x, y, z], "max": [x, y, z]}
    JsonObject& box(std::string_view name, const fabric::Box& value);

    std::string str() const { return "{" + fields_ + "}"; }

private:
    JsonObject& raw(std::string_view name, std::string_view json);

    std::string fields_;
};

}  // namespace eyrie::cli
