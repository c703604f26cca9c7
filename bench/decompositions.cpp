// SPDX-License-Identifier: Apache-2.0
// Whether every way to cut a frame gives the picture that it is to give.
//
//   build/release/bench/decompositions EYRIE FILE.eyt|FILE.eym [WIDTHxHEIGHT=1280x720]
//                                      [CAMERAS=20] [NAME...]
//
// Draws the same random cameras in each decomposition (or in those NAMEd), by four renderer
// processes, with as many frames in flight as its configuration's latency and one. Most are to
// equal the picture that one renderer in this process draws, in colour and depth; pixel, subpixel
// and zoom compounds what they are defined as, made here of pictures of that renderer. Prints, for
// each, how many pixels differ at most, and where. Exit status 1 where any does.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bench/decompositions/ways.h"
#include "coordinator/compound/jitter.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/one_channel.h"
#include "coordinator/frame/frame_sequence.h"
#include "fabric/log.h"
#include "fabric/status.h"
#include "tests/support/different_pixels.h"
#include "tests/support/local_pictures.h"
#include "tests/support/random_views.h"
#include "tests/support/renderer_farm.h"

namespace {

using namespace eyrie;
using namespace eyrie::bench;
using coordinator::FrameRequest;
using coordinator::FrameSequence;
using fabric::Image;
using fabric::Vec2;
using test::LocalPictures;

constexpr std::chrono::seconds kStartLimit{60};
constexpr int kRenderers = 4;

struct Options {
    std::string program;
    fabric::Scene scene;
    int width = 1280;
    int height = 720;
    int cameras = 20;
    std::vector<std::string> names;
};

/// How a way's pictures are asked for.
FrameRequest asked(FrameRequest view, const Way& way) {
    view.wantsDepth = way.meaning == Meaning::OneChannel && !way.isStereo;
    if (way.isStereo) {
        view.shown = {{}, {}};
        view.shown[0].eye = compound::Eye::Left;
        view.shown[1].eye = compound::Eye::Right;
    }
    return view;
}

std::size_t at(const Image& image, std::int32_t x, std::int32_t y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.area.width) +
           static_cast<std::size_t>(x);
}

/// The mean of four, rounded to the nearest.
fabric::Rgba mean(const fabric::Rgba& a, const fabric::Rgba& b, const fabric::Rgba& c,
                  const fabric::Rgba& d) {
    const auto of = [&](std::uint8_t fabric::Rgba::*channel) {
        return static_cast<std::uint8_t>((a.*channel + b.*channel + c.*channel + d.*channel + 2) /
                                         4);
    };
    return {of(&fabric::Rgba::r), of(&fabric::Rgba::g), of(&fabric::Rgba::b), of(&fabric::Rgba::a)};
}

/// By their definitions, made here. Sizes are even.
class Definition {
public:
    Definition(LocalPictures& here, const config::Configuration& configuration)
        : here_(here), single_(config::oneChannel(configuration)) {}

    absl::StatusOr<std::vector<Image>> pictures(const FrameRequest& view, const Way& way,
                                                std::size_t layout) {
        if (way.meaning == Meaning::OneChannel)
            return ofOneChannel(view, layout);
        Image whole = fabric::makeImage({0, 0, view.width, view.height}, {}, false);
        switch (way.meaning) {
            case Meaning::EveryFourth:
                RETURN_IF_ERROR(interleave(view, whole));
                break;
            case Meaning::MeanOfFour:
                RETURN_IF_ERROR(average(view, whole));
                break;
            case Meaning::TwiceAsFine:
                RETURN_IF_ERROR(shrink(view, whole));
                break;
            default:
                RETURN_IF_ERROR(enlarge(view, whole));
        }
        return std::vector{whole};
    }

private:
    absl::StatusOr<std::vector<Image>> ofOneChannel(const FrameRequest& view, std::size_t layout) {
        compound::PlanRequest request;
        for (const coordinator::Shown& shown : view.shown) {
            compound::Output& output = request.outputs.emplace_back();
            output.size = config::PixelSize{view.width, view.height};
            output.eye = shown.eye;
            output.wantsDepth = view.wantsDepth;
        }
        request.display.canvases.resize(1);
        request.display.canvases[0].layout = layout;
        request.fovYDegrees = view.camera.fovYDegrees;
        ASSIGN_OR_RETURN(const compound::Plan plan, compound::makePlan(single_, request));
        return here_.pictures(view, plan);
    }

