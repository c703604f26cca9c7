// SPDX-License-Identifier: Apache-2.0
// Whether `eyrie serve` stays as it is: right pictures, and no memory, descriptors or threads that
// grow, while renderers are killed.
//
//   build/release/bench/soak EYRIE SCENE [SECONDS=300] [KILL_EVERY=20] [RENDERERS=3]
//                            [WIDTHxHEIGHT=640x360] [MAX_MIB_AN_HOUR=0: any] [SEED=1]
//
// A viewer flies round the scene from rest to rest, and at each of 12 places waits for the exact
// picture. Its bytes have to be those of the same place from before the first kill. Every
// KILL_EVERY seconds a renderer dies by SIGKILL, any but the first, whose own growth is watched as
// the coordinator's is. Both are looked at whenever all renderers draw. The first third of the time
// is for warming up. Exit status 1: a picture was wrong or did not come, descriptors or threads
// grew, or memory by more than MAX_MIB_AN_HOUR. bench/faults measures what a kill costs in time.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/process_figures.h"
#include "tests/support/http_client.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/viewer_client.h"

namespace {

using namespace eyrie;
using namespace eyrie::bench;
using Clock = std::chrono::steady_clock;
using std::chrono::seconds;

constexpr int kPlaces = 12;
/// For each renderer: two that wait for the next picture, and those of two frames in flight.
constexpr int kMemoryFiles = 4;
constexpr seconds kStartLimit{300};
constexpr seconds kPictureLimit{60};

struct Options {
    std::string program;
    std::string scene;
    int seconds = 300;
    int killEvery = 20;
    int renderers = 3;
    int width = 640;
    int height = 360;
    double maxSlope = 0;
    unsigned seed = 1;
};

/// `eyrie serve` and its renderers, with a cache of its own.
class Server {
public:
    explicit Server(const Options& options)
        : process_({options.program, "serve", options.scene, "--listen", "127.0.0.1:0",
                    "--renderers", std::to_string(options.renderers)},
                   {"XDG_CACHE_HOME=" + folder_.path("cache"), "LP_NUM_THREADS=1"}),
          renderers_(options.renderers) {}

    bool start() {
        constexpr std::string_view kBegin = "Eyrie is at http://127.0.0.1:";
        if (!process_.waitForOutput(kBegin, kStartLimit) ||
            !process_.waitForOutput("/\n", seconds(5)))
            return false;
        const std::string output = process_.output();
        port_ = static_cast<std::uint16_t>(
            std::atoi(output.c_str() + output.find(kBegin) + kBegin.size()));
        if (!test::eventually(kStartLimit, [this] { return isWhole(); }))
            return false;
        spared_ = rendererProcesses().front();
        return true;
    }

    /// All renderers draw.
    bool isWhole() const {
        const auto answer = test::httpGet(port_, "/readyz");
        if (!answer.ok())
            return false;
        int ready = 0;
        constexpr std::string_view kReady = "\"condition\":\"ready\"";
        for (std::size_t at = answer->body.find(kReady); at != std::string::npos;
             at = answer->body.find(kReady, at + 1))
            ++ready;
        return ready == renderers_;
    }

    std::vector<pid_t> rendererProcesses() const {
        std::vector<pid_t> found;
        for (const pid_t child : test::childrenOf(process_.id()))
            if (test::commandLineOf(child).find(" renderer ") != std::string::npos)
                found.push_back(child);
        return found;
    }

    void killOne(std::mt19937& random) const {
        std::vector<pid_t> victims = rendererProcesses();
        std::erase(victims, spared_);
        if (!victims.empty())
            kill(victims[std::uniform_int_distribution<std::size_t>(0, victims.size() - 1)(random)],
                 SIGKILL);
    }

