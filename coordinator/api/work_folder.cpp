// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/work_folder.h"

#include <random>
#include <system_error>

#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "fabric/status.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;

/// A line of `--progress-json`: false for any other.
bool tellProgress(std::string_view line, const Operations::Progress& progress) {
    google::protobuf::Struct json;
    if (!line.starts_with('{') ||
        !google::protobuf::util::JsonStringToMessage(std::string(line), &json).ok())
        return false;
    const auto stage = json.fields().find("stage");
    const auto fraction = json.fields().find("fraction");
    if (stage == json.fields().end() || fraction == json.fields().end())
        return false;
    progress(stage->second.string_value(), fraction->second.number_value());
    return true;
}

}  // namespace

absl::StatusOr<WorkFolder> WorkFolder::in(const fs::path& parent, std::string_view purpose) {
    std::random_device random;
    fs::path path = parent / fmt::format(".eyrie-{}-{:08x}{:08x}", purpose, random(), random());
    std::error_code error;
    if (!fs::create_directory(path, error))
        return absl::UnavailableError(
            "nothing can be written beside the output; see that the data folder is writable "
            "and not full");
    return WorkFolder(std::move(path));
}

WorkFolder::~WorkFolder() {
    std::error_code error;
    if (goes_ && !path_.empty())
        fs::remove_all(path_, error);
}

std::string named(std::string text, std::string_view path, std::string_view name) {
    for (std::size_t at = text.find(path); at != std::string::npos;
         at = text.find(path, at + name.size()))
        text.replace(at, path.size(), name);
    return text;
}

absl::StatusOr<std::string> runToItsEnd(const std::vector<std::string>& arguments,
                                        const fs::path& folder, const RunProgram& run,
                                        const Operations::Progress& progress,
                                        const std::stop_token& stop) {
    LastWords words;
    const auto heard = [&](std::string_view line) {
        if (!tellProgress(line, progress))
            words.hear(line);
    };
    ASSIGN_OR_RETURN(ProgramEnd end, run(arguments, folder, heard, stop));
    if (stop.stop_requested())
        return absl::CancelledError("the operation was called off");
    RETURN_IF_ERROR(words.statusOf(end));
    return std::move(end.output);
}

}  // namespace eyrie::api
