// SPDX-License-Identifier: Apache-2.0
// Frame times of one renderer on an orbit, beside the error at which they were reached.
//
//   build/release/bench/orbit FILE.eyt|FILE.eym [FRAMES=120] [WIDTHxHEIGHT=1280x720] [LOOK.json]
//
// Prints one line per tau: median and p95 frame time, processor time, triangles, tau achieved.
// Single process, no network: the ceiling that distribution is measured against.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "renderer/renderer.h"
#include "wire/json.h"

namespace {

using namespace eyrie;

struct Options {
    fabric::SceneObject object;
    int frames = 120;
    int width = 1280;
    int height = 720;
    fabric::Look look;
};

fabric::Camera orbitCamera(const fabric::Box& bounds, double turn) {
    fabric::Camera camera;
    camera.target = bounds.centre();
    const double radius = glm::length(bounds.size()) * 0.75;
    const double azimuth = turn * 2 * M_PI;
    const double elevation = 0.5;
    camera.eye = camera.target + radius * fabric::Vec3(std::cos(azimuth) * std::cos(elevation),
                                                       std::sin(azimuth) * std::cos(elevation),
                                                       std::sin(elevation));
    return camera;
}

/// Processor time of all threads so far: on llvmpipe, what drawing costs whatever else runs here.
double processorMilliseconds() {
    return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double quantile(std::vector<double>& values, double q) {
    const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

absl::Status runOrbit(Renderer& renderer, const fabric::SceneInfo& info, const Options& options,
                      double tau) {
    std::vector<double> milliseconds;
    std::vector<double> drawMilliseconds;
    std::vector<double> readbackMilliseconds;
    std::uint64_t triangles = 0;
    double achieved = 0;
    const double processorStart = processorMilliseconds();
    for (int i = 0; i < options.frames; ++i) {
        fabric::FrameData frame;
        frame.camera = orbitCamera(info.bounds, static_cast<double>(i) / options.frames);
        frame.tauPixels = tau;
        frame.look = options.look;
        fabric::ChannelTask task;
        task.viewWidth = options.width;
        task.viewHeight = options.height;
        task.pixelViewport = {0, 0, options.width, options.height};
        auto result = renderer.render(frame, task);
        if (!result.ok())
            return result.status();
        milliseconds.push_back(result->statistics.milliseconds.total);
        drawMilliseconds.push_back(result->statistics.milliseconds.draw);
        readbackMilliseconds.push_back(result->statistics.milliseconds.readback);
        triangles += result->statistics.triangles;
        achieved = std::max(achieved, result->statistics.tauAchievedPixels);
    }
    const double p95 = quantile(milliseconds, 0.95);
    const double processor = processorMilliseconds() - processorStart;
    fmt::print(
        "tau {:>4} px  achieved {:>7.3f} px  median {:>7.2f} ms  p95 {:>7.2f} ms  (draw {:.2f}, "
        "readback {:.2f}; processor {:.2f})  {:>9} triangles\n",
        tau, achieved, quantile(milliseconds, 0.5), p95, quantile(drawMilliseconds, 0.5),
        quantile(readbackMilliseconds, 0.5), processor / options.frames,
        triangles / static_cast<std::uint64_t>(options.frames));
    return absl::OkStatus();
}

absl::Status run(const Options& options) {
    auto renderer = Renderer::create({});
    if (!renderer.ok())
        return renderer.status();
    fabric::Scene scene;
    scene.objects.push_back(options.object);
    auto info = (*renderer)->openScene(scene);
    if (!info.ok())
        return info.status();
    fmt::print("{} on {}, {} x {}, {} triangles at full resolution\n", options.object.path,
               (*renderer)->device().renderer, options.width, options.height, info->triangles);
    if (absl::Status warmUp = runOrbit(**renderer, *info, options, 1); !warmUp.ok())
        return warmUp;
    for (const double tau : {0.5, 1.0, 2.0, 4.0, 8.0})
        if (absl::Status status = runOrbit(**renderer, *info, options, tau); !status.ok())
            return status;
    return absl::OkStatus();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || std::string_view(argv[1]) == "--help") {
        fmt::print(stderr,
                   "usage: orbit FILE.eyt|FILE.eym [FRAMES=120] [WIDTHxHEIGHT=1280x720] "
                   "[LOOK.json]\n");
        return 2;
    }
    Options options;
    options.object.name = options.object.path = argv[1];
    options.object.kind = options.object.path.ends_with(".eyt") ? fabric::ObjectKind::Terrain
                                                                : fabric::ObjectKind::Mesh;
    if (argc > 2)
        options.frames = std::max(1, std::atoi(argv[2]));
    if (argc > 3 && std::sscanf(argv[3], "%dx%d", &options.width, &options.height) != 2) {
        fmt::print(stderr, "'{}' is not WIDTHxHEIGHT\n", argv[3]);
        return 2;
    }
    if (argc > 4) {
        std::ifstream file(argv[4]);
        const std::string text(std::istreambuf_iterator<char>(file), {});
        const auto look = wire::lookFromJson(text, argv[4]);
        if (!look.ok()) {
            fmt::print(stderr, "{}\n", look.status().ToString());
            return 2;
        }
        options.look = *look;
    }
    if (const absl::Status status = run(options); !status.ok()) {
        fmt::print(stderr, "{}\n", status.ToString());
        return 1;
    }
    return 0;
}
