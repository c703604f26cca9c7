// SPDX-License-Identifier: Apache-2.0
#include "video/load.h"

#include <filesystem>
#include <system_error>

#include <dlfcn.h>
#include <fmt/format.h>

#include "fabric/version.h"

namespace eyrie::video {
namespace {

constexpr std::string_view kRemedy =
    "it is built where Debian's libavcodec-dev, libavformat-dev and libavutil-dev are installed "
    "(`./dev deps`, then `./dev build`), and needs libavformat59 where it runs";

std::filesystem::path modulePath() {
    std::error_code ignored;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    return program.parent_path().parent_path() / "lib" / "eyrie" / "libeyrie_h264.so";
}

absl::StatusOr<const Module*> open() {
    const std::string path = modulePath().string();
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr)
        return absl::FailedPreconditionError(
            fmt::format("there is no module for video: {}; {}", dlerror(), kRemedy));
    const auto entry = reinterpret_cast<Entry>(dlsym(library, kEntryName));
    const Module* module =
        entry == nullptr ? nullptr : entry(fabric::kVersion.data(), fabric::kVersion.size());
    if (module == nullptr)
        return absl::FailedPreconditionError(fmt::format(
            "{} is of another version than this Eyrie {}; {}", path, fabric::kVersion, kRemedy));
    return module;
}

}  // namespace

absl::StatusOr<const Module*> load() {
    static const absl::StatusOr<const Module*> kModule = open();
    return kModule;
}

}  // namespace eyrie::video
