// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/configuration_message.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/eqc_writer.h"
#include "coordinator/config/message_to_statements.h"
#include "eyrie/v1/configuration.pb.h"
#include "wire/json_error.h"

namespace eyrie::config {
namespace {

/// The list of numbers alone that `text` begins with, on one line; empty where it is another.
std::string numbersAtStart(std::string_view text, std::size_t& length) {
    const std::size_t end = text.find_first_not_of(" \n-+.0123456789eE,", 1);
    if (end == std::string_view::npos || text[end] != ']')
        return {};
    std::string numbers;
    for (const char each : text.substr(0, end + 1))
        if (each == ',')
            numbers += ", ";
        else if (each != ' ' && each != '\n')
            numbers += each;
    length = end + 1;
    return numbers;
}

/// With lists of numbers on one line; texts, which stand in quotes, stay as they are.
std::string withShortLists(std::string_view json) {
    std::string text;
    bool isInText = false;
    for (std::size_t i = 0; i < json.size();) {
        std::size_t length = json[i] == '\\' && isInText ? 2 : 1;
        std::string numbers;
        if (json[i] == '"')
            isInText = !isInText;
        else if (json[i] == '[' && !isInText)
            numbers = numbersAtStart(json.substr(i), length);
        text += numbers.empty() ? json.substr(i, length) : numbers;
        i += length;
    }
    return text;
}

}  // namespace

v1::Configuration toMessage(const Configuration& configuration) {
    return toMessage(statementsOf(configuration));
}

Configuration fromMessage(const v1::Configuration& message, Findings& findings) {
    return readStatements(toStatements(message, findings), findings);
}

std::string writeJson(const Configuration& configuration) {
    google::protobuf::util::JsonPrintOptions options;
    options.add_whitespace = true;
    std::string text;
    const auto status =
        google::protobuf::util::MessageToJsonString(toMessage(configuration), &text, options);
    return status.ok() ? withShortLists(text) : "{}";
}

Configuration readJson(std::string_view text, Findings& findings) {
    if (text.size() > kLongestText) {
        findings.error({}, fmt::format("more than the {} bytes that a configuration has at most",
                                       kLongestText));
        return {};
    }
    v1::Configuration message;
    const auto status =
        google::protobuf::util::JsonStringToMessage({text.data(), text.size()}, &message);
    if (!status.ok()) {
        findings.error(
            {}, fmt::format(
                    "this is no JSON of a configuration: {}",
                    wire::jsonError({status.message().data(), status.message().size()}).text()));
        return {};
    }
    return fromMessage(message, findings);
}

}  // namespace eyrie::config
