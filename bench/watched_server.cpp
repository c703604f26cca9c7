// SPDX-License-Identifier: Apache-2.0
#include "bench/watched_server.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "bench/process_figures.h"

namespace eyrie::bench {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::seconds;
using test::ViewerClient;

/// A step of an orbit round the scene.
v1::ViewRequest viewAt(const v1::Camera& home, std::uint64_t sequence, const Looked& looked) {
    v1::ViewRequest view;
    view.set_sequence(sequence);
    view.set_width(looked.width);
    view.set_height(looked.height);
    view.set_tau_pixels(1);
    *view.mutable_camera() = home;
    const double angle = 0.01 * static_cast<double>(sequence);
    const double x = home.eye(0) - home.target(0);
    const double y = home.eye(1) - home.target(1);
    view.mutable_camera()->set_eye(0, home.target(0) + x * std::cos(angle) - y * std::sin(angle));
    view.mutable_camera()->set_eye(1, home.target(1) + x * std::sin(angle) + y * std::cos(angle));
    return view;
}

}  // namespace

WatchedServer::WatchedServer(const std::string& program, const std::string& scene)
    : process_({program, "serve", scene, "--listen", "127.0.0.1:0"},
               {"XDG_CACHE_HOME=" + folder_.path("cache")}) {}

bool WatchedServer::start() {
    constexpr std::string_view kBegin = "Eyrie is at http://127.0.0.1:";
    if (!process_.waitForOutput(kBegin, seconds(300)) || !process_.waitForOutput("/\n", seconds(5)))
        return false;
    const std::string output = process_.output();
    port_ =
        static_cast<std::uint16_t>(std::atoi(output.c_str() + output.find(kBegin) + kBegin.size()));
    return true;
}

std::unique_ptr<ViewerClient> WatchedServer::open(const std::string& query) const {
    auto client = ViewerClient::connect(port_, query);
    if (client.ok())
        return *std::move(client);
    fmt::print(stderr, "{}\n", client.status().ToString());
    std::exit(1);
}

double WatchedServer::mebibytes() const {
    const auto figures = figuresOf(process_.id(), 0);
    return figures ? figures->residentMebibytes : 0;
}

v1::Camera homeOf(const WatchedServer& server) {
    const auto client = server.open("");
    for (;;) {
        const auto response = client->receive(seconds(60));
        if (!response.ok())
            std::exit(1);
        if (response->has_state() && response->state().has_home())
            return response->state().home();
    }
}

std::vector<double> lead(ViewerClient& client, const v1::Camera& home, const Looked& looked,
                         Clock::time_point end, const std::function<void()>& frameCame) {
    std::vector<double> latencies;
    for (std::uint64_t sequence = 1; Clock::now() < end; ++sequence) {
        const auto start = Clock::now();
        if (!client.frameOf(viewAt(home, sequence, looked), seconds(20)).ok())
            break;
        latencies.push_back(
            std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        frameCame();
    }
    return latencies;
}

double percentile(std::vector<double> values, double share) {
    if (values.empty())
        return 0;
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace eyrie::bench
