// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/programs.h"

#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

namespace eyrie::api {
namespace {

constexpr std::size_t kMaxLineBytes = 2000;

/// A line of a log for machines has the text in a field.
std::string textOf(std::string_view line) {
    constexpr std::string_view kName = "eyrie: ";
    if (line.starts_with(kName))
        line.remove_prefix(kName.size());
    google::protobuf::Struct json;
    if (line.starts_with('{') &&
        google::protobuf::util::JsonStringToMessage(std::string(line), &json).ok() &&
        json.fields().contains("message"))
        return json.fields().at("message").string_value();
    return std::string(line);
}

}  // namespace

void LastWords::hear(std::string_view line) {
    // Last comes where to read on, which whoever asked over the network cannot.
    constexpr std::string_view kHint = "--help` explains it";
    if (!line.empty() && !line.ends_with(kHint))
        line_ = textOf(line.substr(0, kMaxLineBytes));
}

absl::Status LastWords::statusOf(const ProgramEnd& end) const {
    if (end.crashed)
        return absl::InternalError(
            fmt::format("the program that does it ended by signal {}; the files may be damaged, or "
                        "need more memory than it may have",
                        end.code));
    if (end.code == 0)
        return absl::OkStatus();
    const std::string why =
        line_.empty() ? fmt::format("the program that does it ended with status {}", end.code)
                      : line_;
    return end.code == 2 ? absl::InvalidArgumentError(why) : absl::UnknownError(why);
}

}  // namespace eyrie::api
