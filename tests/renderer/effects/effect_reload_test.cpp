// SPDX-License-Identifier: Apache-2.0
// A renderer whose effect files are edited between frames.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include "fabric/log.h"
#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using Clock = std::chrono::steady_clock;

class EffectReload : public testing::Test {
protected:
    void SetUp() override {
        for (const char* name : {"mesh.effect", "mesh_points.effect", "mesh_vertex.block",
                                 "terrain.effect", "object.block"})
            std::filesystem::copy_file(
                std::filesystem::path(EYRIE_SOURCE_DIR "/renderer/effects") / name,
                folder_.path(name));
        setenv("EYRIE_EFFECTS", folder_.path().c_str(), 1);
        before_ = spdlog::default_logger();
        spdlog::set_default_logger(std::make_shared<spdlog::logger>(
            "test", std::make_shared<spdlog::sinks::ostream_sink_st>(log_)));
        auto renderer = Renderer::create({});
        ASSERT_TRUE(renderer.ok()) << renderer.status();
        renderer_ = *std::move(renderer);
        const auto scene = test::sampleScene(test::SampleKind::Mesh);
        ASSERT_TRUE(scene.ok()) << scene.status();
        const auto info = renderer_->openScene(*scene);
        ASSERT_TRUE(info.ok()) << info.status();
        frame_.camera.target = info->bounds.centre();
        frame_.camera.eye = info->bounds.centre() + info->bounds.size() * 1.5;
    }

    void TearDown() override {
        renderer_.reset();
        spdlog::set_default_logger(before_);
        unsetenv("EYRIE_EFFECTS");
    }

    std::vector<fabric::Rgba> picture() {
        fabric::ChannelTask task;
        task.viewWidth = 64;
        task.viewHeight = 64;
        task.pixelViewport = {0, 0, 64, 64};
        const auto result = renderer_->render(frame_, task);
        EXPECT_TRUE(result.ok()) << result.status();
        return result.ok() ? result->image.colour : std::vector<fabric::Rgba>();
    }

    /// Draws until the log holds `text`, for at most ten seconds.
    bool drawUntilLogged(const std::string& text) {
        const auto end = Clock::now() + std::chrono::seconds(10);
        while (log_.str().find(text) == std::string::npos && Clock::now() < end) picture();
        return log_.str().find(text) != std::string::npos;
    }

    void edit(const std::string& from, const std::string& to) {
        std::ifstream file(folder_.path("mesh.effect"));
        std::ostringstream text;
        text << file.rdbuf();
        std::string content = text.str();
        ASSERT_NE(content.find(from), std::string::npos);
        folder_.write("mesh.effect", content.replace(content.find(from), from.size(), to));
        log_.str("");
    }

    test::TemporaryFolder folder_;
    std::ostringstream log_;
    std::shared_ptr<spdlog::logger> before_;
    std::unique_ptr<Renderer> renderer_;
    fabric::FrameData frame_;
};

TEST_F(EffectReload, AGoodEditShowsAndABadOneLeavesThePictureAsItWas) {
    const auto first = picture();
    EXPECT_EQ(picture(), first);
    edit("colour = display(litFrom(normal, relativeMetres, albedo));",
         "colour = vec4(1.0, 0.0, 1.0, 1.0);");
    ASSERT_TRUE(drawUntilLogged("mesh.effect: taken from EYRIE_EFFECTS")) << log_.str();
    const auto magenta = picture();
    EXPECT_NE(magenta, first);
    EXPECT_GT(std::count(magenta.begin(), magenta.end(), fabric::Rgba{255, 0, 255, 255}), 100);
    edit("colour = vec4(1.0, 0.0, 1.0, 1.0);", "colour = vec5(1.0);");
    ASSERT_TRUE(drawUntilLogged("mesh.effect stays as it was")) << log_.str();
    EXPECT_EQ(picture(), magenta);
    edit("colour = vec5(1.0);", "colour = display(litFrom(normal, relativeMetres, albedo));");
    ASSERT_TRUE(drawUntilLogged("mesh.effect: taken from EYRIE_EFFECTS")) << log_.str();
    EXPECT_EQ(picture(), first);
}

}  // namespace
}  // namespace eyrie