    absl::Status interleave(const FrameRequest& view, Image& whole) {
        for (int i = 0; i < 4; ++i) {
            const int column = i % 2;
            const int row = i / 2;
            ASSIGN_OR_RETURN(const Image part,
                             here_.draw(view, fabric::Raster{view.width / 2,
                                                             view.height / 2,
                                                             Vec2(column - .5, row - .5),
                                                             {2, 2}}));
            for (int y = 0; y < part.area.height; ++y)
                for (int x = 0; x < part.area.width; ++x)
                    whole.colour[at(whole, 2 * x + column, 2 * y + row)] =
                        part.colour[at(part, x, y)];
        }
        return absl::OkStatus();
    }

    absl::Status average(const FrameRequest& view, Image& whole) {
        std::vector<Image> samples(4);
        for (int i = 0; i < 4; ++i) {
            const fabric::Raster raster{view.width, view.height, compound::jitter(i, 4), {1, 1}};
            ASSIGN_OR_RETURN(samples[static_cast<std::size_t>(i)], here_.draw(view, raster));
        }
        for (std::size_t p = 0; p < whole.colour.size(); ++p)
            whole.colour[p] = mean(samples[0].colour[p], samples[1].colour[p], samples[2].colour[p],
                                   samples[3].colour[p]);
        return absl::OkStatus();
    }

    absl::Status shrink(const FrameRequest& view, Image& whole) {
        const fabric::Raster raster{2 * view.width, 2 * view.height, {0, 0}, {.5, .5}};
        ASSIGN_OR_RETURN(const Image fine, here_.draw(view, raster));
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const auto of = [&](int right, int up) {
                    return fine.colour[at(fine, 2 * x + right, 2 * y + up)];
                };
                whole.colour[at(whole, x, y)] = mean(of(0, 0), of(1, 0), of(0, 1), of(1, 1));
            }
        return absl::OkStatus();
    }

    absl::Status enlarge(const FrameRequest& view, Image& whole) {
        const fabric::Raster raster{view.width / 2, view.height / 2, {0, 0}, {2, 2}};
        ASSIGN_OR_RETURN(const Image coarse, here_.draw(view, raster));
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x)
                whole.colour[at(whole, x, y)] = coarse.colour[at(coarse, x / 2, y / 2)];
        return absl::OkStatus();
    }

    LocalPictures& here_;
    const config::Configuration single_;
};

struct Comparison {
    std::size_t worst = 0;  ///< pixels of a picture
    std::size_t camera = 0;
    int incomplete = 0;
};

/// Pictures as they come, several in flight, against what they are to be.
absl::StatusOr<Comparison> compare(coordinator::FrameSource& frames,
                                   const std::vector<FrameRequest>& views, const Way& way,
                                   const std::vector<std::vector<Image>>& expected) {
    Comparison found;
    FrameSequence sequence;
    sequence.atOnce = frames.framesAtOnce();
    sequence.draw = [&](const auto& choose) { return frames.renderLatest(choose); };
    sequence.view = [&](std::size_t i) {
        return i < views.size() ? std::optional(asked(views[i], way)) : std::nullopt;
    };
    sequence.take = [&](const FrameSequence::Frame& frame) {
        RETURN_IF_ERROR(frame.drawn.status());
        const std::vector<Image>& right = expected[frame.index];
        found.incomplete += frame.drawn->statistics.complete ? 0 : 1;
        for (std::size_t i = 0; i < right.size(); ++i) {
            const Image& drawn = i == 0 ? frame.drawn->image : frame.drawn->further.at(i - 1);
            const std::size_t different = test::differentPixels(drawn, right[i]);
            if (different > found.worst)
                found = {different, frame.index, found.incomplete};
        }
        return absl::OkStatus();
    };
    RETURN_IF_ERROR(coordinator::drawSequence(sequence));
    return found;
}

