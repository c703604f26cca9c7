// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/effect_variants.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include "effects/mesh_effect.h"
#include "effects/mesh_points_effect.h"
#include "effects/terrain_effect.h"
#include "fabric/log.h"
#include "renderer/gl/debug_output.h"
#include "renderer/gl/egl_context.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::effects {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

const std::filesystem::path kEffects = EYRIE_SOURCE_DIR "/renderer/effects";

/// Terrain's programs with a copy of the effect files to edit, a clock to turn and the log to read.
class EffectVariantsTest : public testing::Test {
protected:
    using Variant = TerrainEffect::Variant;

    static void SetUpTestSuite() { gl::setOnGlError(gl::OnGlError::Abort); }

    void SetUp() override {
        auto context = gl::EglContext::create(-1);
        ASSERT_TRUE(context.ok()) << context.status();
        context_ = *std::move(context);
        for (const char* name : {"terrain.effect", "object.block"})
            std::filesystem::copy_file(kEffects / name, folder_.path(name));
        before_ = spdlog::default_logger();
        spdlog::set_default_logger(std::make_shared<spdlog::logger>(
            "test", std::make_shared<spdlog::sinks::ostream_sink_st>(log_)));
        programs_.emplace(folder_.path());
    }

    void TearDown() override {
        programs_.reset();
        spdlog::set_default_logger(before_);
    }

    /// Replaces the first `from` in a file.
    void edit(const char* name, const std::string& from, const std::string& to) {
        std::ifstream file(folder_.path(name));
        std::ostringstream text;
        text << file.rdbuf();
        std::string content = text.str();
        const std::size_t at = content.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        folder_.write(name, content.replace(at, from.size(), to));
        // Unlike in an editor's hands, two edits may fall into one tick of the file system's clock.
        stamp_ += seconds(1);
        std::filesystem::last_write_time(folder_.path(name), stamp_);
    }

    /// What the log gains by a look at the files, later than any before.
    std::string reload() {
        log_.str("");
        now_ += seconds(2);
        programs_->reloadChanged(now_);
        return log_.str();
    }

