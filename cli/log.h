// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace eyrie::cli {

/// How this process logs: to standard error, since standard output is for facts and pictures. In
/// all that is said there, data have the names that anybody may see (fabric::shownName).
struct LogOptions {
    bool isJson = false;
    std::string level;    ///< as spdlog's; empty: info, until quietLog
    std::string command;  ///< that runs, such as "serve"
};

/// Before any other thread. As text for people to read, or each entry as a line of JSON with
/// `time` (UTC, RFC 3339), `level`, `command`, `process`, `thread` and `message`.
void startLog(const LogOptions& options = {});

/// Only warnings and errors, or what `level` says, unless a level was asked for.
void quietLog(const std::string& level = "warn");

/// The options by which a child process logs in the same way.
std::vector<std::string> logArguments();

/// Whether entries are JSON.
bool logsJson();

/// What a command tells people of its work, line by line: as they are, or entries of a
/// JSON log.
void tell(std::string_view lines);

/// The same of what may be wrong with its input.
void tellWarnings(std::string_view lines);

/// The same of what is wrong with it.
void tellErrors(std::string_view lines);

/// The last words of a command that failed: an entry of a JSON log, "eyrie: …" for people.
void logFailure(const std::string& message);

}  // namespace eyrie::cli
