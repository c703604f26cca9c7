// SPDX-License-Identifier: Apache-2.0
#include "cli/output_reader.h"

#include <cerrno>
#include <chrono>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace eyrie::cli {
namespace {

constexpr std::chrono::milliseconds kPollInterval{20};

bool isPipe(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
}

}  // namespace

absl::StatusOr<OutputReader> OutputReader::await(const std::string& path,
                                                 const std::stop_token& stop) {
    while (isPipe(path)) {
        const int fd = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
        if (fd >= 0)
            return OutputReader(fd);
        if (errno != ENXIO && errno != EINTR)
            break;
        if (stop.stop_requested())
            return absl::CancelledError(
                fmt::format("{}: stopped while nobody read this pipe", path));
        std::this_thread::sleep_for(kPollInterval);
    }
    return OutputReader(-1);
}

OutputReader::~OutputReader() {
    if (fd_ >= 0)
        ::close(fd_);
}

}  // namespace eyrie::cli
