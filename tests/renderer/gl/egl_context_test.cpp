// SPDX-License-Identifier: Apache-2.0
#include "renderer/gl/egl_context.h"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/gl/debug_output.h"
#include "renderer/gl/framebuffer.h"
#include "renderer/gl/program.h"

namespace eyrie::gl {
namespace {

class EglContextTest : public testing::Test {
protected:
    static void SetUpTestSuite() { setOnGlError(OnGlError::Abort); }
};

TEST_F(EglContextTest, OpensWithoutADisplayServerAndSaysWhatItFound) {
    auto context = EglContext::create(-1);
    ASSERT_TRUE(context.ok()) << context.status();
    const fabric::DeviceInfo& device = (*context)->device();
    EXPECT_FALSE(device.renderer.empty());
    EXPECT_FALSE(device.platform.empty());
    GLint major = 0;
    GLint minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    EXPECT_GE(major * 10 + minor, 45);
    EXPECT_EQ(device.software, device.renderer.find("llvmpipe") != std::string::npos);
}

TEST_F(EglContextTest, RefusesADeviceThatIsNotThere) {
    auto context = EglContext::create(99);
    ASSERT_FALSE(context.ok());
    EXPECT_EQ(context.status().code(), absl::StatusCode::kFailedPrecondition);
    EXPECT_NE(std::string(context.status().message()).find("index 99"), std::string::npos)
        << context.status();
}

TEST_F(EglContextTest, CanBeOpenedAgainAfterItWasClosed) {
    for (int i = 0; i < 3; ++i) {
        auto context = EglContext::create(-1);
        ASSERT_TRUE(context.ok()) << context.status();
        EXPECT_NE(Buffer().id(), 0U);
    }
}

TEST_F(EglContextTest, OfSeveralOnOneThreadTheOneThatWasMadeCurrentIs) {
    const auto one = EglContext::create(-1);
    ASSERT_TRUE(one.ok()) << one.status();
    const Buffer buffer;
    {
        const auto two = EglContext::create(-1);
        ASSERT_TRUE(two.ok()) << two.status();
        EXPECT_FALSE(glIsBuffer(buffer.id()));
        ASSERT_TRUE((*one)->makeCurrent().ok());
        EXPECT_TRUE(glIsBuffer(buffer.id()));
        ASSERT_TRUE((*two)->makeCurrent().ok());
        EXPECT_FALSE(glIsBuffer(buffer.id()));
    }
    ASSERT_TRUE((*one)->makeCurrent().ok());
    EXPECT_TRUE(glIsBuffer(buffer.id()));
}

TEST_F(EglContextTest, FramebufferClearsAndReadsOnlyItsPart) {
    auto context = EglContext::create(-1);
    ASSERT_TRUE(context.ok()) << context.status();
    Framebuffer framebuffer;
    ASSERT_TRUE(framebuffer.resize(64, 32).ok());
    framebuffer.begin(64, 32, {0, 0, 64, 32}, {1, 2, 3, 255});
    framebuffer.begin(64, 32, {8, 4, 16, 8}, {200, 100, 50, 255});
    const fabric::Image image = framebuffer.read({0, 0, 64, 32}, true);
    EXPECT_EQ(image.colour[0], (fabric::Rgba{1, 2, 3, 255}));
    EXPECT_EQ(image.colour[4 * 64 + 8], (fabric::Rgba{200, 100, 50, 255}));
    EXPECT_EQ(image.colour[4 * 64 + 24], (fabric::Rgba{1, 2, 3, 255}));
    EXPECT_EQ(image.depth[5 * 64 + 9], 0.0F);
}

TEST_F(EglContextTest, DepthsOfAnyPartAreThoseOfThePicture) {
    const auto context = EglContext::create(-1).value();
    Framebuffer framebuffer;
    ASSERT_TRUE(framebuffer.resize(40, 30).ok());
    for (int part = 0; part < 4; ++part) {  // each quarter has a depth of its own
        framebuffer.begin(40, 30, {20 * (part % 2), 15 * (part / 2), 20, 15}, {});
        glClearDepth(0.125 * (part + 1));
        glClear(GL_DEPTH_BUFFER_BIT);
    }
    const fabric::Image whole = framebuffer.read({0, 0, 40, 30}, true);
    EXPECT_EQ(whole.depth.front(), 0.125F);
    EXPECT_EQ(whole.depth.back(), 0.5F);
    EXPECT_TRUE(framebuffer.depth({5, 5, 0, 0}).empty());
    // Smaller and larger ones than there was memory for.
    for (const fabric::PixelViewport& part :
         {fabric::PixelViewport{18, 13, 4, 4}, {0, 0, 40, 30}, {19, 0, 2, 30}}) {
        const auto depth = framebuffer.depth(part);
        EXPECT_EQ(std::vector<float>(depth.begin(), depth.end()),
                  framebuffer.read(part, true).depth);
    }
}

TEST_F(EglContextTest, ShaderErrorsNameTheShader) {
    auto context = EglContext::create(-1);
    ASSERT_TRUE(context.ok()) << context.status();
    const auto program = Program::create({"bad.vert.glsl", "#version 450 core\nnonsense"},
                                         {"good.frag.glsl", "#version 450 core\nvoid main() {}"});
    ASSERT_FALSE(program.ok());
    EXPECT_NE(std::string(program.status().message()).find("bad.vert.glsl"), std::string::npos);
}

/// As users' contexts are: errors are there to be asked for, not only where a driver reports them.
class GlErrorTest : public testing::Test {
protected:
    void SetUp() override {
        setOnGlError(OnGlError::Log);
        context_ = EglContext::create(-1).value();
    }
    void TearDown() override {
        context_.reset();
        setOnGlError(OnGlError::Abort);
    }

private:
    std::unique_ptr<EglContext> context_;
};

TEST_F(GlErrorTest, IsTakenOnce) {
    EXPECT_TRUE(takeGlError().ok());
    glEnable(GL_RGBA8);
    glEnable(GL_RGBA8);
    const absl::Status error = takeGlError();
    EXPECT_EQ(error.code(), absl::StatusCode::kInternal);
    EXPECT_NE(std::string(error.message()).find("0x500"), std::string::npos) << error;
    EXPECT_TRUE(takeGlError().ok());
}

TEST_F(GlErrorTest, SaysThatTheDeviceHasNoMemory) {
    const Buffer buffer;
    constexpr GLsizeiptr kMoreThanAnyDeviceHas = GLsizeiptr{1} << 50;
    glNamedBufferStorage(buffer.id(), kMoreThanAnyDeviceHas, nullptr, 0);
    const absl::Status error = takeGlError();
    EXPECT_EQ(error.code(), absl::StatusCode::kResourceExhausted) << error;
}

TEST_F(GlErrorTest, OnlyTestsHaveADebugContext) {
    const auto isDebug = [] {
        GLint flags = 0;
        glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
        return (flags & GL_CONTEXT_FLAG_DEBUG_BIT) != 0;
    };
    EXPECT_FALSE(isDebug());
    setOnGlError(OnGlError::Abort);
    const auto context = EglContext::create(-1).value();
    EXPECT_TRUE(isDebug());
}

}  // namespace
}  // namespace eyrie::gl
