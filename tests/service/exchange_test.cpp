// SPDX-License-Identifier: Apache-2.0
// Programs among real servers, over Unix sockets and TCP, that draw what they are given.
#include "service/exchange.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <future>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>

#include "coordinator/farm/grpc_renderer.h"
#include "coordinator/observe/telemetry.h"
#include "eyrie/v1/render_service.grpc.pb.h"
#include "fabric/depth_merge.h"
#include "fake_drawer.h"
#include "service/render_server.h"
#include "tests/proto/fabric/sample_images.h"
#include "tests/service/eventually.h"
#include "tests/support/temporary_folder.h"
#include "wire/frame.h"
#include "wire/transport.h"

namespace eyrie::service {
namespace {

using coordinator::ChannelRenderer;
using fabric::ChannelProgram;
using fabric::Merge;
using fabric::PixelViewport;
using testing::HasSubstr;
using testing::Not;
using Answer = absl::StatusOr<fabric::ProgramResult>;

constexpr PixelViewport kWhole{3, 2, 61, 24};

ChannelRenderer::Clock::time_point in(std::chrono::milliseconds time) {
    return ChannelRenderer::Clock::now() + time;
}
ChannelRenderer::Clock::time_point soon() { return in(std::chrono::seconds(20)); }

std::string messageOf(const absl::Status& status) { return std::string(status.message()); }

constexpr fabric::Rgba kBackground{9, 9, 9, 255};

/// Random pixels, many of which tie; background where nothing was drawn.
fabric::Image layer(const PixelViewport& area, std::uint32_t seed) {
    fabric::Image image = fabric::sampleImage(area, seed);
    for (std::size_t i = 0; i < image.colour.size(); ++i)
        if (image.depth[i] == 0)
            image.colour[i] = kBackground;
    return image;
}

/// A renderer that draws one layer.
struct Node {
    Node(const std::string& address, const fabric::Image& drawn) {
        control->image = drawn;
        thread = GlThread::start(fakeDrawers(control)).value();
        server = RenderServer::start(address, *thread).value();
        renderer = coordinator::connectRenderer(server->address());
        // On a machine that is late with everything a first connection may time out.
        EXPECT_TRUE(eventually([this] {
            return renderer->setFrameData({1, {}, 2, fabric::Shading::Flat}, soon()).ok();
        }));
    }

    std::shared_ptr<FakeDrawerControl> control = std::make_shared<FakeDrawerControl>();
    std::unique_ptr<GlThread> thread;
    std::unique_ptr<RenderServer> server;
    std::shared_ptr<ChannelRenderer> renderer;
};

fabric::ChannelTask drawTask() { return {1, 1, 64, 26, kWhole, {}, true}; }

/// Rows of the picture, cut into `count` strips of which this is one.
PixelViewport strip(const PixelViewport& whole, int index, int count) {
    const int begin = whole.height * index / count;
    return {whole.x, whole.y + begin, whole.width, whole.height * (index + 1) / count - begin};
}

/// How node `mine` merges what node `theirs`, of another range, sends.
Merge mergeOf(int theirs, int mine) {
    return theirs < mine ? Merge::DepthBefore : Merge::DepthBehind;
}

class ExchangeTest : public testing::Test {
protected:
    /// Nodes with layers of random pixels, full of ties, each of another part of the picture; every
    /// second one is reached by TCP.
    void addNodes(int count) {
        for (int i = 0; i < count; ++i) {
            const PixelViewport area{kWhole.x + i, kWhole.y + i % 2, kWhole.width - 2 * i,
                                     kWhole.height - 3 * i};
            layers_.push_back(layer(area, static_cast<std::uint32_t>(7 + i)));
            nodes_.push_back(std::make_unique<Node>(
                i % 2 == 0 ? "unix:" + folder_.path(fmt::format("s{}", i)) : "127.0.0.1:0",
                layers_.back()));
        }
    }
    const std::string& address(int node) const {
        return nodes_[static_cast<std::size_t>(node)]->server->address();
    }
    ChannelRenderer& renderer(int node) {
        return *nodes_[static_cast<std::size_t>(node)]->renderer;
    }

    ChannelProgram program(std::uint64_t session = 77) const {
        return {session, 5, kWhole, true, kBackground, {}};
    }
    /// Awaits frame 1, by depth, and answers with it.
    ChannelProgram awaiting(std::uint64_t session = 77) const {
        ChannelProgram awaits = program(session);
        awaits.stages.push_back({{}, {{1, kWhole, Merge::DepthBehind}}, {{2, kWhole, true, ""}}});
        return awaits;
    }

