// SPDX-License-Identifier: Apache-2.0
// A renderer on a host of its own, behind a network that loses and delays packets, or parts.
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "coordinator/coordinator.h"
#include "tests/support/lossy_link.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using coordinator::RendererCondition;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

class NetworkFaults : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(test::succeeded(
            {"synth", "mesh", "--size", "20000", "--seed", "1", "-o", folder_.path("m.ply")}));
        ASSERT_TRUE(test::succeeded(
            {"import", "mesh", folder_.path("m.ply"), "-o", folder_.path("m.eym")}));
        coordinator::CoordinatorOptions options;
        options.grpcAddresses = {fmt::format("{}:0", test::LossyLink::kHere)};
        options.scene.objects.push_back({.name = "mesh", .path = folder_.path("m.eym")});
        coordinator_ = coordinator::Coordinator::start(options).value();
        near_ = startRenderer(test::LossyLink::kHere);
        link_.runThere([this] { far_ = startRenderer(test::LossyLink::kThere); });
        ASSERT_TRUE(farIsEventually(RendererCondition::Ready)) << far_->errors();
        ASSERT_TRUE(test::eventually(seconds(30), [&] {
            return conditionAt(test::LossyLink::kHere) == RendererCondition::Ready;
        }));
        for (std::size_t i = 0; i < 4; ++i) {
            const auto frame = frames().renderFrame(view(i));
            ASSERT_TRUE(frame.ok()) << frame.status();
            expected_.push_back(frame->image);
        }
    }
    void TearDown() override {
        link_.lose(0);
        link_.delay(milliseconds(0));
    }

    std::unique_ptr<test::Process> startRenderer(const std::string& host) const {
        return std::make_unique<test::Process>(
            test::eyrieCommand({"renderer", "--coordinator", coordinator_->grpcAddresses().front(),
                                "--listen", host + ":0", "--insecure"}),
            std::vector<std::string>{"LP_NUM_THREADS=1"});
    }
    coordinator::FrameSource& frames() const { return coordinator_->frames(); }
    coordinator::FrameRequest view(std::size_t i) const {
        const fabric::Box bounds = frames().status().sceneInfo.bounds;
        coordinator::FrameRequest request;
        request.camera.target = bounds.centre();
        request.camera.eye =
            bounds.centre() +
            glm::length(bounds.size()) * fabric::Vec3(0.1 * static_cast<double>(i), 0.6, 0.3);
        request.width = 96;
        request.height = 54;
        request.wantsDepth = true;
        return request;
    }
    RendererCondition conditionAt(const std::string& host) const {
        for (const coordinator::RendererStatus& renderer : frames().status().renderers)
            if (renderer.address.starts_with(host))
                return renderer.condition;
        return RendererCondition::Dead;
    }
    bool farIsEventually(RendererCondition condition) const {
        return test::eventually(seconds(30),
                                [&] { return conditionAt(test::LossyLink::kThere) == condition; });
    }
    void expectExactFrames(std::size_t count) const {
        for (std::size_t i = 0; i < count; ++i) {
            const auto frame = frames().renderFrame(view(i % expected_.size()));
            ASSERT_TRUE(frame.ok()) << frame.status();
            EXPECT_TRUE(frame->image == expected_[i % expected_.size()]) << i;
        }
    }

    test::LossyLink link_;
    const test::TemporaryFolder folder_;
    std::unique_ptr<coordinator::Coordinator> coordinator_;
    std::unique_ptr<test::Process> near_;
    std::unique_ptr<test::Process> far_;
    std::vector<fabric::Image> expected_;
};

/// One test: the namespaces are those of all threads of this process.
TEST_F(NetworkFaults, LeavePicturesExactAndARendererThatWasPartedComesBack) {
    link_.delay(milliseconds(50));
    link_.lose(0.05);
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(farIsEventually(RendererCondition::Ready));  // so that it takes part
        const auto start = Clock::now();
        expectExactFrames(1);
        fmt::print("5 % lost, 50 ms either way: a frame in {:.2f} s\n", secondsSince(start));
    }
    link_.delay(milliseconds(0));

    link_.lose(1);
    const auto parted = Clock::now();
    bool isKnown = false;
    while (!isKnown && secondsSince(parted) < 30) {
        expectExactFrames(1);
        isKnown = conditionAt(test::LossyLink::kThere) == RendererCondition::Dead;
    }
    ASSERT_TRUE(isKnown);
    const double deadAfter = secondsSince(parted);
    link_.lose(0);
    const auto healed = Clock::now();
    ASSERT_TRUE(farIsEventually(RendererCondition::Ready));
    fmt::print("parted: known as dead after {:.2f} s, back {:.2f} s after it healed\n", deadAfter,
               secondsSince(healed));
    expectExactFrames(4);
}

}  // namespace
}  // namespace eyrie
