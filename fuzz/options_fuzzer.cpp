// SPDX-License-Identifier: Apache-2.0
// Files of options (--options) of any bytes: refused, saying where, or values of options that the
// command has.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <sys/mman.h>
#include <unistd.h>

#include "cli/options/common_options.h"
#include "cli/options/options_file.h"

namespace {

using namespace eyrie;

/// A program of three commands, like Eyrie, two of them in a command.
struct Program {
    CLI::App app{"", "eyrie"};
    cli::CommonOptions common;
    std::string listen;
    int renderers = 0;
    std::vector<std::string> data;
    bool quiet = false;
    CLI::App* serve = app.add_subcommand("serve");
    CLI::App* terrain = app.add_subcommand("import")->add_subcommand("terrain");

    Program() {
        serve->add_option("--listen", listen);
        serve->add_option("--renderers", renderers);
        serve->add_option("--allow-url", data);
        terrain->add_option("--memory", renderers);
        app.get_subcommand("import")->add_subcommand("mesh")->add_flag("--quiet", quiet);
        cli::addCommonOptions(app, common);
    }
};

/// A file of these bytes with a name, for as long as it lives.
class MemoryFile {
public:
    explicit MemoryFile(std::string_view bytes) : fd_(memfd_create("options", MFD_CLOEXEC)) {
        if (fd_ < 0 || write(fd_, bytes.data(), bytes.size()) < 0)
            std::abort();
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { close(fd_); }
    std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

private:
    int fd_;
};

void read(const MemoryFile& file, const Program& program, const CLI::App& command) {
    const auto values = cli::readOptionsFile(file.path(), program.app, command);
    if (!values.ok() && values.status().code() != absl::StatusCode::kInvalidArgument)
        std::abort();
    if (!values.ok())
        return;
    const std::vector<std::string> names = cli::settableNames(command);
    for (const auto& [name, value] : *values)
        if (std::ranges::find(names, name) == names.end())
            std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Program program;
    const MemoryFile file({reinterpret_cast<const char*>(data), size});
    read(file, program, *program.serve);
    read(file, program, *program.terrain);
    return 0;
}
