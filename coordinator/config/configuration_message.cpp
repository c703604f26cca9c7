// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/configuration_message.h"

#include <utility>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/eqc_writer.h"
#include "coordinator/config/message_to_statements.h"
#include "coordinator/config/upgrade.h"
#include "eyrie/v1/configuration.pb.h"
#include "fabric/json_text.h"
#include "wire/json_error.h"

namespace eyrie::config {

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
    if (!status.ok())
        return "{}";
    fabric::joinNumbers(text);
    return text;
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
    Configuration configuration = fromMessage(message, findings);
    if (findings.hasErrors())
        return configuration;
    // Its version is that of the text it was made of, which was brought to the newest then.
    std::string version = std::exchange(configuration.version, std::string(kNewestVersion));
    upgrade(configuration);
    configuration.version = std::move(version);
    return configuration;
}

}  // namespace eyrie::config