    /// Each draws, sends each other its strip of that, and answers with its own one.
    ChannelProgram directSend(int mine, std::uint64_t session = 77) const {
        const int count = static_cast<int>(nodes_.size());
        const auto frame = [count](int from, int to) {
            return static_cast<std::uint32_t>(from * count + to);
        };
        ChannelProgram sends = program(session);
        sends.stages.resize(2);
        sends.stages[0].draw = drawTask();
        // Each is adjacent in range to what is there by then.
        std::vector<int> others;
        for (int i = mine - 1; i >= 0; --i) others.push_back(i);
        for (int i = mine + 1; i < count; ++i) others.push_back(i);
        for (const int other : others) {
            sends.stages[0].outputs.push_back(
                {frame(mine, other), strip(kWhole, other, count), true, address(other)});
            sends.stages[1].inputs.push_back(
                {frame(other, mine), strip(kWhole, mine, count), mergeOf(other, mine)});
        }
        sends.stages[1].outputs = {{1000, strip(kWhole, mine, count), false, ""}};
        return sends;
    }

    /// Pairs of neighbours swap halves, then pairs of pairs swap quarters.
    ChannelProgram binarySwap(int mine, std::uint64_t session) const {
        ChannelProgram swaps = program(session);
        swaps.stages.resize(3);
        swaps.stages[0].draw = drawTask();
        PixelViewport kept = kWhole;
        for (int round = 0; round < 2; ++round) {
            const int other = mine ^ (1 << round);
            const int side = mine >> round & 1;
            const auto stage = static_cast<std::size_t>(round);
            const auto frame = [round](int from) {
                return static_cast<std::uint32_t>(10 * round + from);
            };
            swaps.stages[stage].outputs.push_back(
                {frame(mine), strip(kept, 1 - side, 2), true, address(other)});
            kept = strip(kept, side, 2);
            swaps.stages[stage + 1].inputs.push_back({frame(other), kept, mergeOf(other, mine)});
        }
        swaps.stages[2].outputs = {{1000, kept, false, ""}};
        return swaps;
    }

    std::vector<Answer> runAll(const std::function<ChannelProgram(int)>& program,
                               ChannelRenderer::Clock::time_point deadline = soon()) {
        std::vector<std::future<Answer>> running;
        for (int i = 0; i < static_cast<int>(nodes_.size()); ++i)
            running.push_back(std::async(std::launch::async, [this, &program, i, deadline] {
                return renderer(i).runProgram(program(i), deadline);
            }));
        std::vector<Answer> answers;
        for (std::future<Answer>& answer : running) answers.push_back(answer.get());
        return answers;
    }

    /// The same in sessions from `session` on, until all renderers have reached each other.
    std::vector<Answer> runConnected(
        const std::function<ChannelProgram(int, std::uint64_t)>& program, std::uint64_t session) {
        std::vector<Answer> answers;
        for (int attempt = 0; attempt < 20; ++attempt, ++session) {
            answers = runAll([&](int i) { return program(i, session); });
            if (std::none_of(answers.begin(), answers.end(), [](const Answer& answer) {
                    return absl::IsUnavailable(answer.status());
                }))
                break;
        }
        return answers;
    }

    /// The picture that the answers' parts make.
    fabric::Image assembled(const std::vector<Answer>& answers) const {
        fabric::Image picture = fabric::makeImage(kWhole, program().background, false);
        for (const Answer& answer : answers) {
            EXPECT_TRUE(answer.ok()) << answer.status();
            for (const fabric::ProgramPicture& part :
                 answer.ok() ? answer->pictures : std::vector<fabric::ProgramPicture>())
                fabric::paste(part.image, picture);
        }
        return picture;
    }
    fabric::Image centrallyMerged() const {
        fabric::Image picture = fabric::makeImage(kWhole, program().background, true);
        fabric::paste(layers_[0], picture);
        for (std::size_t i = 1; i < layers_.size(); ++i) fabric::mergeDepth(layers_[i], picture);
        picture.depth.clear();
        return picture;
    }

