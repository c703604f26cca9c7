// SPDX-License-Identifier: Apache-2.0
// What renderers and coordinator do with pictures between drawing and showing them: the merge by
// depth, and the codec that pictures travel in, on pictures drawn here.
//
//   build/release/bench/compositing FILE.eyt|FILE.eym... [WIDTHxHEIGHT=1280x720]
//
// Each file is drawn from two distances, whole and in two halves of its data, colour and depth. The
// halves are merged as pictures of the whole view. Times are in processor time of one thread: the
// median of 31, and the best, which is what the machine can do when others leave its memory alone.
// Rates are raw bytes a second; "at half" is the size that the drawn pixels would have in a picture
// that they half fill.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "fabric/depth_merge.h"
#include "fabric/status.h"
#include "renderer/renderer.h"
#include "wire/active_run.h"

namespace {

using namespace eyrie;

fabric::Camera cameraAt(const fabric::Box& bounds, double distance) {
    fabric::Camera camera;
    camera.target = bounds.centre();
    camera.eye =
        camera.target + glm::length(bounds.size()) * distance * fabric::Vec3(0.61, 0.63, 0.48);
    return camera;
}

struct Seconds {
    double median = 0;
    double best = 0;
};

Seconds measure(const std::function<void()>& prepare, const std::function<void()>& work) {
    std::vector<double> seconds;
    for (int i = 0; i < 31; ++i) {
        prepare();
        timespec begin{};
        timespec end{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
        work();
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
        seconds.push_back(static_cast<double>(end.tv_sec - begin.tv_sec) +
                          1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec));
    }
    std::ranges::sort(seconds);
    return {seconds[seconds.size() / 2], seconds[0]};
}

/// The picture as one of the whole view.
fabric::Image widened(const fabric::Image& image, int width, int height) {
    fabric::Image whole = fabric::makeImage({0, 0, width, height}, {}, true);
    fabric::paste(image, whole);
    return whole;
}

void printMerge(const fabric::Image& back, const fabric::Image& front) {
    fabric::Image target;
    const Seconds seconds =
        measure([&] { target = back; }, [&] { fabric::mergeDepth(front, target); });
    fmt::print("  merge of two halves of the data: {:.3f} ms, best {:.3f}\n", 1000 * seconds.median,
               1000 * seconds.best);
}

void printCodec(std::string_view what, const fabric::Image& image) {
    std::vector<std::string> bands;
    std::size_t encoded = 0;
    // The bands are written over each other where time is taken, as when they are sent.
    for (wire::BandEncoder encoder(image); !encoder.isDone();) {
        encoder.next(bands.emplace_back());
        encoded += bands.back().size();
    }
    const Seconds encoding = measure([] {},
                                     [&] {
                                         std::string band;
                                         for (wire::BandEncoder encoder(image); !encoder.isDone();)
                                             encoder.next(band);
                                     });
    fabric::Image copy = image;
    const Seconds decoding = measure([] {},
                                     [&] {
                                         wire::BandDecoder decoder(copy);
                                         for (const std::string& band : bands)
                                             if (!decoder.take(band).ok())
                                                 std::abort();
                                     });
    const auto pixels = static_cast<double>(image.colour.size());
    const double raw = pixels * (image.hasDepth() ? 8 : 4);
    fmt::print("  {:17} {:4}x{:<4} {:4.1f} % of raw", what, image.area.width, image.area.height,
               100 * static_cast<double>(encoded) / raw);
    if (image.hasDepth()) {
        const double drawn = pixels - static_cast<double>(std::ranges::count(image.depth, 0.0F));
        fmt::print(" ({:2.0f} % drawn, {:4.1f} at half)", 100 * drawn / pixels,
                   50 * static_cast<double>(encoded) / raw * pixels / drawn);
    }
    const auto rate = [&](double seconds) { return 1e-9 * raw / seconds; };
    fmt::print(", encode {:.2f} GB/s, best {:.2f}; decode {:.2f}, best {:.2f}\n",
               rate(encoding.median), rate(encoding.best), rate(decoding.median),
               rate(decoding.best));
}

absl::StatusOr<fabric::Image> draw(Renderer& renderer, const fabric::Camera& camera,
                                   const fabric::Range& range, int width, int height) {
    fabric::FrameData frame;
    frame.camera = camera;
    fabric::ChannelTask task;
    task.viewWidth = width;
    task.viewHeight = height;
    task.pixelViewport = {0, 0, width, height};
    task.range = range;
    task.wantsDepth = true;
    ASSIGN_OR_RETURN(fabric::ChannelResult result, renderer.render(frame, task));
    return std::move(result.image);
}

absl::Status runFile(Renderer& renderer, const std::string& path, int width, int height) {
    fabric::Scene scene;
    fabric::SceneObject& object = scene.objects.emplace_back();
    object.name = object.path = path;
    object.kind = path.ends_with(".eyt") ? fabric::ObjectKind::Terrain : fabric::ObjectKind::Mesh;
    ASSIGN_OR_RETURN(const fabric::SceneInfo info, renderer.openScene(scene));
    for (const double distance : {0.75, 0.45}) {
        fmt::print("{} from {} of its size\n", path, distance);
        const fabric::Camera camera = cameraAt(info.bounds, distance);
        ASSIGN_OR_RETURN(fabric::Image whole, draw(renderer, camera, {}, width, height));
        ASSIGN_OR_RETURN(const fabric::Image back, draw(renderer, camera, {0, 0.5}, width, height));
        ASSIGN_OR_RETURN(const fabric::Image front,
                         draw(renderer, camera, {0.5, 1}, width, height));
        printCodec("colour and depth", whole);
        printCodec("half the data", front);
        whole.depth.clear();
        printCodec("colour", whole);
        printMerge(widened(back, width, height), widened(front, width, height));
    }
    return absl::OkStatus();
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> files(argv + 1, argv + argc);
    int width = 1280;
    int height = 720;
    if (!files.empty() && std::sscanf(files.back().c_str(), "%dx%d", &width, &height) == 2)
        files.pop_back();
    if (files.empty() || files[0] == "--help") {
        fmt::print(stderr, "usage: compositing FILE.eyt|FILE.eym... [WIDTHxHEIGHT=1280x720]\n");
        return 2;
    }
    auto renderer = Renderer::create({});
    absl::Status status = renderer.status();
    for (std::size_t i = 0; i < files.size() && status.ok(); ++i)
        status = runFile(**renderer, files[i], width, height);
    if (!status.ok())
        fmt::print(stderr, "{}\n", status.ToString());
    return status.ok() ? 0 : 1;
}
