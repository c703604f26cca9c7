// SPDX-License-Identifier: Apache-2.0
// Runs a command in a network of two hosts (lossy_link.h), on one of them, and ends with its exit
// status. Nothing that it started is left then, wherever it put itself. The command has
//
//   EYRIE_LINK_THERE     the other host, for `nsenter --net=$EYRIE_LINK_THERE PROGRAM`
//   EYRIE_LINK_ADDRESS   its address
//   EYRIE_LINK_CONTROL   the number of an open file; it takes a line a change, and answers each
//                        with a line, "ok" or what is wrong:
//       rate BITS-PER-SECOND       either way; 0: no limit (at first)
//       delay MILLISECONDS         either way
//       loss SHARE                 of the packets, 0 to 1; 1 parts the hosts
#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/lossy_link.h"
#include "tests/support/process.h"

namespace {

using eyrie::test::LossyLink;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestLine = 200;
constexpr double kMaxBitsPerSecond = 1e12;
constexpr double kMaxDelayMilliseconds = 60'000;
/// For a command that was asked to end.
constexpr std::chrono::seconds kPatience{10};

std::optional<double> numberIn(std::string_view text, double most) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool isAll = error == std::errc() && end == text.data() + text.size();
    return isAll && value >= 0 && value <= most ? std::optional(value) : std::nullopt;
}

/// What is wrong, or "ok".
std::string change(LossyLink& link, std::string_view line) {
    const std::size_t space = std::min(line.find(' '), line.size());
    const std::string_view what = line.substr(0, space);
    const std::string_view value = line.substr(std::min(space + 1, line.size()));
    const double most = what == "rate"    ? kMaxBitsPerSecond
                        : what == "delay" ? kMaxDelayMilliseconds
                                          : 1;
    const std::optional<double> number = numberIn(value, most);
    if (what != "rate" && what != "delay" && what != "loss")
        return fmt::format("\"{}\" is neither rate, delay nor loss", line);
    if (!number)
        return fmt::format("\"{}\": {} is a number from 0 to {}", line, what, most);
    if (what == "rate")
        link.limit(*number);
    else if (what == "delay")
        link.delay(std::chrono::milliseconds(std::lround(*number)));
    else
        link.lose(*number);
    return "ok";
}

/// The end of the control socket that is kept here.
class Control {
public:
    explicit Control(LossyLink& link) : link_(link) {
        std::array<int, 2> ends{};
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
            throw std::runtime_error(fmt::format("socketpair: {}", std::strerror(errno)));
        own_ = ends[0];
        others_ = ends[1];
    }
    ~Control() {
        close(own_);
        close(others_);
    }
    Control(const Control&) = delete;
    Control& operator=(const Control&) = delete;

    int own() const { return own_; }
    int others() const { return others_; }

    /// Does what has been said.
    void listen() {
        std::array<char, kLongestLine> bytes;
        const ssize_t count = recv(own_, bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (count <= 0)
            return;
        said_.append(bytes.data(), static_cast<std::size_t>(count));
        for (std::size_t end = 0; (end = said_.find('\n')) != std::string::npos;) {
            answer(change(link_, std::string_view(said_).substr(0, end)));
            said_.erase(0, end + 1);
        }
        if (said_.size() > kLongestLine)
            said_.clear();
    }

private:
    void answer(const std::string& text) const {
        const std::string line = text + '\n';
        [[maybe_unused]] const ssize_t sent =
            send(own_, line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    }

    LossyLink& link_;
    int own_ = -1;
    int others_ = -1;
    std::string said_;
};

sigset_t watchedSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&signals, signal);
    return signals;
}

std::string placeThere(LossyLink& link) {
    std::string place;
    link.runThere([&place] { place = fmt::format("/proc/{}/task/{}/ns/net", getpid(), gettid()); });
    return place;
}

pid_t start(char** command, const Control& control, const sigset_t& signalsBefore) {
    const pid_t child = fork();
    if (child != 0)
        return child;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    sigprocmask(SIG_SETMASK, &signalsBefore, nullptr);
    fcntl(control.others(), F_SETFD, 0);
    execvp(command[0], command);
    std::perror(command[0]);
    _exit(127);
}

/// Of the command, when it has ended; others that have are let go.
std::optional<int> statusOf(pid_t command) {
    std::optional<int> ended;
    int status = 0;
    while (const pid_t child = waitpid(-1, &status, WNOHANG)) {
        if (child < 0)
            break;
        if (child == command)
            ended = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return ended;
}

/// Until the command has ended; one that was told to and does not in time is left to endAll().
int waitFor(pid_t command, Control& control, int signals) {
    std::optional<Clock::time_point> end;
    while (!end || Clock::now() < *end) {
        std::array<pollfd, 2> events{{{signals, POLLIN, 0}, {control.own(), POLLIN, 0}}};
        poll(events.data(), events.size(), end ? 100 : -1);
        control.listen();
        signalfd_siginfo signal{};
        if (events[0].revents == 0 || read(signals, &signal, sizeof signal) != sizeof signal)
            continue;
        if (signal.ssi_signo != SIGCHLD) {
            kill(command, SIGTERM);
            end = end.value_or(Clock::now() + kPatience);
        } else if (const std::optional<int> status = statusOf(command)) {
            return *status;
        }
    }
    return 128 + SIGKILL;
}

/// Whoever is left of what the command started is a child of this process by now, or of one.
void endAll() {
    eyrie::test::eventually(kPatience, [] {
        for (const pid_t child : eyrie::test::childrenOf(getpid())) kill(child, SIGKILL);
        while (waitpid(-1, nullptr, WNOHANG) > 0) {
        }
        return errno == ECHILD;
    });
}

int run(char** command) {
    const sigset_t watched = watchedSignals();
    sigset_t before;
    sigprocmask(SIG_BLOCK, &watched, &before);  // in the link's threads, too
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    const int signals = signalfd(-1, &watched, SFD_CLOEXEC | SFD_NONBLOCK);
    LossyLink link;
    Control control(link);
    setenv("EYRIE_LINK_THERE", placeThere(link).c_str(), 1);
    setenv("EYRIE_LINK_ADDRESS", LossyLink::kThere, 1);
    setenv("EYRIE_LINK_CONTROL", fmt::format("{}", control.others()).c_str(), 1);
    const pid_t child = start(command, control, before);
    if (child < 0)
        throw std::runtime_error(fmt::format("fork: {}", std::strerror(errno)));
    const int status = waitFor(child, control, signals);
    endAll();
    close(signals);
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: network_link COMMAND [ARGUMENT...]\n");
        return 2;
    }
    try {
        return run(argv + 1);
    } catch (const std::runtime_error& error) {
        fmt::print(stderr, "network_link: {}\n", error.what());
        return 1;
    }
}