    const TerrainEffect* find(const Variant& variant = {}) {
        const auto program = programs_->find(variant);
        EXPECT_TRUE(program.ok()) << program.status();
        return program.ok() ? *program : nullptr;
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<gl::EglContext> context_;
    std::optional<EffectVariants<TerrainEffect>> programs_;
    std::ostringstream log_;
    std::shared_ptr<spdlog::logger> before_;
    EffectWatch::Clock::time_point now_;
    std::filesystem::file_time_type stamp_ = std::filesystem::file_time_type::clock::now();
};

TEST_F(EffectVariantsTest, EveryBuiltInVariantCompilesAndSetsWhatTheDriverKept) {
    for (const bool flat : {false, true})
        for (const bool conformal : {false, true})
            for (int lights = 1; lights <= Variant::kMaxLights; ++lights) {
                const ObjectBlock::Variant object{lights, flat, conformal};
                for (int look = 0; look < 8; ++look) {
                    Variant variant{object};
                    variant.transfer = (look & 1) != 0;
                    variant.contours = (look & 2) != 0;
                    variant.adjusted = (look & 4) != 0;
                    const auto terrain = TerrainEffect::create(variant);
                    ASSERT_TRUE(terrain.ok()) << terrain.status();
                    // A uniform that this variant does not use may be set all the same.
                    terrain->worldFromNormal(glm::mat3(1.0F));
                    terrain->lineWidth(1.0F);
                }
                const auto points = MeshPointsEffect::create({object, {}});
                ASSERT_TRUE(points.ok()) << points.status();
                points->pointRadius(0.25F);
                for (const bool gouraud : {false, true}) {
                    for (int surface = lights == 1 ? 5 : 0; surface >= 0; --surface) {
                        const auto mesh = MeshEffect::create(
                            {object, {}, gouraud, surface % 2 == 1, surface / 2});
                        ASSERT_TRUE(mesh.ok()) << mesh.status();
                        mesh->worldFromNormal(glm::mat3(1.0F));
                        mesh->alphaCutoff(0.5F);
                        mesh->lightColours(std::vector<glm::vec3>(Variant::kMaxLights));
                    }
                }
            }
}

TEST_F(EffectVariantsTest, RefusesAValueOutOfItsRange) {
    const auto program = TerrainEffect::create({{.lights = 6}});
    EXPECT_EQ(program.status(),
              absl::InvalidArgumentError("terrain.effect: LIGHTS is 6; it must be from 1 to 5"));
}

TEST_F(EffectVariantsTest, UniformsArriveWithTheirTypes) {
    const TerrainEffect* program = find();
    ASSERT_NE(program, nullptr);
    program->use();
    program->tileOrigin({1, -2, 3});
    program->ambient(0.25F);
    GLint used = 0;
    glGetIntegerv(GL_CURRENT_PROGRAM, &used);
    const auto id = static_cast<GLuint>(used);
    glm::ivec3 origin;
    glGetUniformiv(id, glGetUniformLocation(id, "tileOrigin"), &origin.x);
    EXPECT_EQ(origin, glm::ivec3(1, -2, 3));
    float ambient = 0;
    glGetUniformfv(id, glGetUniformLocation(id, "ambient"), &ambient);
    EXPECT_EQ(ambient, 0.25F);
}

TEST_F(EffectVariantsTest, APassSetsTheStateThatItsFileNames) {
    const auto value = [](GLenum name) {
        std::array<GLint, 2> values{};
        glGetIntegerv(name, values.data());
        return static_cast<GLenum>(values[0]);
    };
    glEnable(GL_BLEND);
    TerrainEffect::kWireframe.apply();
    EXPECT_EQ(value(GL_POLYGON_MODE), static_cast<GLenum>(GL_LINE));
    EXPECT_EQ(value(GL_DEPTH_FUNC), static_cast<GLenum>(GL_GREATER));
    EXPECT_EQ(value(GL_CLIP_DEPTH_MODE), static_cast<GLenum>(GL_ZERO_TO_ONE));
    EXPECT_TRUE(glIsEnabled(GL_DEPTH_TEST));
    EXPECT_FALSE(glIsEnabled(GL_BLEND));
    gl::PassState culled = TerrainEffect::kSolid;
    culled.culledFace = GL_FRONT;
    culled.apply();
    EXPECT_EQ(value(GL_POLYGON_MODE), static_cast<GLenum>(GL_FILL));
    EXPECT_EQ(value(GL_CULL_FACE_MODE), static_cast<GLenum>(GL_FRONT));
    EXPECT_TRUE(glIsEnabled(GL_CULL_FACE));
    TerrainEffect::kSolid.apply();
    EXPECT_FALSE(glIsEnabled(GL_CULL_FACE));
}

TEST_F(EffectVariantsTest, ADriversErrorNamesTheEffectFilesLine) {
    edit("terrain.effect", "#if FLAT", "    normal = oops;\n#if FLAT");
    std::ifstream file(folder_.path("terrain.effect"));
    std::string line;
    int number = 0;
    while (std::getline(file, line) && ++number > 0 && line.find("oops") == std::string::npos) {
    }
    EXPECT_THAT(reload(), HasSubstr("\nterrain.effect:" + std::to_string(number) + ":"));
}

TEST_F(EffectVariantsTest, AGoodEditReplacesProgramsOnceAndABadOneReplacesNone) {
    EXPECT_THAT(reload(), HasSubstr("terrain.effect: taken from EYRIE_EFFECTS"));
    EXPECT_EQ(reload(), "");
    EXPECT_NE(find(), nullptr);
    edit("object.block", "sqrt(clamp(linear, 0.0, 1.0))", "linear");
    EXPECT_THAT(reload(), HasSubstr("taken from"));
    const TerrainEffect* good = find();
    edit("object.block", "vec4(linear, 1.0)", "vec4(linear, oops)");
    EXPECT_THAT(reload(), HasSubstr("object.block:"));
    EXPECT_EQ(find(), good);
    EXPECT_EQ(reload(), "");
    edit("object.block", "vec4(linear, oops)", "vec4(linear, 1.0)");
    EXPECT_THAT(reload(), HasSubstr("taken from"));
}

TEST_F(EffectVariantsTest, LooksAtTheFilesOnceASecond) {
    reload();
    edit("object.block", "vec3(ambient)", "vec3(0.5)");
    log_.str("");
    programs_->reloadChanged(now_ + milliseconds(999));
    EXPECT_EQ(log_.str(), "");
    programs_->reloadChanged(now_ + milliseconds(1000));
    EXPECT_THAT(log_.str(), HasSubstr("taken from"));
}

TEST_F(EffectVariantsTest, ErrorsOfTheLanguageNameTheLineAndChangeNothing) {
    reload();
    const TerrainEffect* program = find();
    edit("object.block", "variant bool FLAT;", "variant bool flat;");
    EXPECT_THAT(reload(),
                HasSubstr("object.block:6:14: expected the parameter's name in capitals"));
    EXPECT_EQ(find(), program);
}

TEST_F(EffectVariantsTest, DeclarationsThatCppReliesOnMayNotChange) {
    reload();
    const TerrainEffect* program = find();
    edit("terrain.effect", "uniform int spacingShift;", "uniform float spacingShift;");
    EXPECT_THAT(reload(), HasSubstr("'uniform float spacingShift' was built as "
                                    "'uniform int spacingShift'"));
    edit("terrain.effect", "uniform float spacingShift;", "");
    EXPECT_THAT(reload(), HasSubstr("terrain.effect: 'uniform int spacingShift' is missing"));
    edit("terrain.effect", "uniform ivec2 lastPost;",
         "uniform ivec2 lastPost; uniform int spacingShift; uniform float extra;");
    EXPECT_THAT(reload(), HasSubstr("'uniform float extra' is new and nothing sets it"));
    edit("terrain.effect", " uniform float extra;", "");
    EXPECT_EQ(find(), program);
    EXPECT_THAT(reload(), HasSubstr("taken from"));
}

TEST_F(EffectVariantsTest, AVariantThatFailsLaterIsDrawnAsItWasBuilt) {
    edit("terrain.effect", "#if FLAT", "#if FLAT\n    oops;");
    EXPECT_THAT(reload(), HasSubstr("taken from"));
    log_.str("");
    EXPECT_NE(find({{.flat = true}}), nullptr);
    EXPECT_THAT(log_.str(), HasSubstr("oops"));
    log_.str("");
    EXPECT_NE(find({{.flat = true}}), nullptr);
    EXPECT_EQ(log_.str(), "");
}

TEST_F(EffectVariantsTest, AFileThatIsMissingIsReportedOnceAndTakenWhenItComes) {
    std::filesystem::rename(folder_.path("terrain.effect"), folder_.path("away"));
    EXPECT_THAT(reload(), HasSubstr("terrain.effect: cannot be opened"));
    EXPECT_EQ(reload(), "");
    EXPECT_NE(find(), nullptr);
    std::filesystem::rename(folder_.path("away"), folder_.path("terrain.effect"));
    EXPECT_THAT(reload(), HasSubstr("taken from"));
}

TEST_F(EffectVariantsTest, NothingIsReadWithoutAFolder) {
    EffectVariants<TerrainEffect> builtIn{std::nullopt};
    builtIn.reloadChanged(now_);
    EXPECT_TRUE(builtIn.find({}).ok());
    EXPECT_EQ(log_.str(), "");
}

}  // namespace
}  // namespace eyrie::effects
