// SPDX-License-Identifier: Apache-2.0
#include "cli/child_process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/stop_signal.h"

namespace eyrie::cli {
namespace {

constexpr std::chrono::milliseconds kDestructorGrace{2000};

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size() + 1);
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
}

std::string_view nameOf(std::string_view variable) {
    return variable.substr(0, variable.find('='));
}

std::vector<std::string> mergedEnvironment(const std::vector<std::string>& additions,
                                           const std::vector<std::string>& without) {
    std::vector<std::string> result;
    for (char** entry = environ; *entry != nullptr; ++entry)
        if (std::ranges::find(without, nameOf(*entry)) == without.end())
            result.emplace_back(*entry);
    for (const std::string& addition : additions)
        if (std::getenv(addition.substr(0, addition.find('=')).c_str()) == nullptr)
            result.push_back(addition);
    return result;
}

/// Memory that it writes to, and nobody else has. Safe after fork.
bool limitMemory(std::uint64_t bytes) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // those take terabytes
    bytes = 0;
#endif
    const rlimit limit{bytes, bytes};
    return bytes == 0 || setrlimit(RLIMIT_DATA, &limit) == 0;
}

/// A descriptor in place of another; safe after fork.
bool put(int descriptor, int inPlaceOf) {
    return descriptor < 0 || dup2(descriptor, inPlaceOf) >= 0;
}

/// What of a setting a child needs, ready before the fork.
struct Changes {
    const char* folder = nullptr;
    const ChildProcess::Setting& setting;
};

bool make(const Changes& changes) {
    if (changes.setting.niceness != 0)
        static_cast<void>(nice(changes.setting.niceness));  // being refused it harms nobody
    return (changes.folder == nullptr || chdir(changes.folder) == 0) &&
           put(changes.setting.output, STDOUT_FILENO) &&
           put(changes.setting.errors, STDERR_FILENO) && limitMemory(changes.setting.memoryBytes);
}

/// In the child; only calls that are safe after fork in a process with threads.
[[noreturn]] void become(char* const* arguments, char* const* environment, pid_t parent,
                         const Changes& changes) {
    setpgid(0, 0);  // Ctrl-C is for the parent, which then ends its children
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent)
        _exit(1);  // it was gone before we asked to be told
    if (!make(changes))
        _exit(126);
    unblockStopSignals();
    execve("/proc/self/exe", arguments, environment);
    _exit(127);
}

}  // namespace

absl::StatusOr<ChildProcess> ChildProcess::start(const std::vector<std::string>& arguments,
                                                 const std::vector<std::string>& environment,
                                                 const Setting& setting) {
    std::vector<std::string> command = {"eyrie"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::vector<std::string> variables = mergedEnvironment(environment, setting.without);
    const std::vector<char*> commandPointers = pointers(command);
    const std::vector<char*> variablePointers = pointers(variables);
    const pid_t parent = getpid();
    const pid_t pid = fork();
    if (pid == 0)
        become(commandPointers.data(), variablePointers.data(), parent,
               {setting.folder.empty() ? nullptr : setting.folder.c_str(), setting});
    if (pid < 0)
        return absl::UnavailableError(
            fmt::format("cannot start `eyrie {}`: {}", arguments.front(), std::strerror(errno)));
    return ChildProcess(pid);
}

ChildProcess::~ChildProcess() { stop(kDestructorGrace); }

std::string ChildProcess::End::text() const {
    return fmt::format("{} {}", crashed ? "signal" : "exit status", code);
}

std::optional<ChildProcess::End> ChildProcess::poll() {
    int status = 0;
    if (pid_ < 0 || waitpid(pid_, &status, WNOHANG) != pid_)
        return std::nullopt;
    pid_ = -1;
    if (WIFSIGNALED(status))
        return End{true, WTERMSIG(status)};
    return End{false, WEXITSTATUS(status)};
}

void ChildProcess::terminate() {
    if (pid_ > 0)
        kill(pid_, SIGTERM);
}

void ChildProcess::stop(std::chrono::milliseconds grace) {
    if (pid_ < 0)
        return;
    terminate();
    const auto deadline = std::chrono::steady_clock::now() + grace;
    while (!poll() && std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (pid_ < 0)
        return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
}

}  // namespace eyrie::cli
