// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/replace_file.h"

#include <algorithm>
#include <cerrno>
#include <random>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;

std::error_code lastError() { return {errno, std::generic_category()}; }

std::error_code writeAndFlush(int file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0 && errno != EINTR)
            return lastError();
        text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(0, written)));
    }
    return ::fsync(file) != 0 ? lastError() : std::error_code();
}

}  // namespace

std::error_code replaceFile(const fs::path& path, std::string_view text, Readers readers) {
    std::random_device random;
    const fs::path partial =
        path.parent_path() /
        fmt::format(".{}.partial-{:08x}{:08x}", path.filename().string(), random(), random());
    const int file = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                            readers == Readers::OwnerAlone ? 0600 : 0666);
    if (file < 0)
        return lastError();
    std::error_code error = writeAndFlush(file, text);
    if (::close(file) != 0 && !error)
        error = lastError();
    if (!error)
        fs::rename(partial, path, error);
    std::error_code ignored;
    if (error)
        fs::remove(partial, ignored);
    return error;
}

}  // namespace eyrie::api