    test::TemporaryFolder folder_;
    std::vector<fabric::Image> layers_;
    std::vector<std::unique_ptr<Node>> nodes_;
};

TEST_F(ExchangeTest, DirectSendAmongThreeIsTheCentralMergeToTheBit) {
    addNodes(3);
    const auto answers =
        runConnected([this](int i, std::uint64_t session) { return directSend(i, session); }, 77);
    EXPECT_TRUE(assembled(answers) == centrallyMerged());
    for (const Answer& answer : answers)
        EXPECT_EQ(answer.value_or(fabric::ProgramResult()).draws.size(), 1U);
}

TEST_F(ExchangeTest, WhatComesOfAProgramIsCounted) {
    addNodes(1);
    const auto telemetry = std::make_shared<observe::Telemetry>();
    const auto counted = coordinator::connectRenderer(address(0), {}, telemetry);
    ASSERT_TRUE(counted->runProgram(directSend(0), soon()).ok());
    const std::string metrics = telemetry->metrics.text({}, {{address(0), "renderer-3"}});
    EXPECT_THAT(metrics, HasSubstr("eyrie_renderer_pictures_total{way=\"messages\"} 1"));
    EXPECT_THAT(metrics, Not(HasSubstr("eyrie_received_bytes_total{peer=\"renderer\"} 0\n")));
    EXPECT_THAT(metrics, HasSubstr("eyrie_received_bytes_total{peer=\"renderer\"} "));
    EXPECT_THAT(metrics, HasSubstr("memory=\"device\",renderer=\"renderer-3\"} 12\n"));
    EXPECT_THAT(metrics, HasSubstr("memory=\"host\",renderer=\"renderer-3\"} 34\n"));
}

TEST_F(ExchangeTest, BinarySwapAmongFourIsTheCentralMergeToTheBit) {
    addNodes(4);
    const auto answers =
        runConnected([this](int i, std::uint64_t session) { return binarySwap(i, session); }, 77);
    EXPECT_TRUE(assembled(answers) == centrallyMerged());
}

TEST_F(ExchangeTest, FramesOfTwoCoordinatorsDoNotMix) {
    addNodes(3);
    const auto run = [this](std::uint64_t first) {
        return runConnected([this](int i, std::uint64_t session) { return directSend(i, session); },
                            first);
    };
    auto other = std::async(std::launch::async, run, 1234);
    EXPECT_TRUE(assembled(run(77)) == centrallyMerged());
    EXPECT_TRUE(assembled(other.get()) == centrallyMerged());
}

TEST_F(ExchangeTest, AnInputThatNeverComesEndsTheProgramAtItsDeadlineAndNothingElse) {
    addNodes(1);
    std::stop_source stop;
    auto waiting = std::async(std::launch::async, [&] {
        return renderer(0).runProgram(awaiting(), soon(), stop.get_token());
    });
    const absl::Status late =
        renderer(0).runProgram(awaiting(78), in(std::chrono::milliseconds(100))).status();
    EXPECT_TRUE(absl::IsDeadlineExceeded(late)) << late;
    // Meanwhile channels are drawn.
    EXPECT_TRUE(renderer(0).render(drawTask(), soon()).ok());
    stop.request_stop();
    EXPECT_TRUE(absl::IsCancelled(waiting.get().status()));
    EXPECT_TRUE(renderer(0).render(drawTask(), soon()).ok());
}

TEST_F(ExchangeTest, APeerThatIsGoneFailsTheProgramByName) {
    addNodes(3);
    const std::string gone = address(2);
    ChannelProgram sends = directSend(0);
    nodes_[2]->server->stop(std::chrono::milliseconds(0));
    const Answer answer = renderer(0).runProgram(sends, soon());
    EXPECT_TRUE(absl::IsUnavailable(answer.status())) << answer.status();
    EXPECT_THAT(messageOf(answer.status()), HasSubstr("renderer at " + gone));
}

TEST_F(ExchangeTest, AServerThatStopsAmidAProgramEndsIt) {
    addNodes(3);
    nodes_[2]->control->hold();
    std::jthread stopper([this] {
        EXPECT_TRUE(eventually([this] { return nodes_[2]->control->begun == 1; }));
        nodes_[2]->server->stop(std::chrono::milliseconds(0));
        nodes_[2]->control->release();
    });
    const auto answers =
        runAll([this](int i) { return directSend(i); }, in(std::chrono::milliseconds(1500)));
    for (const Answer& answer : answers) EXPECT_FALSE(answer.ok());
}

/// Sends frames as a renderer does, or not quite.
class PutFrameTest : public ExchangeTest {
protected:
    PutFrameTest() {
        addNodes(1);
        stub_ = v1::RenderService::NewStub(grpc::CreateCustomChannel(
            address(0), grpc::InsecureChannelCredentials(), wire::clientArguments()));
    }

