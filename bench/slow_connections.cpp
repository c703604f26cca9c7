// SPDX-License-Identifier: Apache-2.0
// What connections that never finish their requests cost others, through a real server.
//
//   build/release/bench/slow_connections EYRIE SCENE [CONNECTIONS=500]
//
// Prints how long a page (/healthz) takes and how long after its view a viewer's frame comes, alone
// and beside so many connections, each of which sends a byte of its header every tenth of a second;
// after which time the first and the last of these are cut off; and how long a refusal takes.
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bench/watched_server.h"
#include "tests/support/http_client.h"

namespace {

using namespace eyrie;
using bench::percentile;
using bench::WatchedServer;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kMeasured{9};  // less than what slow ones are given
constexpr int kRefusals = 20;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double millisecondsOf(const WatchedServer& server, const char* target, int status) {
    const auto start = Clock::now();
    const auto answer = test::httpGet(server.port(), target);
    if (!answer.ok() || answer->status != status) {
        fmt::print(stderr, "{}: {}\n", target, answer.ok() ? answer->body : "no answer");
        std::exit(1);
    }
    return millisecondsSince(start);
}

struct Times {
    std::vector<double> page;
    std::vector<double> frame;
};

Times measure(const WatchedServer& server, test::ViewerClient& viewer, const v1::Camera& home) {
    Times times;
    const auto end = Clock::now() + kMeasured;
    std::thread pages([&] {
        while (Clock::now() < end) {
            times.page.push_back(millisecondsOf(server, "/healthz", 200));
            std::this_thread::sleep_for(milliseconds(20));
        }
    });
    times.frame = bench::lead(viewer, home, {}, end);
    pages.join();
    return times;
}

void tell(const char* what, const Times& times) {
    fmt::print("{}: /healthz {:.2f} ms median, {:.2f} p95; frames {:.1f} and {:.1f}\n", what,
               percentile(times.page, 0.5), percentile(times.page, 0.95),
               percentile(times.frame, 0.5), percentile(times.frame, 0.95));
}

/// A connection from another address of this machine, which stands for another machine.
int connectSlowly(std::uint16_t port) {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in from{};
    from.sin_family = AF_INET;
    inet_pton(AF_INET, "127.0.0.2", &from.sin_addr);
    sockaddr_in to = from;
    inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
    to.sin_port = htons(port);
    const auto* address = reinterpret_cast<const sockaddr*>(&from);
    if (socket < 0 || ::bind(socket, address, sizeof from) != 0 ||
        ::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
        std::perror("connect");
        std::exit(1);
    }
    return socket;
}

/// Whether the server has ended it, or said that it will.
bool isCut(int socket) {
    char answer[4096];
    return ::send(socket, "x", 1, MSG_NOSIGNAL | MSG_DONTWAIT) < 0 ||
           ::recv(socket, answer, sizeof answer, MSG_DONTWAIT) >= 0 || errno != EAGAIN;
}

struct Slow {
    int socket;
    Clock::time_point begun;
    int turn;  ///< of kTurns
};

/// Seconds after which each was cut off. They send by turns, as those do who know nothing of each
/// other: 500 bytes at once every tenth of a second would be a queue that nobody else makes.
std::vector<double> beSlow(const WatchedServer& server, int connections, std::atomic<bool>& open) {
    constexpr int kTurns = 50;
    constexpr milliseconds kTurn{2};
    std::vector<Slow> slow;
    for (int i = 0; i < connections; ++i)
        slow.push_back({connectSlowly(server.port()), Clock::now(), i % kTurns});
    open = true;
    std::vector<double> cutAfter;
    auto next = Clock::now();
    for (int turn = 0; !slow.empty(); turn = (turn + 1) % kTurns) {
        std::erase_if(slow, [&](const Slow& one) {
            if (one.turn != turn || !isCut(one.socket))
                return false;
            cutAfter.push_back(millisecondsSince(one.begun) / 1000);
            ::close(one.socket);
            return true;
        });
        std::this_thread::sleep_until(next += kTurn);
    }
    return cutAfter;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "usage: slow_connections EYRIE SCENE [CONNECTIONS=500]\n");
        return 2;
    }
    const int connections = argc > 3 ? std::max(1, std::atoi(argv[3])) : 500;
    WatchedServer server(argv[1], argv[2]);
    if (!server.start()) {
        fmt::print(stderr, "{}", server.errors());
        return 1;
    }
    const v1::Camera home = bench::homeOf(server);
    const auto viewer = server.open("?session=others");
    measure(server, *viewer, home);  // until all is loaded
    tell("alone", measure(server, *viewer, home));
    std::atomic<bool> areOpen = false;
    std::vector<double> cutAfter;
    std::thread slow([&] { cutAfter = beSlow(server, connections, areOpen); });
    while (!areOpen) std::this_thread::sleep_for(milliseconds(1));
    tell(fmt::format("beside {} slow ones", connections).c_str(), measure(server, *viewer, home));
    slow.join();
    const auto [first, last] = std::ranges::minmax(cutAfter);
    fmt::print("slow ones are cut off after {:.1f} to {:.1f} s\n", first, last);
    std::vector<double> refusals;
    for (int i = 0; i < kRefusals; ++i)
        refusals.push_back(millisecondsOf(server, "/api/v1/image?width=0", 400));
    fmt::print("a refusal takes {:.2f} ms, the median of {}\n", percentile(refusals, 0.5),
               kRefusals);
    return 0;
}
