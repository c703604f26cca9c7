// SPDX-License-Identifier: Apache-2.0
// Real renderer processes that die, stop, leave, or have other data.
#include <atomic>
#include <csignal>
#include <filesystem>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/coordinator.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using coordinator::RendererCondition;
using std::chrono::seconds;

class RendererFaults : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TemporaryFolder>();
        make("20000", "m.eym");
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static void make(const std::string& triangles, const std::string& data) {
        ASSERT_TRUE(test::succeeded(
            {"synth", "mesh", "--size", triangles, "--seed", "1", "-o", folder_->path("m.ply")}));
        ASSERT_TRUE(
            test::succeeded({"import", "mesh", folder_->path("m.ply"), "-o", folder_->path(data)}));
    }

    void startCoordinator(const std::string& data) {
        coordinator::CoordinatorOptions options;
        options.grpcAddresses = {"unix:" + folder_->path("c")};
        options.scene.objects.push_back({.name = "ball", .path = folder_->path(data)});
        coordinator_ = coordinator::Coordinator::start(options).value();
    }
    std::unique_ptr<test::Process> startRenderer(const std::string& socket) const {
        return std::make_unique<test::Process>(
            test::eyrieCommand({"renderer", "--coordinator", "unix:" + folder_->path("c"),
                                "--listen", "unix:" + folder_->path(socket)}),
            std::vector<std::string>{"LP_NUM_THREADS=1"});
    }
    coordinator::RendererStatus statusOf(const std::string& socket) const {
        for (coordinator::RendererStatus& renderer : coordinator_->frames().status().renderers)
            if (renderer.address == "unix:" + folder_->path(socket))
                return renderer;
        coordinator::RendererStatus none;
        none.condition = RendererCondition::Dead;
        return none;
    }
    bool becomes(const std::string& socket, RendererCondition condition) const {
        return test::eventually(seconds(30),
                                [&] { return statusOf(socket).condition == condition; });
    }
    bool draws() const {
        coordinator::FrameRequest request;
        request.camera.eye = {3, 0, 0};
        request.width = 160;
        request.height = 90;
        return coordinator_->frames().renderFrame(request).ok();
    }

    static std::unique_ptr<test::TemporaryFolder> folder_;
    std::unique_ptr<coordinator::Coordinator> coordinator_;
};
std::unique_ptr<test::TemporaryFolder> RendererFaults::folder_;

TEST_F(RendererFaults, OneThatIsToldToLeaveDoesSoBetweenFramesAndExitsWithStatusZero) {
    startCoordinator("m.eym");
    const auto stays = startRenderer("a");
    const auto leaves = startRenderer("b");
    ASSERT_TRUE(becomes("a", RendererCondition::Ready)) << stays->errors();
    ASSERT_TRUE(becomes("b", RendererCondition::Ready)) << leaves->errors();
    std::atomic<int> drawn{0};
    std::jthread viewer([&](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            EXPECT_TRUE(draws());
            ++drawn;
        }
    });
    EXPECT_TRUE(test::eventually(seconds(30), [&] { return drawn > 3; }));
    leaves->send(SIGTERM);
    EXPECT_EQ(leaves->waitFor(seconds(30)), (test::Exit{0, 0})) << leaves->errors();
    EXPECT_EQ(coordinator_->frames().status().renderers.size(), 1U);
    const int before = drawn;
    EXPECT_TRUE(test::eventually(seconds(30), [&] { return drawn > before + 3; }));
}

TEST_F(RendererFaults, OneThatFindsAnotherFileIsRefusedWithBothSums) {
    std::filesystem::copy_file(folder_->path("m.eym"), folder_->path("now.eym"));
    startCoordinator("now.eym");
    const auto first = startRenderer("a");
    ASSERT_TRUE(becomes("a", RendererCondition::Ready)) << first->errors();
    make("80000", "other.eym");
    std::filesystem::rename(folder_->path("other.eym"), folder_->path("now.eym"));
    const auto second = startRenderer("b");
    ASSERT_TRUE(becomes("b", RendererCondition::Refused)) << second->errors();
    EXPECT_THAT(statusOf("b").why, testing::AllOf(testing::HasSubstr("now.eym) has "),
                                                  testing::HasSubstr(" bytes and sum ")));
    EXPECT_TRUE(draws());
    first->send(SIGKILL);
    EXPECT_TRUE(becomes("b", RendererCondition::Ready));
    EXPECT_TRUE(draws());
}

TEST_F(RendererFaults, CostNoPixel) {
    for (const std::string compound : {"2D", "DB", "direct-send"}) {
        const test::Outcome outcome =
            test::run({EYRIE_FAULTS_BINARY, EYRIE_BINARY, folder_->path("m.eym"), compound, "2",
                       "2", "0", "100", "3", "160x90"},
                      seconds(120));
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        fmt::print("{}\n{}", compound, outcome.output);
    }
}

}  // namespace
}  // namespace eyrie
