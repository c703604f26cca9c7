// SPDX-License-Identifier: Apache-2.0
// Whether viewers of one server get what they are due, through the real one, its renderers and
// sockets.
//
//   build/release/bench/viewers EYRIE SCENE [SECONDS=8] [WIDTHxHEIGHT=640x360]
//
// Prints, of eight viewers of one session, how many frames each gets, and of the leaders of four
// sessions likewise; then how much later a leader's frames come, and by how much the server grows,
// with four viewers that never read what they are sent, until those are cut off. What sessions
// have drawn and encoded is in the server's log, which is printed at the end.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "bench/watched_server.h"

namespace {

using namespace eyrie;
using bench::homeOf;
using bench::lead;
using bench::percentile;
using bench::WatchedServer;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::ViewerClient;

struct Options {
    std::string program;
    std::string scene;
    int seconds = 8;
    bench::Looked looked = {};
};

/// Takes what comes; how many frames.
int watch(ViewerClient& client, Clock::time_point end) {
    int frames = 0;
    while (Clock::now() < end) {
        const auto response = client.receive(milliseconds(200));
        if (!response.ok() || !response->has_frame())
            continue;
        ++frames;
        v1::ViewerRequest ack;
        ack.mutable_frame_ack()->set_frame_number(response->frame().frame_number());
        if (!client.send(ack).ok())
            break;
    }
    return frames;
}

std::vector<int> play(const WatchedServer& server, const v1::Camera& home, const Options& options,
                      int sessions, int viewers) {
    const auto end = Clock::now() + seconds(options.seconds);
    std::vector<int> counts(static_cast<std::size_t>(sessions) * static_cast<std::size_t>(viewers));
    std::vector<std::thread> threads;
    for (int session = 0; session < sessions; ++session)
        for (int viewer = 0; viewer < viewers; ++viewer) {
            int& mine = counts[threads.size()];
            const std::string query = fmt::format("?session=s{}of{}{}", session, sessions,
                                                  viewer == 0 ? "" : "&role=watch");
            threads.emplace_back([&, viewer, query] {
                const auto client = server.open(query);
                mine = viewer == 0
                           ? static_cast<int>(lead(*client, home, options.looked, end).size())
                           : watch(*client, end);
            });
        }
    for (std::thread& thread : threads) thread.join();
    return counts;
}

void tell(const std::string& what, const std::vector<int>& counts) {
    const auto [least, most] = std::ranges::minmax(counts);
    fmt::print("{}: {} frames; the least is {:.2f} of the most\n", what, fmt::join(counts, ", "),
               static_cast<double>(least) / most);
}

void compareWithSilent(const WatchedServer& server, const v1::Camera& home,
                       const Options& options) {
    constexpr int kSilent = 4;
    constexpr double kCutAfterSeconds = 14;
    const auto leader = server.open("?session=read");
    const auto until = [&](double time) {
        return Clock::now() +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time));
    };
    lead(*leader, home, options.looked, until(options.seconds));  // until all is loaded
    const std::vector<double> alone = lead(*leader, home, options.looked, until(options.seconds));
    const double before = server.mebibytes();
    std::vector<std::unique_ptr<ViewerClient>> silent;
    for (int i = 0; i < kSilent; ++i) silent.push_back(server.open("?session=read&role=watch"));
    const auto opened = Clock::now();
    double most = before;
    double lastBeside = 0;  // seconds
    std::vector<double> beside;
    auto last = opened;
    lead(*leader, home, options.looked, until(kCutAfterSeconds), [&] {
        const auto now = Clock::now();
        // How many belong to the session is what its leader is told.
        if (leader->state().place().viewers() > 1) {
            most = std::max(most, server.mebibytes());
            lastBeside = std::chrono::duration<double>(now - opened).count();
            beside.push_back(std::chrono::duration<double, std::milli>(now - last).count());
        }
        last = now;
    });
    fmt::print(
        "a leader alone: {:.1f} ms median, {:.1f} p95; beside {} that never read: {:.1f} "
        "and {:.1f}; the server grew by {:.1f} MiB at most, and they were there for {:.1f} "
        "s\n",
        percentile(alone, 0.5), percentile(alone, 0.95), kSilent, percentile(beside, 0.5),
        percentile(beside, 0.95), most - before, lastBeside);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "usage: viewers EYRIE SCENE [SECONDS=8] [WIDTHxHEIGHT=640x360]\n");
        return 2;
    }
    Options options{argv[1], argv[2]};
    if (argc > 3)
        options.seconds = std::max(1, std::atoi(argv[3]));
    if (argc > 4 &&
        std::sscanf(argv[4], "%dx%d", &options.looked.width, &options.looked.height) != 2)
        return 2;
    WatchedServer server(options.program, options.scene);
    if (!server.start()) {
        fmt::print(stderr, "{}", server.errors());
        return 1;
    }
    const v1::Camera home = homeOf(server);
    play(server, home, options, 1, 1);  // until all is loaded
    tell("eight viewers of one session", play(server, home, options, 1, 8));
    std::vector<int> counts = play(server, home, options, 4, 2);
    std::vector<int> leaders;
    for (std::size_t i = 0; i < counts.size(); i += 2) leaders.push_back(counts[i]);
    tell("leaders of four sessions of two", leaders);
    compareWithSilent(server, home, options);
    fmt::print("{}", server.errors());
    return 0;
}
