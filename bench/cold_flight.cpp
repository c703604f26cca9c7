// SPDX-License-Identifier: Apache-2.0
// What loading does to the frame times of a flight over terrain or a mesh.
//
//   build/release/bench/cold_flight FILE.eyt|FILE.eym [FRAMES=300] [TAU=1] [DEVICE_MIB=2048]
//   [HOST_MIB=1024]
//
// Flies three times, with interactive frames: with nothing loaded (the file is dropped from the
// system's cache, too), then twice more. On a machine that is not idle, compare the processor time
// of the thread that draws, with LP_NUM_THREADS=0 so that llvmpipe does all its work there. Prints
// frame times, also as ratios to the same frame of the second flight, what was missing in each
// tenth of the flight, and the greatest use of memory; then rests at the end of the flight until
// nothing more is loaded.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "renderer/renderer.h"

namespace {

using namespace eyrie;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr int kTenths = 10;

struct Options {
    std::string path;
    int frames = 300;
    double tau = 1;
    RendererOptions renderer;
};

void dropFromSystemCache(const std::string& path) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return;
    posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
    close(file);
}

/// An S across the data, just above them, looking ahead and a little down.
fabric::Camera cameraAt(const fabric::Box& bounds, double t) {
    const auto at = [&](double s) {
        const fabric::Vec3 size = bounds.size();
        return bounds.min + fabric::Vec3(size.x * (0.1 + 0.8 * s),
                                         size.y * (0.5 + 0.3 * std::sin(2 * M_PI * s)),
                                         size.z + 0.02 * size.x);
    };
    fabric::Camera camera;
    camera.eye = at(t);
    camera.target = at(t + 0.05) - fabric::Vec3(0, 0, 0.03 * bounds.size().x);
    return camera;
}

double quantile(std::vector<double> values, double q) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

absl::StatusOr<fabric::FrameStatistics> draw(Renderer& renderer, const Options& options,
                                             const fabric::Camera& camera) {
    fabric::FrameData frame;
    frame.camera = camera;
    frame.tauPixels = options.tau;
    fabric::ChannelTask task;
    task.viewWidth = kWidth;
    task.viewHeight = kHeight;
    task.pixelViewport = {0, 0, kWidth, kHeight};
    task.completeness = fabric::Completeness::Interactive;
    auto result = renderer.render(frame, task);
    if (!result.ok())
        return result.status();
    return result->statistics;
}

/// Of this thread so far.
double processorMilliseconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

struct Flight {
    std::vector<fabric::FrameStatistics> frames;
    std::vector<double> processorMilliseconds;
    RendererMemory most;
};

absl::StatusOr<Flight> fly(Renderer& renderer, const fabric::Box& bounds, const Options& options) {
    Flight flight;
    for (int i = 0; i < options.frames; ++i) {
        const double before = processorMilliseconds();
        auto statistics =
            draw(renderer, options, cameraAt(bounds, static_cast<double>(i) / options.frames));
        if (!statistics.ok())
            return statistics.status();
        flight.frames.push_back(*statistics);
        flight.processorMilliseconds.push_back(processorMilliseconds() - before);
        flight.most.deviceBytes = std::max(flight.most.deviceBytes, renderer.memory().deviceBytes);
        flight.most.hostBytes = std::max(flight.most.hostBytes, renderer.memory().hostBytes);
    }
    return flight;
}

std::vector<double> times(const Flight& flight) {
    std::vector<double> milliseconds;
    for (const auto& frame : flight.frames) milliseconds.push_back(frame.milliseconds.total);
    return milliseconds;
}

void print(const char* name, const Flight& flight) {
    std::vector<double> cull;
    for (const auto& frame : flight.frames) cull.push_back(frame.milliseconds.cull);
    fmt::print("{}: choosing and uploading take {:.1f} ms (median), {:.1f} ms (max)\n", name,
               quantile(cull, 0.5), quantile(cull, 1));
    fmt::print("  memory: {} MiB on the device, {} MiB of pages at most\n",
               flight.most.deviceBytes >> 20, flight.most.hostBytes >> 20);
    fmt::print(
        "  tenth of the flight: pages missing / loaded, triangles, tau achieved (medians)\n");
    const std::size_t tenth = std::max<std::size_t>(flight.frames.size() / kTenths, 1);
    for (std::size_t begin = 0; begin + tenth <= flight.frames.size(); begin += tenth) {
        std::vector<double> missing, triangles, tau;
        std::uint64_t loaded = 0;
        for (std::size_t i = begin; i < begin + tenth; ++i) {
            const fabric::FrameStatistics& frame = flight.frames[i];
            missing.push_back(static_cast<double>(frame.pagesMissing));
            triangles.push_back(static_cast<double>(frame.triangles));
            tau.push_back(frame.tauAchievedPixels);
            loaded += frame.pagesLoaded;
        }
        fmt::print("  {:>5.0f} / {:<5} {:>9.0f} {:>9.3f} px\n", quantile(missing, 0.5), loaded,
                   quantile(triangles, 0.5), quantile(tau, 0.5));
    }
}

