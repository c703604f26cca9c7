// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coordinator/frame/frame_pipeline.h"
#include "fake_renderer.h"
#include "tests/service/eventually.h"
#include "tests/support/identifier.h"

namespace eyrie::coordinator {

/// A pipeline over fakes, by the layout that is the parameter.
class FramePipelineTest : public testing::TestWithParam<std::string> {
protected:
    static constexpr int kWidth = 41;
    static constexpr int kHeight = 23;

    /// With as much patience no part is taken for lost, however busy the machine is.
    explicit FramePipelineTest(std::chrono::milliseconds patience = std::chrono::seconds(50))
        : FramePipelineTest(options(GetParam(), patience)) {}
    explicit FramePipelineTest(const FramePipelineOptions& options)
        : pipeline_(registry_, options) {}

    static FramePipelineOptions options(const std::string& layout,
                                        std::chrono::milliseconds patience) {
        FramePipelineOptions options;
        options.layout = layout;
        options.patience = {patience, patience, 3};
        options.callTimeouts.interactive = std::chrono::seconds(60);
        return options;
    }
    static fabric::Scene sceneNamed(const std::string& name) {
        fabric::Scene scene;
        scene.background = LayeredScene::kBackground;
        scene.objects.push_back({name, fabric::ObjectKind::Mesh, "a.eym", fabric::Mat4(1.0), {}});
        return scene;
    }
    static FrameRequest request() {
        FrameRequest request;
        request.width = kWidth;
        request.height = kHeight;
        request.wantsDepth = true;
        return request;
    }

    std::shared_ptr<FakeRenderer> addRenderer() {
        auto renderer = std::make_shared<FakeRenderer>(layers_);
        add(renderer);
        return renderer;
    }
    void add(const std::shared_ptr<FakeRenderer>& renderer) {
        const std::string address = fmt::format("fake:{}", ++added_);
        ids_.push_back(
            registry_.add(address, {"", address, "", "", true}, renderer, Registry::Clock::now())
                .value());
    }
    std::vector<std::shared_ptr<FakeRenderer>> openWith(int renderers) {
        pipeline_.setScene(sceneNamed("first"));
        std::vector<std::shared_ptr<FakeRenderer>> result;
        for (int i = 0; i < renderers; ++i) result.push_back(addRenderer());
        awaitReady(result);
        return result;
    }
    /// All are ready once a frame has used all.
    void awaitReady(const std::vector<std::shared_ptr<FakeRenderer>>& renderers) {
        EXPECT_TRUE(eventually([&] {
            for (const auto& renderer : renderers) renderer->drawn = 0;
            return pipeline_.renderFrame(request()).ok() &&
                   std::all_of(renderers.begin(), renderers.end(),
                               [](const auto& renderer) { return renderer->drawn == 1; });
        }));
    }
    void expectWholePicture() {
        const absl::StatusOr<RenderedFrame> frame = pipeline_.renderFrame(request());
        ASSERT_TRUE(frame.ok()) << frame.status();
        EXPECT_TRUE(frame->image == layers_->whole(kWidth, kHeight));
    }
    RendererStatus statusOf(int renderer) const {
        for (const RendererStatus& status : pipeline_.status().renderers)
            if (status.id == ids_[static_cast<std::size_t>(renderer)])
                return status;
        RendererStatus gone;
        gone.condition = RendererCondition::Dead;
        return gone;
    }
    bool isAlive(int renderer) const { return statusOf(renderer).isAlive(); }

    std::shared_ptr<const LayeredScene> layers_ = std::make_shared<LayeredScene>(4711);
    Registry registry_;
    FramePipeline pipeline_;
    std::vector<std::string> ids_;
    int added_ = 0;
};

}  // namespace eyrie::coordinator