std::string namesOf(const std::vector<Way>& ways) {
    std::string names;
    for (const Way& way : ways)
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", way.name);
    return names;
}

absl::StatusOr<bool> areAllRight(const Options& options) {
    std::vector<Way> ways = allWays();
    if (!options.names.empty())
        std::erase_if(ways, [&](const Way& way) {
            return std::ranges::find(options.names, way.name) == options.names.end();
        });
    if (!options.names.empty() && ways.size() != options.names.size())
        return absl::InvalidArgumentError(
            fmt::format("there is none of that name; there are {}", namesOf(allWays())));
    config::Findings findings;
    const config::Configuration configuration =
        config::readEqc(configurationOf(ways, options.width, options.height), findings);
    if (findings.hasErrors())
        return absl::InternalError(config::describe(findings, "decompositions"));
    ASSIGN_OR_RETURN(const auto here, LocalPictures::open(options.scene));
    coordinator::CoordinatorOptions coordinator;
    coordinator.configuration = configuration;
    coordinator.scene = options.scene;
    ASSIGN_OR_RETURN(const auto farm, test::RendererFarm::start(options.program, kRenderers,
                                                                std::move(coordinator)));
    if (!farm->awaitAllReady(kStartLimit))
        return absl::DeadlineExceededError("the renderers do not start: " +
                                           farm->frames().status().problem);
    auto views = test::randomViews(here->bounds(), options.cameras);
    for (FrameRequest& view : views) {
        view.width = options.width;
        view.height = options.height;
    }
    Definition definition(*here, configuration);
    const std::vector<std::vector<Image>> none;
    std::vector<std::vector<Image>> wholes;  // the same for all that are to equal one channel
    bool areRight = true;
    for (std::size_t layout = 0; layout < ways.size(); ++layout) {
        const Way& way = ways[layout];
        RETURN_IF_ERROR(farm->frames().configure({"0", way.name}));
        const bool isWhole = way.meaning == Meaning::OneChannel && !way.isStereo;
        std::vector<std::vector<Image>> expected = isWhole ? wholes : none;
        for (std::size_t i = expected.size(); i < views.size(); ++i) {
            ASSIGN_OR_RETURN(expected.emplace_back(),
                             definition.pictures(asked(views[i], way), way, layout));
        }
        if (isWhole)
            wholes = expected;
        ASSIGN_OR_RETURN(const Comparison found, compare(farm->frames(), views, way, expected));
        fmt::print("{:24} at most {} of {} pixels differ (camera {}), {} cameras{}\n", way.name,
                   found.worst, options.width * options.height, found.camera, views.size(),
                   found.incomplete == 0 ? "" : ", incomplete");
        areRight = areRight && found.worst == 0 && found.incomplete == 0;
    }
    return areRight;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr,
                   "usage: decompositions EYRIE FILE.eyt|FILE.eym [WIDTHxHEIGHT=1280x720] "
                   "[CAMERAS=20] [NAME...]\n");
        return 2;
    }
    spdlog::set_level(spdlog::level::err);
    Options options;
    options.program = argv[1];
    const std::string path = argv[2];
    options.scene.objects.push_back(
        {.name = "data",
         .kind = path.ends_with(".eyt") ? fabric::ObjectKind::Terrain : fabric::ObjectKind::Mesh,
         .path = path});
    if (argc > 3 && (std::sscanf(argv[3], "%dx%d", &options.width, &options.height) != 2 ||
                     options.width % 2 != 0 || options.height % 2 != 0)) {
        fmt::print(stderr, "'{}' is not WIDTHxHEIGHT, both even\n", argv[3]);
        return 2;
    }
    if (argc > 4)
        options.cameras = std::max(1, std::atoi(argv[4]));
    for (int i = 5; i < argc; ++i) options.names.emplace_back(argv[i]);
    const absl::StatusOr<bool> areRight = areAllRight(options);
    if (!areRight.ok())
        fmt::print(stderr, "{}\n", areRight.status().ToString());
    return areRight.ok() && *areRight ? 0 : 1;
}
