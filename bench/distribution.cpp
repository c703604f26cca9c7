// SPDX-License-Identifier: Apache-2.0
// What distribution costs and brings: frame rates of one renderer in this process, of one behind
// the coordinator, and of one and two that have one core each, beside the error they reached.
//
//   build/release/bench/distribution EYRIE FILE.eyt|FILE.eym [2D|DB] [FRAMES=120]
//                                    [WIDTHxHEIGHT=1280x720] [TAU=1] [REPETITIONS=5] [VIEWERS=2]
//
// Draws an orbit, complete frames without depth, by turns in each way; prints medians of the
// repetitions, and the processor time of a frame in this process and in the renderers'. VIEWERS ask
// for frames at the same time: with one, a renderer waits until its last picture has arrived. Exit
// status 1 when a picture differs from the local one.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <sched.h>
#include <time.h>

#include "coordinator/coordinator.h"
#include "fabric/log.h"
#include "fabric/status.h"
#include "renderer/renderer.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace eyrie;
using Clock = std::chrono::steady_clock;
using coordinator::FrameRequest;
using coordinator::RenderedFrame;

constexpr std::chrono::seconds kStartLimit{60};

struct Options {
    std::string program;
    fabric::Scene scene;
    std::string layout = "2D";
    int frames = 120;
    int width = 1280;
    int height = 720;
    double tau = 1;
    int repetitions = 5;
    int viewers = 2;
};

FrameRequest viewOf(const fabric::Box& bounds, const Options& options, int frame) {
    const double azimuth = 2 * M_PI * frame / options.frames;
    FrameRequest view;
    view.camera.target = bounds.centre();
    view.camera.eye =
        view.camera.target + glm::length(bounds.size()) * 0.75 *
                                 fabric::Vec3(std::cos(azimuth) * std::cos(0.5),
                                              std::sin(azimuth) * std::cos(0.5), std::sin(0.5));
    view.width = options.width;
    view.height = options.height;
    view.tauPixels = options.tau;
    return view;
}

