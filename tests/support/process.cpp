// SPDX-License-Identifier: Apache-2.0
#include "tests/support/process.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace eyrie::test {
namespace {

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

/// This process's environment with `added` in place of entries of the same names.
std::vector<std::string> environmentWith(const std::vector<std::string>& added) {
    std::vector<std::string> all = added;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string_view text = *entry;
        const std::string_view name = text.substr(0, text.find('=') + 1);
        if (std::none_of(added.begin(), added.end(),
                         [&](const std::string& other) { return other.starts_with(name); }))
            all.emplace_back(text);
    }
    return all;
}

int memoryFile(const char* name) {
    const int file = memfd_create(name, MFD_CLOEXEC);
    if (file < 0)
        throw std::runtime_error("memfd_create failed");
    return file;
}

std::string contentOf(int file) {
    struct stat status {};
    fstat(file, &status);
    std::string text(static_cast<std::size_t>(status.st_size), '\0');
    const ssize_t count = pread(file, text.data(), text.size(), 0);
    text.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    return text;
}

/// The fields of /proc/PID/stat after the name in brackets: state, parent, …
std::vector<std::string> statusFields(pid_t process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    std::getline(file, text);
    const std::size_t name = text.rfind(')');
    if (name == std::string::npos)
        return {};
    std::istringstream rest(text.substr(name + 1));
    std::vector<std::string> fields;
    for (std::string field; rest >> field;) fields.push_back(field);
    return fields;
}

}  // namespace

std::ostream& operator<<(std::ostream& stream, const Exit& exit) {
    if (exit.signal != 0)
        return stream << "killed by signal " << exit.signal;
    if (exit.status < 0)
        return stream << "not ended within the limit";
    return stream << "exit status " << exit.status;
}

Process::Process(const std::vector<std::string>& command,
                 const std::vector<std::string>& environment)
    : output_(memoryFile("stdout")), errors_(memoryFile("stderr")) {
    // Nothing may be allocated between fork and exec: other threads may hold the heap's lock.
    std::vector<std::string> words = command;
    std::vector<std::string> variables = environmentWith(environment);
    const std::vector<char*> argv = pointersTo(words);
    const std::vector<char*> envp = pointersTo(variables);
    id_ = fork();
    if (id_ < 0)
        throw std::runtime_error("fork failed");
    if (id_ == 0) {
        setpgid(0, 0);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
        dup2(output_, STDOUT_FILENO);
        dup2(errors_, STDERR_FILENO);
        execve(argv[0], argv.data(), envp.data());
        _exit(127);
    }
    setpgid(id_, id_);  // whichever of the two comes first
}

Process::~Process() {
    kill(-id_, SIGKILL);
    if (!exit_)
        waitpid(id_, nullptr, 0);
    close(output_);
    close(errors_);
}

std::optional<Exit> Process::waitFor(Milliseconds limit) {
    eventually(limit, [&] {
        int status = 0;
        if (!exit_ && waitpid(id_, &status, WNOHANG) == id_)
            exit_ = WIFEXITED(status) ? Exit{WEXITSTATUS(status), 0} : Exit{-1, WTERMSIG(status)};
        return exit_.has_value();
    });
    return exit_;
}

bool Process::waitForOutput(std::string_view text, Milliseconds limit) {
    const auto written = [&] { return output().find(text) != std::string::npos; };
    eventually(limit, [&] { return written() || waitFor(Milliseconds(0)); });
    return written();
}

void Process::send(int signal) const {
    if (!exit_)
        kill(id_, signal);
}

std::string Process::output() const { return contentOf(output_); }
std::string Process::errors() const { return contentOf(errors_); }

Outcome run(const std::vector<std::string>& command, Process::Milliseconds limit,
            const std::vector<std::string>& environment) {
    Process process(command, environment);
    const Exit exit = process.waitFor(limit).value_or(Exit{});
    return {exit, process.output(), process.errors()};
}

std::vector<pid_t> childrenOf(pid_t parent) {
    std::vector<pid_t> children;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos)
            continue;
        const auto fields = statusFields(std::stoi(name));
        if (fields.size() > 1 && fields[0] != "Z" && fields[1] == std::to_string(parent))
            children.push_back(std::stoi(name));
    }
    return children;
}

std::string commandLineOf(pid_t process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/cmdline", std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(file), {});
    std::replace(text.begin(), text.end(), '\0', ' ');
    return text;
}

bool isAlive(pid_t process) {
    const auto fields = statusFields(process);
    return !fields.empty() && fields[0] != "Z" && fields[0] != "X";
}

void pauseBriefly() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

}  // namespace eyrie::test
