// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

/// JSON that the program wrote, read by a reader that is not its own.
namespace eyrie::test {

using JsonValue = google::protobuf::Value;

inline JsonValue parseJson(const std::string& text) {
    JsonValue value;
    const auto status = google::protobuf::util::JsonStringToMessage(text, &value);
    EXPECT_TRUE(status.ok()) << status.ToString() << "\n" << text;
    return value;
}

/// The value at "a.b.c"; a null value where there is none.
inline JsonValue at(JsonValue value, const std::string& path) {
    std::istringstream names(path);
    for (std::string name; std::getline(names, name, '.');) {
        const auto& fields = value.struct_value().fields();
        const auto field = fields.find(name);
        value = field == fields.end() ? JsonValue() : JsonValue(field->second);
    }
    return value;
}

/// The values of the list at "a.b.c".
inline std::vector<JsonValue> list(const JsonValue& value, const std::string& path) {
    const JsonValue found = at(value, path);
    return {found.list_value().values().begin(), found.list_value().values().end()};
}

inline double number(const JsonValue& object, const std::string& path) {
    const JsonValue value = at(object, path);
    EXPECT_EQ(value.kind_case(), JsonValue::kNumberValue) << path << " should be a number";
    return value.number_value();
}

}  // namespace eyrie::test
