// SPDX-License-Identifier: Apache-2.0
#include "cli/lost_bytes.h"

#include <csignal>
#include <string_view>

#include <unistd.h>

#include "cli/exit_status.h"

namespace eyrie::cli {
namespace {

/// In the middle of anything: only what signal handlers may call.
[[noreturn]] void endOfBytes(int /*signal*/) {
    constexpr std::string_view kLine =
        "eyrie: a file that was being read became shorter or cannot be read; try again when "
        "nobody writes it\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kLine.data(), kLine.size());
    _exit(static_cast<int>(ExitStatus::Failed));
}

}  // namespace

void sayWhereBytesAreLost() { std::signal(SIGBUS, endOfBytes); }

}  // namespace eyrie::cli
