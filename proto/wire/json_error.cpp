// SPDX-License-Identifier: Apache-2.0
#include "wire/json_error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

namespace eyrie::wire {
namespace {

constexpr std::size_t kLongestQuote = 64;
constexpr std::string_view kNoField = ": Cannot find field.";
constexpr std::string_view kNoList = ": Proto field is not repeating, cannot start list.";
constexpr std::string_view kInvalid = "invalid value ";
constexpr std::string_view kOfType = " for type ";
constexpr std::string_view kNoMessage = "Root element must be a message.";
constexpr std::string_view kNoObject = "Starting an object on a scalar field";
constexpr std::string_view kOneOf = "Cannot set '";

constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kTypes = {{
    {"TYPE_DOUBLE", "a number"},
    {"TYPE_FLOAT", "a number"},
    {"TYPE_INT32", "a whole number"},
    {"TYPE_INT64", "a whole number"},
    {"TYPE_UINT32", "a whole number from 0"},
    {"TYPE_UINT64", "a whole number from 0"},
    {"TYPE_FIXED64", "a whole number from 0"},
    {"TYPE_BOOL", "true or false"},
    {"TYPE_STRING", "text in quotes"},
    {"TYPE_BYTES", "base64 in quotes"},
    {"type.googleapis.com", "an object in braces"},
}};

/// As JSON spells "fovy_degrees".
std::string jsonName(std::string_view name) {
    std::string spelt;
    for (std::size_t i = 0; i < name.size(); ++i)
        if (name[i] == '_' && i + 1 < name.size() && name[i + 1] != '_')
            spelt += static_cast<char>(std::toupper(static_cast<unsigned char>(name[++i])));
        else
            spelt += name[i];
    return spelt;
}

std::string below(const std::string& path, std::string_view name) {
    return jsonName(
        fmt::format("{}{}{}", path, path.empty() ? "" : ".", name.substr(0, kLongestQuote)));
}

/// "one of SHADING_SMOOTH, SHADING_FLAT in quotes", but for the value that stands for none; empty
/// where the type is no enum.
std::string namesOf(std::string_view type) {
    const auto* const found =
        google::protobuf::DescriptorPool::generated_pool()->FindEnumTypeByName(
            std::string(type.substr(type.rfind('/') + 1)));
    std::string names;
    for (int i = 0; found != nullptr && i < found->value_count(); ++i)
        if (const auto& value = *found->value(i); value.number() != 0)
            names += fmt::format("{}{}", names.empty() ? "one of " : ", ", value.name());
    return names.empty() ? "" : names + " in quotes";
}

std::string expected(std::string_view type) {
    if (std::string names = namesOf(type); !names.empty())
        return names;
    const auto known = std::ranges::find_if(
        kTypes, [&](const auto& each) { return type.starts_with(each.first); });
    return std::string(known == kTypes.end() ? "something else" : known->second);
}

JsonError invalid(const std::string& path, std::string_view words) {
    const std::size_t end = std::min(words.rfind(kOfType), words.size());
    const std::string_view value = words.substr(0, end);
    const std::string_view type = words.substr(std::min(end + kOfType.size(), words.size()));
    if (value == kNoObject)
        return {below(path, type), false, "is an object; it must be a single value"};
    if (const std::size_t name = value.rfind(kOneOf); type == "oneof" && name != value.npos)
        return {below(path,
                      value.substr(name + kOneOf.size(), value.size() - name - kOneOf.size() - 1)),
                false, "is beside another that stands for the same; leave one out"};
    return {jsonName(path), false,
            fmt::format("is {}; it must be {}", value.substr(0, kLongestQuote), expected(type))};
}

}  // namespace

std::string JsonError::text() const {
    if (isUnknown)
        return fmt::format("there is no field '{}'", field);
    return field.empty() ? what : fmt::format("{} {}", field, what);
}

JsonError jsonError(std::string_view words) {
    words = words.substr(0, words.find('\n'));
    std::string path;
    if (const std::size_t end = words.find(')'); words.starts_with('(') && end != words.npos) {
        path = words.substr(1, end - 1);
        words.remove_prefix(end + 1);
    }
    const std::size_t begin = words.starts_with(kNoField) ? 0 : words.find_first_not_of(": ");
    words.remove_prefix(std::min(begin, words.size()));
    if (words.ends_with(kNoField))
        return {below(path, words.substr(0, words.size() - kNoField.size())), true, ""};
    if (words.ends_with(kNoList))
        return {below(path, words.substr(0, words.size() - kNoList.size())), false,
                "is a list; it must be a single value"};
    if (words.starts_with(kInvalid))
        return invalid(path, words.substr(kInvalid.size()));
    if (words == kNoMessage)
        return {"", false, "the whole must be an object in braces"};
    return {jsonName(path), false,
            path.empty() ? std::string(words) : fmt::format("is wrong: {}", words)};
}

}  // namespace eyrie::wire