/// Processor time so far.
double secondsOf(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

/// One way to draw a frame; draw() from as many threads as `viewers`.
class Way {
public:
    virtual ~Way() = default;
    virtual absl::StatusOr<RenderedFrame> draw(const FrameRequest& view) = 0;
    /// Processor time of its renderers that are processes of their own, so far.
    virtual double secondsElsewhere() const { return 0; }
};

class InThisProcess final : public Way {
public:
    static absl::StatusOr<std::unique_ptr<Way>> open(const fabric::Scene& scene,
                                                     fabric::SceneInfo& info) {
        ASSIGN_OR_RETURN(auto renderer, Renderer::create({}));
        ASSIGN_OR_RETURN(info, renderer->openScene(scene));
        return std::unique_ptr<Way>(new InThisProcess(std::move(renderer), scene.background));
    }

    absl::StatusOr<RenderedFrame> draw(const FrameRequest& view) override {
        fabric::FrameData frameData;
        frameData.version = ++frames_;
        frameData.camera = view.camera;
        frameData.tauPixels = view.tauPixels;
        fabric::ChannelTask task;
        task.frameNumber = frames_;
        task.frameDataVersion = frames_;
        task.viewWidth = view.width;
        task.viewHeight = view.height;
        task.pixelViewport = view.drawnPart();
        ASSIGN_OR_RETURN(fabric::ChannelResult drawn, renderer_->render(frameData, task));
        RenderedFrame frame;
        frame.image = fabric::makeImage(task.pixelViewport, background_, false);
        if (!drawn.image.area.isEmpty())
            fabric::paste(drawn.image, frame.image);
        frame.statistics = drawn.statistics;
        return frame;
    }

private:
    InThisProcess(std::unique_ptr<Renderer> renderer, fabric::Rgba background)
        : renderer_(std::move(renderer)), background_(background) {}

    const std::unique_ptr<Renderer> renderer_;
    const fabric::Rgba background_;
    std::uint64_t frames_ = 0;
};

/// Processes inherit where the thread that starts them may run.
class OnCore {
public:
    explicit OnCore(int core) {
        sched_getaffinity(0, sizeof before_, &before_);
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(static_cast<std::size_t>(core), &one);
        sched_setaffinity(0, sizeof one, &one);
    }
    ~OnCore() { sched_setaffinity(0, sizeof before_, &before_); }
    OnCore(const OnCore&) = delete;
    OnCore& operator=(const OnCore&) = delete;

private:
    cpu_set_t before_;
};

class Behind final : public Way {
public:
    /// With a renderer on each of `cores`; -1: on any.
    static absl::StatusOr<std::unique_ptr<Way>> start(const Options& options,
                                                      const std::vector<int>& cores) {
        std::unique_ptr<Behind> way(new Behind);
        const std::string address = "unix:" + way->folder_.path("c");
        coordinator::CoordinatorOptions coordinator;
        coordinator.grpcAddresses = {address};
        coordinator.layout = options.layout;
        coordinator.scene = options.scene;
        ASSIGN_OR_RETURN(way->coordinator_, coordinator::Coordinator::start(coordinator));
        for (std::size_t i = 0; i < cores.size(); ++i)
            way->launch(options.program, address, cores[i], i);
        if (!test::eventually(kStartLimit, [&] { return way->areAllReady(); }))
            return absl::DeadlineExceededError("the renderers do not start: " +
                                               way->coordinator_->frames().status().problem);
        return way;
    }

    absl::StatusOr<RenderedFrame> draw(const FrameRequest& view) override {
        return coordinator_->frames().renderFrame(view);
    }

    double secondsElsewhere() const override {
        double sum = 0;
        for (const auto& process : processes_) {
            clockid_t clock{};
            if (clock_getcpuclockid(process->id(), &clock) == 0)
                sum += secondsOf(clock);
        }
        return sum;
    }

private:
    Behind() = default;

    void launch(const std::string& program, const std::string& address, int core, std::size_t i) {
        const std::vector<std::string> command{
            program,  "renderer", "--coordinator",
            address,  "--listen", "unix:" + folder_.path(fmt::format("r{}", i)),
            "--quiet"};
        if (core < 0) {
            processes_.push_back(std::make_unique<test::Process>(command));
            return;
        }
        const OnCore there(core);
        processes_.push_back(
            std::make_unique<test::Process>(command, std::vector<std::string>{"LP_NUM_THREADS=1"}));
    }

    bool areAllReady() const {
        const coordinator::Status status = coordinator_->frames().status();
        return std::ranges::count(status.renderers, coordinator::RendererCondition::Ready,
                                  &coordinator::RendererStatus::condition) ==
               static_cast<std::ptrdiff_t>(processes_.size());
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<coordinator::Coordinator> coordinator_;
    std::vector<std::unique_ptr<test::Process>> processes_;
};

struct Leg {
    std::string_view name;
    Way* way;
    int viewers;
    std::size_t comparedWith;  ///< position of the leg that is 1
    std::vector<double> rates = {};
    double secondsHere = 0;  ///< of processor time, in this process and its renderers' own
    double secondsElsewhere = 0;
    double tauAchieved = 0;
    std::uint64_t triangles = 0;
    bool isComplete = true;
};

/// The whole orbit. Errors: those of a frame.
absl::Status fly(Leg& leg, const fabric::Box& bounds, const Options& options, bool counts) {
    std::atomic<int> next{0};
    std::mutex mutex;  // guards the leg and the status
    absl::Status status;
    const auto start = Clock::now();
    const double here = secondsOf(CLOCK_PROCESS_CPUTIME_ID);
    const double elsewhere = leg.way->secondsElsewhere();
    const auto view = [&] {
        for (int i = next++; i < options.frames; i = next++) {
            const auto frame = leg.way->draw(viewOf(bounds, options, i));
            const std::lock_guard lock(mutex);
            status.Update(frame.status());
            if (!frame.ok())
                return;
            leg.tauAchieved = std::max(leg.tauAchieved, frame->statistics.tauAchievedPixels);
            leg.isComplete = leg.isComplete && frame->statistics.complete;
            leg.triangles += counts ? frame->statistics.triangles : 0;
        }
    };
    if (leg.viewers == 1) {
        view();  // a renderer in this process belongs to this thread
    } else {
        std::vector<std::jthread> viewers;
        for (int i = 0; i < leg.viewers; ++i) viewers.emplace_back(view);
    }
    if (counts) {
        leg.rates.push_back(options.frames /
                            std::chrono::duration<double>(Clock::now() - start).count());
        leg.secondsHere += secondsOf(CLOCK_PROCESS_CPUTIME_ID) - here;
        leg.secondsElsewhere += leg.way->secondsElsewhere() - elsewhere;
    }
    return status;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

/// Pixels of `pictures` pictures of the orbit that are not what the first leg draws.
absl::StatusOr<std::size_t> differentPixels(const std::vector<Leg>& legs, const fabric::Box& bounds,
                                            const Options& options, int pictures) {
    std::size_t different = 0;
    for (int i = 0; i < pictures; ++i) {
        const FrameRequest view = viewOf(bounds, options, options.frames * i / pictures);
        ASSIGN_OR_RETURN(const RenderedFrame expected, legs.front().way->draw(view));
        for (const Leg& leg : legs) {
            ASSIGN_OR_RETURN(const RenderedFrame frame, leg.way->draw(view));
            for (std::size_t p = 0; p < expected.image.colour.size(); ++p)
                different += frame.image.colour[p] == expected.image.colour[p] ? 0 : 1;
        }
    }
    return different;
}

void print(const std::vector<Leg>& legs, const Options& options) {
    const auto drawn = static_cast<std::uint64_t>(options.frames) *
                       static_cast<std::uint64_t>(options.repetitions);
    fmt::print("{:42} {:>8} {:>8} {:>8} {:>12} {:>10} {:>7} {:>9} {:>9}\n", "", "fps", "least",
               "most", "achieved px", "triangles", "of it", "CPU here", "renderers");
    for (const Leg& leg : legs) {
        const auto [least, most] = std::ranges::minmax(leg.rates);
        fmt::print("{:42} {:8.2f} {:8.2f} {:8.2f} {:12.3f} {:10} {:7.3f} {:6.2f} ms {:6.2f} ms{}\n",
                   leg.name, median(leg.rates), least, most, leg.tauAchieved, leg.triangles / drawn,
                   median(leg.rates) / median(legs[leg.comparedWith].rates),
                   leg.secondsHere * 1e3 / static_cast<double>(drawn),
                   leg.secondsElsewhere * 1e3 / static_cast<double>(drawn),
                   leg.isComplete ? "" : "  incomplete");
    }
}

absl::Status run(const Options& options) {
    spdlog::set_level(spdlog::level::err);
    fabric::SceneInfo info;
    ASSIGN_OR_RETURN(const auto local, InThisProcess::open(options.scene, info));
    ASSIGN_OR_RETURN(const auto remote, Behind::start(options, {-1}));
    ASSIGN_OR_RETURN(const auto one, Behind::start(options, {0}));
    ASSIGN_OR_RETURN(const auto two, Behind::start(options, {0, 1}));
    std::vector<Leg> legs{
        {"in this process", local.get(), 1, 0},
        {"one renderer, frame by frame", remote.get(), 1, 0},
        {"one renderer, frames in flight", remote.get(), options.viewers, 0},
        {"one renderer of one core, in flight", one.get(), options.viewers, 3},
        {"two renderers of one core each, in flight", two.get(), options.viewers, 3}};
    for (Leg& leg : legs) RETURN_IF_ERROR(fly(leg, info.bounds, options, false));
    for (int i = 0; i < options.repetitions; ++i)
        for (Leg& leg : legs) RETURN_IF_ERROR(fly(leg, info.bounds, options, true));
    fmt::print("{}, {} x {}, tau {} px, {}: {} frames, median of {}\n",
               options.scene.objects[0].path, options.width, options.height, options.tau,
               options.layout, options.frames, options.repetitions);
    print(legs, options);
    const int pictures = std::min(8, options.frames);
    ASSIGN_OR_RETURN(const std::size_t different,
                     differentPixels(legs, info.bounds, options, pictures));
    fmt::print("{} pixels of {} pictures differ from those drawn here\n", different, pictures);
    return different == 0 ? absl::OkStatus()
                          : absl::InternalError("pictures differ from those drawn here");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr,
                   "usage: distribution EYRIE FILE.eyt|FILE.eym [2D|DB] [FRAMES=120] "
                   "[WIDTHxHEIGHT=1280x720] [TAU=1] [REPETITIONS=5] [VIEWERS=2]\n");
        return 2;
    }
    Options options;
    options.program = argv[1];
    const std::string path = argv[2];
    options.scene.objects.push_back(
        {.name = "data",
         .kind = path.ends_with(".eyt") ? fabric::ObjectKind::Terrain : fabric::ObjectKind::Mesh,
         .path = path});
    if (argc > 3)
        options.layout = std::string_view(argv[3]) == "DB" ? "DB dynamic" : argv[3];
    if (argc > 4)
        options.frames = std::max(1, std::atoi(argv[4]));
    if (argc > 5 && std::sscanf(argv[5], "%dx%d", &options.width, &options.height) != 2) {
        fmt::print(stderr, "'{}' is not WIDTHxHEIGHT\n", argv[5]);
        return 2;
    }
    if (argc > 6)
        options.tau = std::atof(argv[6]);
    if (argc > 7)
        options.repetitions = std::max(1, std::atoi(argv[7]));
    if (argc > 8)
        options.viewers = std::max(1, std::atoi(argv[8]));
    if (const absl::Status status = run(options); !status.ok()) {
        fmt::print(stderr, "{}\n", status.ToString());
        return 1;
    }
    return 0;
}