    static v1::PutFrameRequest header(const PixelViewport& area, std::uint64_t session = 77) {
        v1::PutFrameRequest message;
        v1::FrameHeader& header = *message.mutable_header();
        header.set_session(session);
        header.set_frame_number(5);
        header.set_frame(1);
        *header.mutable_area() = wire::toMessage(area);
        header.set_has_depth(true);
        header.set_pixel_bytes(static_cast<std::uint64_t>(area.area()) * 8);
        return message;
    }
    static v1::PutFrameRequest chunk(const fabric::Image& image) {
        v1::PutFrameRequest message;
        message.mutable_chunk()->append(reinterpret_cast<const char*>(image.colour.data()),
                                        image.colour.size() * 4);
        message.mutable_chunk()->append(reinterpret_cast<const char*>(image.depth.data()),
                                        image.depth.size() * 4);
        return message;
    }

    grpc::StatusCode put(const std::vector<v1::PutFrameRequest>& messages) {
        grpc::ClientContext context;
        context.set_wait_for_ready(true);
        v1::PutFrameResponse response;
        const auto writer = stub_->PutFrame(&context, &response);
        for (const v1::PutFrameRequest& message : messages) writer->Write(message);
        writer->WritesDone();
        return writer->Finish().error_code();
    }

    /// Runs `program` while `meanwhile` happens, once its inputs are announced.
    Answer runBeside(ChannelProgram program, const std::function<void()>& meanwhile) {
        FakeDrawerControl& drawer = *nodes_[0]->control;
        drawer.image = fabric::Image();  // It draws nothing, after its inputs were announced.
        program.stages.insert(program.stages.begin(), {drawTask(), {}, {}});
        auto answer =
            std::async(std::launch::async, [&] { return renderer(0).runProgram(program, soon()); });
        EXPECT_TRUE(eventually([&] { return drawer.begun == 1; }));
        meanwhile();
        return answer.get();
    }

    std::unique_ptr<v1::RenderService::Stub> stub_;
};

TEST_F(PutFrameTest, AFrameMayComeBeforeItsProgram) {
    const fabric::Image image = layer({5, 4, 20, 10}, 3);
    ASSERT_EQ(put({header(image.area), chunk(image)}), grpc::StatusCode::OK);
    const Answer answer = renderer(0).runProgram(awaiting(), soon());
    ASSERT_TRUE(answer.ok()) << answer.status();
    EXPECT_TRUE(answer->pictures.at(0).image == image);
    // It is taken once.
    EXPECT_TRUE(absl::IsDeadlineExceeded(
        renderer(0).runProgram(awaiting(), in(std::chrono::milliseconds(50))).status()));
}

TEST_F(PutFrameTest, AFrameOfAnotherSessionIsNotTaken) {
    const fabric::Image image = layer({5, 4, 20, 10}, 3);
    EXPECT_EQ(put({header(image.area, 78), chunk(image)}), grpc::StatusCode::OK);
    EXPECT_TRUE(absl::IsDeadlineExceeded(
        renderer(0).runProgram(awaiting(), in(std::chrono::milliseconds(50))).status()));
}

TEST_F(PutFrameTest, AFrameLargerThanAnnouncedIsRefusedAndTheRightOneStillTaken) {
    const fabric::Image wrong = layer({2, 2, 20, 10}, 3);
    const fabric::Image right = layer({5, 4, 20, 10}, 3);
    const Answer answer = runBeside(awaiting(), [&] {
        EXPECT_EQ(put({header(wrong.area), chunk(wrong)}), grpc::StatusCode::INVALID_ARGUMENT);
        EXPECT_EQ(put({header(right.area), chunk(right)}), grpc::StatusCode::OK);
    });
    ASSERT_TRUE(answer.ok()) << answer.status();
    EXPECT_TRUE(answer->pictures.at(0).image == right);
}

TEST_F(PutFrameTest, AFrameThatCameEarlyAndIsNotAsAnnouncedFailsTheProgram) {
    const fabric::Image image = layer({2, 2, 20, 10}, 3);
    ASSERT_EQ(put({header(image.area), chunk(image)}), grpc::StatusCode::OK);
    const absl::Status status = renderer(0).runProgram(awaiting(), soon()).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status));
    EXPECT_THAT(messageOf(status), HasSubstr("20x10 at 2,2, outside the 61x24 at 3,2"));
}

