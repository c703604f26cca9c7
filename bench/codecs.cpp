// SPDX-License-Identifier: Apache-2.0
// What moving pictures take as JPEG and as H.264, at the levels that viewers get.
//
//   build/release/bench/codecs SCENE [FLIGHT=walkthrough] [FRAMES=90] [WIDTHxHEIGHT=1280x720]
//
// Draws FRAMES pictures of a flight, 30 a second of it, and codes each at every level of
// stream::QualityControl as a JPEG and, where there is a stream of that level, as the next picture
// of it. Prints bytes and milliseconds of this thread's processor time, medians over all but keys,
// and decibels of red, green and blue against what was drawn, at the size of the level.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/flights.h"
#include "cli/picture_source.h"
#include "coordinator/stream/quality.h"
#include "coordinator/stream/shrink.h"
#include "tests/video/decoded.h"
#include "video/load.h"
#include "wire/jpeg.h"

namespace {

using namespace eyrie;
using stream::QualityControl;

double processorMilliseconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

struct Taken {
    std::vector<double> bytes;
    std::vector<double> milliseconds;
    std::vector<double> decibels;

    void add(std::size_t size, double since) {
        bytes.push_back(static_cast<double>(size));
        milliseconds.push_back(processorMilliseconds() - since);
    }
};

double median(std::vector<double> values) {
    if (values.empty())
        return 0;
    std::ranges::sort(values);
    return values[values.size() / 2];
}

template <typename T>
T orEnd(absl::StatusOr<T> value) {
    if (value.ok())
        return *std::move(value);
    fmt::print(stderr, "{}\n", value.status().ToString());
    std::exit(1);
}

struct Level {
    std::unique_ptr<video::StreamEncoder> encoder;  ///< null: there is no stream
    std::unique_ptr<video::Decoder> decoder;
    Taken jpeg;
    Taken stream;
    double keyBytes = 0;
};

double psnr(const fabric::Image& seen, const fabric::Image& drawn) {
    double sum = 0;
    for (std::size_t i = 0; i < drawn.colour.size(); ++i) {
        const fabric::Rgba& a = seen.colour[i];
        const fabric::Rgba& b = drawn.colour[i];
        for (const int off : {a.r - b.r, a.g - b.g, a.b - b.b}) sum += off * off;
    }
    return 10 * std::log10(255.0 * 255 * 3 * static_cast<double>(drawn.colour.size()) / sum);
}

void code(Level& level, int index, const fabric::Image& image) {
    const stream::Level& settings = QualityControl::level(index);
    double start = processorMilliseconds();
    const auto jpeg =
        orEnd(wire::encodeJpeg(image, settings.quality, wire::ChromaSubsampling::Half));
    level.jpeg.add(jpeg.size(), start);
    level.jpeg.decibels.push_back(psnr(orEnd(wire::decodeJpeg(jpeg)), image));
    if (QualityControl::streamLevel(index) != index)
        return;
    if (level.decoder == nullptr)
        level.decoder = std::make_unique<video::Decoder>();
    if (level.encoder == nullptr)
        level.encoder =
            orEnd(orEnd(video::load())
                      ->makeStream({image.area.width, image.area.height, settings.rateFactor}));
    start = processorMilliseconds();
    const video::StreamPicture picture = orEnd(level.encoder->encode(image, false));
    if (picture.isKey)
        level.keyBytes = static_cast<double>(picture.bytes.size());
    else
        level.stream.add(picture.bytes.size(), start);
    if (const video::Frame frame = level.decoder->decode(picture.bytes))
        level.stream.decibels.push_back(video::psnr(*frame, image));
}

}  // namespace

int main(int argc, char** argv) {
    int width = 1280;
    int height = 720;
    const bool isSized = argc < 5 || std::sscanf(argv[4], "%dx%d", &width, &height) == 2;
    if (argc < 2 || !isSized) {
        fmt::print(stderr, "usage: codecs SCENE [FLIGHT] [FRAMES] [WIDTHxHEIGHT]\n");
        return 2;
    }
    const int count = argc > 3 ? std::max(2, std::atoi(argv[3])) : 90;
    cli::PictureSourceOptions quiet;
    quiet.quiet = true;
    const auto pictures = orEnd(cli::PictureSource::open(argv[1], quiet, {}));
    const auto named = orEnd(cli::bench::NamedFlight::read(argc > 2 ? argv[2] : "walkthrough"));
    const fabric::Flight flight = orEnd(named.over(pictures->sceneInfo().bounds)).flight;
    std::vector<Level> levels(static_cast<std::size_t>(QualityControl::levelCount()));
    for (int i = 0; i < count; ++i) {
        coordinator::FrameRequest request;
        request.camera = flight.at(std::min(flight.seconds(), i / 30.0));
        request.width = width;
        request.height = height;
        request.tauPixels = 1;
        const coordinator::RenderedFrame frame = orEnd(pictures->draw(request));
        for (int index = 0; index < QualityControl::levelCount(); ++index) {
            const double scale = QualityControl::level(index).scale;
            const auto side = [&](int whole) {
                return static_cast<int>(std::lround(scale * whole));
            };
            code(levels[static_cast<std::size_t>(index)], index,
                 scale < 1 ? stream::shrunk(frame.image, side(width), side(height)) : frame.image);
        }
    }
    const double best = median(levels[0].jpeg.bytes);
    for (int index = 0; index < QualityControl::levelCount(); ++index) {
        const stream::Level& settings = QualityControl::level(index);
        const Level& level = levels[static_cast<std::size_t>(index)];
        const auto tell = [best](const std::string& how, const Taken& taken) {
            fmt::print("{}: {:.1f} kB ({:.2f} of the best), {:.1f} ms, {:.1f} dB", how,
                       median(taken.bytes) / 1e3, median(taken.bytes) / best,
                       median(taken.milliseconds), median(taken.decibels));
        };
        tell(fmt::format("scale {:.2f}, JPEG {}", settings.scale, settings.quality), level.jpeg);
        if (level.encoder != nullptr) {
            tell(fmt::format("; H.264 crf {}", settings.rateFactor), level.stream);
            fmt::print(", a key {:.1f} kB", level.keyBytes / 1e3);
        }
        fmt::print("\n");
    }
    return 0;
}