    std::uint16_t port() const { return port_; }
    pid_t coordinator() const { return process_.id(); }
    pid_t spared() const { return spared_; }
    std::string errors() const { return process_.errors(); }

private:
    test::TemporaryFolder folder_;
    test::Process process_;
    const int renderers_;
    std::uint16_t port_ = 0;
    pid_t spared_ = 0;
};

v1::ViewRequest viewAt(int place, std::uint64_t sequence, const v1::Camera& home,
                       const Options& options) {
    v1::ViewRequest view;
    view.set_sequence(sequence);
    view.set_width(options.width);
    view.set_height(options.height);
    view.set_tau_pixels(1);
    *view.mutable_camera() = home;
    const double angle = 2 * M_PI * place / kPlaces;
    const double x = home.eye(0) - home.target(0);
    const double y = home.eye(1) - home.target(1);
    view.mutable_camera()->set_eye(0, home.target(0) + x * std::cos(angle) - y * std::sin(angle));
    view.mutable_camera()->set_eye(1, home.target(1) + x * std::sin(angle) + y * std::cos(angle));
    return view;
}

struct Flight {
    std::vector<std::string> right;  ///< of each place, the bytes of its exact picture
    int pictures = 0;
    int wrong = 0;
    int missing = 0;
    int kills = 0;
    std::map<pid_t, std::vector<ProcessFigures>> figures;
};

/// False when it did not come.
bool flyTo(int place, test::ViewerClient& viewer, const Options& options, Flight& flight) {
    static std::uint64_t sequence = 0;
    const auto frame = viewer.exactFrameOf(
        viewAt(place, ++sequence, viewer.state().home(), options), kPictureLimit);
    if (!frame.ok()) {
        ++flight.missing;
        fmt::print(stderr, "place {}: {}\n", place, frame.status().ToString());
        return false;
    }
    ++flight.pictures;
    const auto index = static_cast<std::size_t>(place);
    if (flight.right.size() == index)
        flight.right.push_back(frame->png());
    else if (flight.right[index] != frame->png()) {
        ++flight.wrong;
        fmt::print(stderr, "place {}: another picture, of {} bytes\n", place, frame->png().size());
    }
    return true;
}

void fly(const Server& server, test::ViewerClient& viewer, const Options& options, Flight& flight) {
    std::mt19937 random(options.seed);
    const auto begin = Clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(Clock::now() - begin).count();
    };
    for (int place = 0; elapsed() < options.seconds; place = (place + 1) % kPlaces) {
        if (elapsed() >= (flight.kills + 1) * options.killEvery) {
            server.killOne(random);
            ++flight.kills;
        }
        if (!flyTo(place, viewer, options, flight))
            return;
        if (elapsed() < options.seconds / 3.0 || !server.isWhole())
            continue;
        for (const pid_t process : {server.coordinator(), server.spared()})
            if (const auto figures = figuresOf(process, elapsed()))
                flight.figures[process].push_back(*figures);
    }
}

/// Whether the process stayed as it was.
bool report(const char* name, const std::vector<ProcessFigures>& samples, const Options& options) {
    if (samples.size() < 3) {
        fmt::print("{}: seen only {} times with all renderers drawing: let it last longer\n", name,
                   samples.size());
        return false;
    }
    const ProcessFigures& last = samples.back();
    const int descriptors = growthOf(&ProcessFigures::descriptors, samples);
    const int threads = growthOf(&ProcessFigures::threads, samples);
    const int memoryFiles =
        std::ranges::max_element(samples, {}, &ProcessFigures::memoryFiles)->memoryFiles;
    const double slope = residentSlope(samples);
    fmt::print(
        "{}: {:.1f} MiB resident, {:+.1f} MiB an hour; {} descriptors, grown by {}; {} memory "
        "files at most; {} threads, grown by {} ({} samples)\n",
        name, last.residentMebibytes, slope, last.descriptors, descriptors, memoryFiles,
        last.threads, threads, samples.size());
    return descriptors == 0 && threads == 0 && memoryFiles <= kMemoryFiles * options.renderers &&
           (options.maxSlope == 0 || slope <= options.maxSlope);
}

int run(const Options& options) {
    Server server(options);
    if (!server.start()) {
        fmt::print(stderr, "the server does not start: {}\n", server.errors());
        return 2;
    }
    const auto viewer = test::ViewerClient::connect(server.port());
    if (!viewer.ok() || !test::eventually(seconds(60), [&] {
            (void)(*viewer)->receive(std::chrono::milliseconds(100));
            return (*viewer)->state().has_home();
        })) {
        fmt::print(stderr, "no viewer: {}\n", viewer.status().ToString());
        return 2;
    }
    Flight flight;
    for (int place = 0; place < kPlaces; ++place)
        if (!flyTo(place, **viewer, options, flight))
            return 2;
    fly(server, **viewer, options, flight);
    fmt::print("{} exact pictures, {} renderers killed: {} wrong, {} did not come\n",
               flight.pictures, flight.kills, flight.wrong, flight.missing);
    bool isSteady = report("coordinator", flight.figures[server.coordinator()], options);
    isSteady &= report("renderer", flight.figures[server.spared()], options);
    return isSteady && flight.wrong == 0 && flight.missing == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr,
                   "usage: soak EYRIE SCENE [SECONDS] [KILL_EVERY] [RENDERERS] "
                   "[WIDTHxHEIGHT] [MAX_MIB_AN_HOUR] [SEED]\n");
        return 2;
    }
    Options options{.program = argv[1], .scene = argv[2]};
    int* const numbers[] = {&options.seconds, &options.killEvery, &options.renderers};
    for (int i = 0; i < 3 && argc > 3 + i; ++i) *numbers[i] = std::atoi(argv[3 + i]);
    if (argc > 6 && std::sscanf(argv[6], "%dx%d", &options.width, &options.height) != 2)
        return 2;
    if (argc > 7)
        options.maxSlope = std::atof(argv[7]);
    if (argc > 8)
        options.seed = static_cast<unsigned>(std::atoi(argv[8]));
    if (options.seconds < 1 || options.killEvery < 1 || options.renderers < 2) {
        fmt::print(stderr, "soak: at least 1 second, a kill each second and 2 renderers\n");
        return 2;
    }
    return run(options);
}
