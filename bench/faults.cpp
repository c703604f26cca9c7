// SPDX-License-Identifier: Apache-2.0
// What renderers that die and stop cost: no pixel, and how much time.
//
//   build/release/bench/faults EYRIE FILE.eyt|FILE.eym [2D|DB|direct-send] [KILLS=100]
//                              [BRIEF_STOPS=880] [LONG_STOPS=20] [FRAMES=10000] [RENDERERS=3]
//                              [WIDTHxHEIGHT=320x180] [SEED=1]
//
// Draws an orbit again and again, with as many frames in flight as the configuration's latency and
// one, while renderer processes are killed, or stopped and continued, at
// random moments of frames, never all at once. Compares every picture, depths included, with that
// of the same camera from before the first fault. Prints the pixels that differ, and times: from a
// fault to the next complete picture, to the last of those that were under way, to where the
// renderer is known to be dead, and from its
// restart or continuation to where it draws again. Exit status 1 when a picture was wrong or could
// not be had.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "bench/faulty_farm.h"
#include "coordinator/frame/frame_sequence.h"
#include "fabric/log.h"
#include "tests/support/different_pixels.h"

namespace {

using namespace eyrie;
using namespace eyrie::bench;
using coordinator::FrameRequest;
using coordinator::FrameSequence;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kCameras = 40;
constexpr seconds kStartLimit{60};
constexpr seconds kRecoveryLimit{30};

struct Options {
    FaultyFarm::Options farm;
    int kills = 100;
    int briefStops = 880;
    int longStops = 20;
    int frames = 10'000;
    int width = 320;
    int height = 180;
};

std::vector<FrameRequest> orbit(const fabric::Box& bounds, const Options& options) {
    std::vector<FrameRequest> views(kCameras);
    for (int i = 0; i < kCameras; ++i) {
        FrameRequest& view = views[static_cast<std::size_t>(i)];
        const double azimuth = 2 * M_PI * i / kCameras;
        view.camera.target = bounds.centre();
        view.camera.eye =
            view.camera.target + glm::length(bounds.size()) * 0.7 *
                                     fabric::Vec3(std::cos(azimuth), std::sin(azimuth), 0.6);
        view.width = options.width;
        view.height = options.height;
        view.wantsDepth = true;
    }
    return views;
}

struct Frame {
    Clock::time_point begin;
    Clock::time_point end;
};

/// What was drawn. Others than those that draw read `begun` only.
struct Flight {
    std::vector<Frame> frames;
    std::atomic<int> begun{0};
    std::size_t wrongPixels = 0;
    int wrongFrames = 0;
    int failures = 0;
    int incomplete = 0;