TEST_F(PutFrameTest, ASenderThatGoesAwayAmidAFrameFailsTheProgram) {
    const v1::PutFrameRequest begin = header({5, 4, 20, 10});
    const Answer answer = runBeside(awaiting(), [&] {
        grpc::ClientContext context;
        context.set_wait_for_ready(true);
        v1::PutFrameResponse response;
        const auto writer = stub_->PutFrame(&context, &response);
        EXPECT_TRUE(writer->Write(begin));
        EXPECT_TRUE(eventually([&] { return put({begin}) == grpc::StatusCode::ALREADY_EXISTS; }));
        context.TryCancel();
        EXPECT_FALSE(writer->Finish().ok());
    });
    EXPECT_TRUE(absl::IsUnavailable(answer.status())) << answer.status();
    EXPECT_THAT(messageOf(answer.status()), HasSubstr("its sender went away"));
}

TEST_F(PutFrameTest, AFrameForAnotherRendererIsRefused) {
    ASSERT_TRUE(renderer(0).openScene({}, soon()).ok());
    const fabric::Image image = layer({5, 4, 20, 10}, 3);
    v1::PutFrameRequest begin = header(image.area);
    begin.mutable_header()->set_to("127.0.0.1:7000");
    EXPECT_EQ(put({begin, chunk(image)}), grpc::StatusCode::INVALID_ARGUMENT);
    begin.mutable_header()->set_to(address(0));
    EXPECT_EQ(put({begin, chunk(image)}), grpc::StatusCode::OK);
}

TEST_F(ExchangeTest, RenderersThatKnowTheirAddressesTakeWhatIsSentThere) {
    addNodes(2);
    for (int i = 0; i < 2; ++i) ASSERT_TRUE(renderer(i).openScene({}, soon()).ok());
    const auto answers =
        runConnected([this](int i, std::uint64_t session) { return directSend(i, session); }, 77);
    EXPECT_TRUE(assembled(answers) == centrallyMerged());
}