/// Views differ in what they cost: each cold frame beside the same one when all is loaded.
void compare(const char* what, const std::vector<double>& cold, const std::vector<double>& warm) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < cold.size(); ++i) ratios.push_back(cold[i] / warm[i]);
    const auto slow =
        std::count_if(ratios.begin(), ratios.end(), [](double ratio) { return ratio > 1.5; });
    fmt::print(
        "{}: cold median {:.1f} ms, p95 {:.1f} ms, max {:.1f} ms; warm {:.1f}, {:.1f}, {:.1f}; "
        "cold / warm, frame by frame: median {:.2f}, p95 {:.2f}, max {:.2f}, above 1.5: {} of {}\n",
        what, quantile(cold, 0.5), quantile(cold, 0.95), quantile(cold, 1), quantile(warm, 0.5),
        quantile(warm, 0.95), quantile(warm, 1), quantile(ratios, 0.5), quantile(ratios, 0.95),
        quantile(ratios, 1), slow, ratios.size());
}

/// Frames longer than 1.5 times the median that are not when all is loaded. `again` is a second
/// flight with all loaded: what the machine does by itself.
void tellOfLoading(const Flight& cold, const Flight& warm, const Flight& again) {
    const double tooLong = 1.5 * quantile(times(warm), 0.5);
    int loading = 0, late = 0, lateByItself = 0;
    for (std::size_t i = 0; i < cold.frames.size(); ++i) {
        const bool isLongWarm = warm.frames[i].milliseconds.total > tooLong;
        const bool isLoading = cold.frames[i].pagesLoaded > 0;
        loading += isLoading ? 1 : 0;
        late += isLoading && !isLongWarm && cold.frames[i].milliseconds.total > tooLong ? 1 : 0;
        lateByItself += !isLongWarm && again.frames[i].milliseconds.total > tooLong ? 1 : 0;
    }
    fmt::print("longer than 1.5 times the median, {:.1f} ms, and not once all is loaded: {} of {} ",
               tooLong, late, loading);
    fmt::print("frames that loaded pages, {} of {} that load nothing\n", lateByItself,
               again.frames.size());
}

/// Frames of one view until nothing has been loaded for a while.
absl::Status rest(Renderer& renderer, const fabric::Box& bounds, const Options& options) {
    std::uint64_t loaded = 0;
    int frames = 0;
    int quiet = 0;
    fabric::FrameStatistics last;
    for (; quiet < 20 && frames < 1000; ++frames) {
        auto statistics = draw(renderer, options, cameraAt(bounds, 1));
        if (!statistics.ok())
            return statistics.status();
        last = *statistics;
        quiet = last.pagesLoaded == 0 ? quiet + 1 : 0;
        loaded += last.pagesLoaded;
    }
    fmt::print("at rest: {} pages loaded in {} frames, then none; {} missing, tau {:.3f} px\n",
               loaded, frames - quiet, last.pagesMissing, last.tauAchievedPixels);
    return absl::OkStatus();
}

absl::Status run(const Options& options) {
    dropFromSystemCache(options.path);
    auto renderer = Renderer::create(options.renderer);
    if (!renderer.ok())
        return renderer.status();
    fabric::Scene scene;
    scene.objects.push_back({.name = "flown over",
                             .kind = options.path.ends_with(".eym") ? fabric::ObjectKind::Mesh
                                                                    : fabric::ObjectKind::Terrain,
                             .path = options.path});
    auto info = (*renderer)->openScene(scene);
    if (!info.ok())
        return info.status();
    fmt::print("{} on {}, {} x {}, tau {} px, {} triangles at full resolution\n", options.path,
               (*renderer)->device().renderer, kWidth, kHeight, options.tau, info->triangles);
    // Shaders are compiled when first needed; that is not what is measured.
    if (auto first = draw(**renderer, options, cameraAt(info->bounds, -10)); !first.ok())
        return first.status();
    auto cold = fly(**renderer, info->bounds, options);
    if (!cold.ok())
        return cold.status();
    auto warm = fly(**renderer, info->bounds, options);
    if (!warm.ok())
        return warm.status();
    print("cold", *cold);
    print("warm", *warm);
    compare("wall clock", times(*cold), times(*warm));
    compare("processor", cold->processorMilliseconds, warm->processorMilliseconds);
    auto again = fly(**renderer, info->bounds, options);
    if (!again.ok())
        return again.status();
    tellOfLoading(*cold, *warm, *again);
    return rest(**renderer, info->bounds, options);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || std::string(argv[1]) == "--help") {
        fmt::print(stderr,
                   "usage: cold_flight FILE.eyt|FILE.eym [FRAMES=300] [TAU=1] [DEVICE_MIB=2048] "
                   "[HOST_MIB=1024]\n");
        return 2;
    }
    Options options;
    options.path = argv[1];
    if (argc > 2)
        options.frames = std::max(kTenths, std::atoi(argv[2]));
    if (argc > 3)
        options.tau = std::atof(argv[3]);
    if (argc > 4)
        options.renderer.memoryBytes = std::strtoull(argv[4], nullptr, 10) << 20;
    if (argc > 5)
        options.renderer.hostMemoryBytes = std::strtoull(argv[5], nullptr, 10) << 20;
    if (const absl::Status status = run(options); !status.ok()) {
        fmt::print(stderr, "{}\n", status.ToString());
        return 1;
    }
    return 0;
}