    void add(const FrameSequence::Frame& frame, const fabric::Image& expected) {
        if (!frame.drawn.ok()) {
            ++failures;
            fmt::print(stderr, "{}\n", frame.drawn.status().ToString());
            return;
        }
        frames.push_back({frame.begun, frame.arrived});
        const std::size_t wrong = test::differentPixels(frame.drawn->image, expected);
        wrongPixels += wrong;
        wrongFrames += wrong != 0 ? 1 : 0;
        incomplete += frame.drawn->statistics.complete ? 0 : 1;
    }
};

/// Until all `least` frames are drawn and the harm is done.
void fly(coordinator::FrameSource& source, const std::vector<FrameRequest>& views,
         const std::vector<fabric::Image>& expected, int least, const std::atomic<bool>& harmIsDone,
         Flight& flight) {
    FrameSequence sequence;
    sequence.atOnce = source.framesAtOnce();
    sequence.draw = [&](const auto& choose) { return source.renderLatest(choose); };
    sequence.view = [&](std::size_t index) -> std::optional<FrameRequest> {
        if (flight.begun >= least && harmIsDone)
            return std::nullopt;
        ++flight.begun;
        return views[index % views.size()];
    };
    sequence.take = [&](const FrameSequence::Frame& frame) {
        flight.add(frame, expected[frame.index % expected.size()]);
        return absl::OkStatus();
    };
    drawSequence(sequence).IgnoreError();  // none ends it
    fmt::print("{} frames in flight\n", sequence.atOnce);
}

std::vector<Fault> shuffledFaults(const Options& options) {
    std::vector<Fault> faults(static_cast<std::size_t>(options.kills), Fault::Kill);
    faults.resize(faults.size() + static_cast<std::size_t>(options.briefStops), Fault::BriefStop);
    faults.resize(faults.size() + static_cast<std::size_t>(options.longStops), Fault::LongStop);
    std::mt19937 random(options.farm.seed);
    std::shuffle(faults.begin(), faults.end(), random);
    return faults;
}

/// Spreads the faults over the flight: the next one at a random moment of the first frame that is
/// its own and has enough renderers.
void doHarm(FaultyFarm& farm, const Flight& flight, const Options& options, double frameSeconds) {
    const std::vector<Fault> faults = shuffledFaults(options);
    std::mt19937 random(options.farm.seed + 1);
    std::uniform_real_distribution<double> moment(0, frameSeconds);
    std::size_t done = 0;
    const double framesAFault =
        static_cast<double>(options.frames) / static_cast<double>(faults.size());
    while (done < faults.size()) {
        farm.tend();
        if (flight.begun >= static_cast<int>(static_cast<double>(done) * framesAFault)) {
            std::this_thread::sleep_for(std::chrono::duration<double>(moment(random)));
            done += farm.inject(faults[done]) ? 1U : 0U;
        }
        std::this_thread::sleep_for(milliseconds(1));
    }
    const auto end = Clock::now() + kRecoveryLimit;
    while (!farm.isWhole() && Clock::now() < end) {
        farm.tend();
        std::this_thread::sleep_for(milliseconds(1));
    }
}

void printTimes(std::string_view what, std::vector<double> times) {
    if (times.empty())
        return;
    std::sort(times.begin(), times.end());
    const auto at = [&](double q) {
        return times[static_cast<std::size_t>(q * static_cast<double>(times.size() - 1))];
    };
    fmt::print("{:44} {:6} {:8.0f} {:8.0f} {:8.0f} ms\n", what, times.size(), at(0.5), at(0.95),
               times.back());
}

std::string_view nameOf(Fault fault) {
    return fault == Fault::Kill ? "kill" : fault == Fault::BriefStop ? "brief stop" : "stop of 4 s";
}

double millisecondsBetween(Clock::time_point begin, Clock::time_point end) {
    return std::chrono::duration<double, std::milli>(end - begin).count();
}

void printFault(Fault fault, const std::vector<Event>& events, const std::vector<Frame>& frames) {
    std::vector<double> complete, underWay, dead, back;
    for (const Event& event : events) {
        if (event.fault != fault)
            continue;
        const auto next = std::lower_bound(
            frames.begin(), frames.end(), event.at,
            [](const Frame& frame, Clock::time_point at) { return frame.end < at; });
        if (next != frames.end())
            complete.push_back(millisecondsBetween(event.at, next->end));
        const auto later = std::lower_bound(
            frames.begin(), frames.end(), event.at,
            [](const Frame& frame, Clock::time_point at) { return frame.begin < at; });
        if (later != frames.begin() && std::prev(later)->end >= event.at)
            underWay.push_back(millisecondsBetween(event.at, std::prev(later)->end));
        if (event.dead)
            dead.push_back(millisecondsBetween(event.at, *event.dead));
        if (event.mended && event.back)
            back.push_back(millisecondsBetween(*event.mended, *event.back));
    }
    printTimes(fmt::format("{}: to the next complete picture", nameOf(fault)), complete);
    printTimes(fmt::format("{}: to the last that was under way", nameOf(fault)), underWay);
    printTimes(fmt::format("{}: to being known as dead", nameOf(fault)), dead);
    printTimes(fmt::format("{}: from its end to drawing again", nameOf(fault)), back);
}

void print(const Flight& flight, const std::vector<Event>& events) {
    std::vector<double> intervals, latencies;
    int hit = 0;
    for (const Frame& frame : flight.frames) {
        latencies.push_back(millisecondsBetween(frame.begin, frame.end));
        if (&frame != &flight.frames.front())
            intervals.push_back(millisecondsBetween((&frame - 1)->end, frame.end));
        hit += std::any_of(events.begin(), events.end(), [&](const Event& event) {
            return event.at >= frame.begin && event.at <= frame.end;
        });
    }
    fmt::print(
        "{} frames, {} with faults: {} wrong pixels in {} of them, {} incomplete, {} failed\n",
        flight.frames.size(), hit, flight.wrongPixels, flight.wrongFrames, flight.incomplete,
        flight.failures);
    fmt::print("{:44} {:>6} {:>8} {:>8} {:>8}\n", "", "number", "p50", "p95", "max");
    printTimes("from picture to picture", intervals);
    printTimes("from a view to its picture", latencies);
    for (const Fault fault : {Fault::Kill, Fault::BriefStop, Fault::LongStop})
        printFault(fault, events, flight.frames);
}

int run(const Options& options) {
    spdlog::set_level(spdlog::level::err);
    const auto farm = FaultyFarm::start(options.farm);
    if (!farm.ok() || !(*farm)->awaitAllReady(kStartLimit)) {
        fmt::print(stderr, "the renderers do not start: {}\n",
                   farm.ok() ? (*farm)->frames().status().problem : farm.status().ToString());
        return 2;
    }
    coordinator::FrameSource& frames = (*farm)->frames();
    const auto views = orbit(frames.status().sceneInfo.bounds, options);
    std::vector<fabric::Image> expected;
    double frameSeconds = 0;
    for (const FrameRequest& view : views) {
        const auto drawn = frames.renderFrame(view);
        if (!drawn.ok() || !drawn->statistics.complete) {
            fmt::print(stderr, "no picture before any fault: {}\n", drawn.status().ToString());
            return 2;
        }
        frameSeconds = drawn->statistics.milliseconds.total / 1000;
        expected.push_back(drawn->image);
    }
    Flight flight;
    std::atomic<bool> harmIsDone{false};
    // Processes end with the thread that started them, so it stays.
    std::jthread harm([&](const std::stop_token& flightIsOver) {
        doHarm(**farm, flight, options, frameSeconds);
        harmIsDone = true;
        while (!flightIsOver.stop_requested()) std::this_thread::sleep_for(milliseconds(5));
    });
    fly(frames, views, expected, options.frames, harmIsDone, flight);
    harm.request_stop();
    harm.join();
    print(flight, (*farm)->events());
    return flight.wrongPixels == 0 && flight.failures == 0 && flight.incomplete == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr,
                   "usage: faults EYRIE FILE [2D|DB|direct-send] [KILLS] [BRIEF_STOPS] "
                   "[LONG_STOPS] [FRAMES] "
                   "[RENDERERS] [WIDTHxHEIGHT] [SEED]\n");
        return 2;
    }
    Options options;
    options.farm.program = argv[1];
    const std::string path = argv[2];
    options.farm.scene.objects.push_back(
        {.name = "data",
         .kind = path.ends_with(".eyt") ? fabric::ObjectKind::Terrain : fabric::ObjectKind::Mesh,
         .path = path});
    if (argc > 3)
        options.farm.layout = std::string_view(argv[3]) == "DB" ? "DB dynamic" : argv[3];
    int* const numbers[] = {&options.kills, &options.briefStops, &options.longStops,
                            &options.frames, &options.farm.renderers};
    for (int i = 0; i < 5 && argc > 4 + i; ++i) *numbers[i] = std::atoi(argv[4 + i]);
    if (argc > 9 && std::sscanf(argv[9], "%dx%d", &options.width, &options.height) != 2)
        return 2;
    if (argc > 10)
        options.farm.seed = static_cast<unsigned>(std::atoi(argv[10]));
    return run(options);
}
