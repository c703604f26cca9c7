// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/viewer_client.h"

/// A real server and viewers of it, for programs that measure what these are due.
namespace eyrie::bench {

/// What viewers ask for.
struct Looked {
    int width = 640;
    int height = 360;
};

/// `PROGRAM serve SCENE`, at any free port, with a cache of its own.
class WatchedServer {
public:
    WatchedServer(const std::string& program, const std::string& scene);

    /// Blocks until the page is there; false: it does not come, and errors() say why.
    bool start();

    std::uint16_t port() const { return port_; }

    /// Ends the program where that cannot be.
    std::unique_ptr<test::ViewerClient> open(const std::string& query) const;

    double mebibytes() const;  ///< resident
    std::string errors() const { return process_.errors(); }

private:
    test::TemporaryFolder folder_;
    test::Process process_;
    std::uint16_t port_ = 0;
};

/// Where viewers start.
v1::Camera homeOf(const WatchedServer& server);

/// Moves the view all the time, a step of an orbit a frame, and takes every frame; milliseconds
/// from each view that a frame shows to that frame. `frameCame` is called after each.
std::vector<double> lead(
    test::ViewerClient& client, const v1::Camera& home, const Looked& looked,
    std::chrono::steady_clock::time_point end, const std::function<void()>& frameCame = [] {});

/// 0 where there are no values.
double percentile(std::vector<double> values, double share);

}  // namespace eyrie::bench
