// SPDX-License-Identifier: Apache-2.0
#include "cli/program_runs.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "cli/child_process.h"
#include "cli/options/completed_line.h"
#include "cli/values.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

constexpr std::uint64_t kLeastMemory = std::uint64_t{256} << 20;
/// Beyond what an import is told to keep within: libraries, threads' stacks, and what readers of
/// files take that know no limit. More than that is a runaway.
constexpr std::uint64_t kSlackBytes = std::uint64_t{1} << 30;
constexpr std::size_t kMaxOutputBytes = 1 << 20;
constexpr std::size_t kMaxLineBytes = 1 << 14;
constexpr std::chrono::milliseconds kLookForStop{50};
constexpr std::chrono::milliseconds kGrace{3000};
/// Pictures that people wait for come first.
constexpr int kNiceness = 10;

/// A descriptor's owner.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    void close() {
        if (number_ >= 0)
            ::close(std::exchange(number_, -1));
    }
    int number() const { return number_; }

private:
    int number_ = -1;
};

struct Pipe {
    Descriptor read;
    Descriptor write;
};

absl::StatusOr<Pipe> makePipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        return absl::UnavailableError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

/// Text as it comes, to lines.
class Lines {
public:
    explicit Lines(const std::function<void(std::string_view)>& heard) : heard_(heard) {}
    ~Lines() {
        if (!rest_.empty())
            heard_(rest_);
    }
    Lines(const Lines&) = delete;
    Lines& operator=(const Lines&) = delete;

    void add(std::string_view text) {
        rest_ += text;
        std::size_t begin = 0;
        for (std::size_t end = 0; (end = rest_.find('\n', begin)) != std::string::npos;
             begin = end + 1)
            heard_(std::string_view(rest_).substr(begin, end - begin));
        rest_.erase(0, begin);
        if (rest_.size() > kMaxLineBytes)
            rest_.clear();  // no line of ours
    }

private:
    const std::function<void(std::string_view)>& heard_;
    std::string rest_;
};

/// What `pipe` has, given to `take`; closes it at its end.
template <typename Take>
void receive(Descriptor& pipe, const Take& take) {
    std::array<char, 4096> buffer{};
    const ssize_t bytes = ::read(pipe.number(), buffer.data(), buffer.size());
    if (bytes > 0)
        take(std::string_view(buffer.data(), static_cast<std::size_t>(bytes)));
    else if (bytes == 0 || errno != EINTR)
        pipe.close();
}

/// Until both are closed at the other end, which the child's end does, or `stop`.
std::string listen(Descriptor& output, Descriptor& errors,
                   const std::function<void(std::string_view)>& heard,
                   const std::stop_token& stop) {
    std::string text;
    Lines lines(heard);
    while (!stop.stop_requested() && (output.number() >= 0 || errors.number() >= 0)) {
        std::array<pollfd, 2> asked{{{output.number(), POLLIN, 0}, {errors.number(), POLLIN, 0}}};
        ::poll(asked.data(), asked.size(), static_cast<int>(kLookForStop.count()));
        if (asked[0].revents != 0)
            receive(output, [&](std::string_view some) {
                text += some.substr(0, kMaxOutputBytes - std::min(kMaxOutputBytes, text.size()));
            });
        if (asked[1].revents != 0)
            receive(errors, [&](std::string_view some) { lines.add(some); });
    }
    return text;
}

absl::StatusOr<api::ProgramEnd> runProgram(const std::vector<std::string>& arguments,
                                           const std::filesystem::path& folder,
                                           std::uint64_t memoryBytes,
                                           const std::vector<std::string>& without,
                                           const std::function<void(std::string_view)>& heard,
                                           const std::stop_token& stop) {
    ASSIGN_OR_RETURN(Pipe output, makePipe());
    ASSIGN_OR_RETURN(Pipe errors, makePipe());
    ASSIGN_OR_RETURN(ChildProcess child,
                     ChildProcess::start(arguments, {},
                                         {folder, output.write.number(), errors.write.number(),
                                          memoryBytes, kNiceness, without}));
    output.write.close();
    errors.write.close();
    api::ProgramEnd end;
    end.output = listen(output.read, errors.read, heard, stop);
    if (stop.stop_requested()) {
        child.stop(kGrace);
        return absl::CancelledError("the program was called off");
    }
    std::optional<ChildProcess::End> ended;
    while (!(ended = child.poll())) ::poll(nullptr, 0, 1);  // it has closed both: it is going
    end.crashed = ended->crashed;
    end.code = ended->code;
    return end;
}

}  // namespace

void addProgramOptions(CLI::App& command, ProgramOptions& options) {
    options.program = command.get_parent();
    command
        .add_option("--imports", options.imports,
                    "Imports into --data, and bench runs, that programs with the role admin may "
                    "have done at a time; 0: none")
        ->check(CLI::Range(0, 16))
        ->capture_default_str();
    command
        .add_option("--import-memory", options.importMemory,
                    "What each of them uses at most, 256M or more")
        ->type_name("BYTES")
        ->capture_default_str();
}

absl::StatusOr<api::Programs> programsOf(const ProgramOptions& options) {
    ASSIGN_OR_RETURN(const std::uint64_t bytes,
                     parseBytes(options.importMemory, "--import-memory"));
    if (bytes < kLeastMemory)
        return absl::InvalidArgumentError(
            fmt::format("--import-memory is {}; it must be at least 256M", options.importMemory));
    api::Programs programs;
    programs.importsAtOnce = static_cast<std::size_t>(options.imports);
    programs.importMemoryBytes = bytes;
    // How the server is to do its work is nothing to what it has done: neither what its command
    // line says reaches them nor what its environment does.
    programs.run = [limit = bytes + kSlackBytes, without = variablesOf(*options.program)](
                       const auto& arguments, const auto& folder, const auto& heard,
                       const auto& stop) {
        return runProgram(arguments, folder, limit, without, heard, stop);
    };
    return programs;
}

}  // namespace eyrie::cli