TEST_F(PutFrameTest, NonsenseIsRefused) {
    const fabric::Image image = layer({5, 4, 20, 10}, 3);
    EXPECT_EQ(put({}), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(put({chunk(image)}), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(put({header({0, 0, 16384, 16384})}), grpc::StatusCode::RESOURCE_EXHAUSTED);
    v1::PutFrameRequest wrong = header(image.area);
    wrong.mutable_header()->set_pixel_bytes(7);
    EXPECT_EQ(put({wrong}), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(put({header(image.area), chunk(image), chunk(image)}), grpc::StatusCode::DATA_LOSS);
}

TEST_F(PutFrameTest, ProgramsAreRefusedByFieldAndBounded) {
    ChannelProgram beyond = awaiting();
    beyond.stages[0].outputs[0].area.width = 100;
    const absl::Status status = renderer(0).runProgram(beyond, soon()).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status));
    EXPECT_THAT(messageOf(status), HasSubstr("program.stages[0]: area is 100x24"));
    std::vector<std::jthread> waiting;
    for (std::uint64_t i = 0; i < fabric::kMaxPrograms; ++i)
        waiting.emplace_back([this, i] {
            while (absl::IsResourceExhausted(
                renderer(0).runProgram(awaiting(100 + i), soon()).status())) {
            }
        });
    const auto other = coordinator::connectRenderer(address(0));
    EXPECT_TRUE(eventually([&] {
        return absl::IsResourceExhausted(
            other->runProgram(awaiting(99), in(std::chrono::milliseconds(50))).status());
    }));
    renderer(0).cancel();
    waiting.clear();
    EXPECT_TRUE(eventually([&] {
        return absl::IsDeadlineExceeded(
            other->runProgram(awaiting(99), in(std::chrono::milliseconds(50))).status());
    }));
}

constexpr FrameKey kKey{1, 2, 3};

TEST(Mailbox, BytesOfPicturesAreBounded) {
    Mailbox mailbox({.bytes = 1000, .pictures = 2, .unannounced = std::chrono::seconds(60)});
    EXPECT_TRUE(absl::IsResourceExhausted(mailbox.admit(kKey, {0, 0, 126, 1}, true).status()));
    {
        const auto arrival = mailbox.admit(kKey, {0, 0, 100, 1}, true);
        ASSERT_TRUE(arrival.ok());
        EXPECT_EQ(mailbox.bytesHeld(), 800U);
        EXPECT_TRUE(absl::IsAlreadyExists(mailbox.admit(kKey, {0, 0, 1, 1}, true).status()));
        EXPECT_TRUE(
            absl::IsResourceExhausted(mailbox.admit({1, 2, 4}, {0, 0, 26, 1}, true).status()));
    }
    EXPECT_EQ(mailbox.bytesHeld(), 0U);
    EXPECT_TRUE(mailbox.admit({1, 2, 5}, {}, false).ok());
    EXPECT_TRUE(absl::IsResourceExhausted(mailbox.admit({1, 2, 6}, {}, false).status()));
}

TEST(Mailbox, WhatNobodyAnnouncesGoes) {
    Mailbox mailbox({.bytes = 1000, .pictures = 2, .unannounced = std::chrono::milliseconds(10)});
    mailbox.admit(kKey, {0, 0, 10, 1}, true)->complete(fabric::makeImage({0, 0, 10, 1}, {}, true));
    EXPECT_TRUE(eventually([&] { return mailbox.bytesHeld() == 0; }));
    EXPECT_TRUE(mailbox.admit(kKey, {0, 0, 10, 1}, true).ok());
}

TEST(Mailbox, BreaksOffWhatStalls) {
    using std::chrono::milliseconds;
    Mailbox mailbox({.unannounced = milliseconds(5), .arriving = milliseconds(20)});
    std::atomic<int> brokenOff = 0;
    const auto admit = [&](std::uint32_t frame) {
        return mailbox.admit({1, 2, frame}, {0, 0, 10, 1}, true, [&] { ++brokenOff; });
    };
    admit(1)->complete(fabric::makeImage({0, 0, 10, 1}, {}, true));
    {
        const auto stalled = admit(2);
        ASSERT_TRUE(stalled.ok());
        EXPECT_TRUE(eventually([&] { return brokenOff == 1; }));
        std::this_thread::sleep_for(milliseconds(50));
        EXPECT_EQ(brokenOff, 1) << "once, and not what has come";
        EXPECT_EQ(mailbox.bytesHeld(), 80U) << "until its receiver drops it";
    }
    EXPECT_EQ(mailbox.bytesHeld(), 0U);
}

TEST(Mailbox, WhatComesAfterItsProgramEndedIsDropped) {
    Mailbox mailbox({});
    ASSERT_TRUE(mailbox.announce(kKey, {0, 0, 10, 1}, true).ok());
    auto arrival = mailbox.admit(kKey, {0, 0, 10, 1}, true);
    ASSERT_TRUE(arrival.ok());
    mailbox.forget(kKey);
    arrival->complete(fabric::makeImage({0, 0, 10, 1}, {}, true));
    EXPECT_EQ(mailbox.bytesHeld(), 0U);
}

TEST(Mailbox, WhatWasAdmittedForAProgramIsNotTakenForTheNextOfTheSameKey) {
    Mailbox mailbox({});
    ASSERT_TRUE(mailbox.announce(kKey, {0, 0, 10, 1}, false).ok());
    auto late = mailbox.admit(kKey, {0, 0, 10, 1}, false);
    ASSERT_TRUE(late.ok());
    mailbox.forget(kKey);
    ASSERT_TRUE(mailbox.announce(kKey, {0, 0, 4, 1}, true).ok());
    late->complete(fabric::makeImage({0, 0, 10, 1}, {}, false));
    EXPECT_EQ(mailbox.bytesHeld(), 0U);
    mailbox.admit(kKey, {0, 0, 4, 1}, true)->complete(fabric::makeImage({0, 0, 4, 1}, {}, true));
    const auto image = mailbox.await(kKey, Mailbox::Clock::now() + std::chrono::seconds(10), {});
    ASSERT_TRUE(image.ok()) << image.status();
    EXPECT_EQ(image->area, (fabric::PixelViewport{0, 0, 4, 1}));
}

TEST(Mailbox, AMergeByDepthNeedsDepth) {
    Mailbox mailbox({});
    ASSERT_TRUE(mailbox.announce(kKey, {0, 0, 10, 1}, true).ok());
    EXPECT_TRUE(absl::IsInvalidArgument(mailbox.admit(kKey, {0, 0, 10, 1}, false).status()));
    EXPECT_TRUE(mailbox.admit(kKey, {}, false).ok());
}

}  // namespace
}  // namespace eyrie::service
