// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/effect_loader.h"

#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/effects/language/glsl_writer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::effects {
namespace {

constexpr std::string_view kStages = "stage vertex {}\nstage fragment {}\n";

using Files = std::map<std::string, std::string>;

ReadEffectFile from(const Files& files) {
    return [&files](std::string_view name) -> absl::StatusOr<std::string> {
        const auto found = files.find(std::string(name));
        if (found == files.end())
            return absl::NotFoundError(fmt::format("{}: cannot be opened", name));
        return found->second;
    };
}

std::string errorOf(const Files& files) {
    const absl::Status status = loadEffect("a.effect", from(files)).status();
    return {status.message().data(), status.message().size()};
}

std::string errorIn(std::string effect) {
    Files files;
    files.emplace("a.effect", std::move(effect));
    return errorOf(files);
}

TEST(EffectLoader, PutsBlocksBeforeTheEffectThatIncludesThem) {
    const Files files{{"a.effect",
                       "include \"one.block\";\ninclude \"two.block\";\n"
                       "uniform vec3 c[N];\nstage vertex {}\nstage fragment {}"},
                      {"one.block", "variant int N 1..3;\nuniform float a;\n"},
                      {"two.block", "variant bool BLUE;\nuniform float b;\n"}};
    const auto effect = loadEffect("a.effect", from(files));
    ASSERT_TRUE(effect.ok()) << effect.status();
    EXPECT_EQ(sourceFiles(*effect),
              (std::vector<std::string>{"one.block", "two.block", "a.effect"}));
    const auto variants = allVariants(*effect);
    ASSERT_EQ(variants.size(), 6U);
    EXPECT_EQ(describe(variants[0]), "N=1 BLUE=0");
    EXPECT_EQ(describe(variants[5]), "N=3 BLUE=1");
    EXPECT_EQ(stagePreamble(variants[5]), "#version 450 core\n#define N 3\n#define BLUE 1\n");
    EXPECT_EQ(stageText(*effect, StageKind::Vertex),
              "#line 2 0\nuniform float a;\n#line 2000002 0\nuniform float b;\n"
              "#line 4000003 0\nuniform vec3 c[N];\n#line 4000004 0\n\n");
}

TEST(EffectLoader, FilesMayBeginWithAByteOrderMark) {
    const Files files{
        {"a.effect", "\xEF\xBB\xBFinclude \"b.block\";\nstage vertex {}\nstage fragment {}"},
        {"b.block", "\xEF\xBB\xBFuniform float a;\n"}};
    EXPECT_EQ(errorOf(files), "");
    EXPECT_EQ(
        errorIn("\xEF\xBB\xBFnonsense"),
        "a.effect:1:1: expected include, variant, uniform, input, pass or stage, found 'nonsense'");
}

TEST(EffectLoader, PutsWhatIsSharedIntoBothStages) {
    const Files files{
        {"a.effect", "include \"b.block\";\nstage vertex { v }\nstage fragment { f }"},
        {"b.block", "stage shared { s }\nstage fragment { g }"}};
    const auto effect = loadEffect("a.effect", from(files));
    ASSERT_TRUE(effect.ok()) << effect.status();
    EXPECT_EQ(stageText(*effect, StageKind::Vertex), "#line 1 0\n s \n#line 2000002 0\n v \n");
    EXPECT_EQ(stageText(*effect, StageKind::Fragment),
              "#line 1 0\n s \n#line 2 0\n g \n#line 2000003 0\n f \n");
    EXPECT_EQ(stageText(*effect, StageKind::Compute), "");
}

struct Wrong {
    std::string_view text;  ///< before two stages, in a.effect
    std::string_view message;
};

TEST(EffectLoader, ErrorsOfMeaningNameTheStatementsPlace) {
    const std::vector<Wrong> table{
        {"uniform vec7 a;",
         "1:1: the type of uniform a is 'vec7'; it must be float, int, vec3, "
         "ivec2, ivec3, mat3, mat4 or sampler2D"},
        {"uniform sampler2D a;",
         "1:1: a is a sampler; say which texture unit it has, as in 'at 0'"},
        {"uniform vec3 a at 1;", "1:1: a is no sampler and has no texture unit"},
        {"uniform sampler2D a at 16;", "1:1: a has texture unit 16; it must be from 0 to 15"},
        {"variant int N 1..2;\n uniform sampler2D a[N] at 1;",
         "2:2: a is a sampler and an array; give each sampler a name of its own"},
        {"uniform sampler2D a at 1; uniform sampler2D b at 1;",
         "1:27: texture unit 1 is already another sampler's"},
        {"uniform vec3 a[N];",
         "1:1: the length of a is N, which is no 'variant int' of 1 or more "
         "declared here or in a block that is included"},
        {"variant int N 0..2; uniform vec3 a[N];",
         "1:21: the length of a is N, which is no 'variant int' of 1 or more declared here or in a "
         "block that is included"},
        {"variant int N 3..2;", "1:1: N ranges from 3 down to 2; the lower comes first"},
        {"variant int GL_N 1..2;", "1:1: GLSL keeps names like GL_N for itself"},
        {"variant int N 1..512; variant bool B;",
         "1:23: B makes more than 512 variants of an effect"},
        {"input vec3 a at 0 from uint32;",
         "1:1: the type of input a is 'vec3'; it must be uint, uvec2, uvec3 or uvec4"},
        {"input uint a at 16 from uint32;", "1:1: a has location 16; it must be from 0 to 15"},
        {"input uint a at 0 from uint32[2];",
         "1:1: a is fed from uint32[2]; a uint takes from 1 to 1 words"},
        {"input uint a at 0 from uint32[0];",
         "1:1: a is fed from uint32[0]; a uint takes from 1 to 1 words"},
        {"input uvec2 a at 0 from uint32 or uint32[1];", "1:1: a names the same source twice"},
        {"input uint a at 0 from uint32;\ninput uint b at 0 from uint32;",
         "2:1: location 0 is already another input's"},
        {"pass a { depth less; cull none; }", "1:1: pass a does not set polygon"},
        {"pass a { depth near; cull none; polygon fill; }",
         "1:1: depth of pass a is 'near'; it must be less, lessEqual, equal, greater, greaterEqual "
         "or always"},
        {"pass a { depth less; cull all; polygon fill; }",
         "1:1: cull of pass a is 'all'; it must be none, back or front"},
        {"pass a { depth less; cull none; polygon point; }",
         "1:1: polygon of pass a is 'point'; it must be fill or line"},
        {"uniform float a;\nuniform int a;",
         "2:1: 'a' is already the name of something else, in a.effect:1"},
        {"variant bool LIGHT_ON;\nuniform int lightOn;",
         "2:1: 'lightOn' is already the name of something else, in a.effect:1"},
        {"uniform float new;", "1:1: 'new' means something else in C++; choose another name"},
        {"uniform float create;", "1:1: 'create' means something else in C++; choose another name"},
        {"\nstage vertex {}", "3:1: a second vertex stage; the first is in line 2"},
        {"stage shared {\n int a;\n # line 7\n}",
         "3:1: #line would have errors name other lines; leave it out"},
        {"include \"b.effect\";",
         "1:10: \"b.effect\" is no block; blocks are called "
         "lower_case.block"},
        {"include \"../b.block\";",
         "1:12: expected a block's name in quotes, such as "
         "\"object.block\", found '/'"},
        {"include \"..block\";",
         "1:10: \"..block\" is no block; blocks are called "
         "lower_case.block"},
        {"include \"b.block\";", "1:10: include: b.block: cannot be opened"},
    };
    for (const Wrong& wrong : table)
        EXPECT_EQ(errorIn(fmt::format("{}\n{}", wrong.text, kStages)),
                  fmt::format("a.effect:{}", wrong.message))
            << wrong.text;
}

TEST(EffectLoader, ErrorsOfBlocksNameTheBlock) {
    const std::string include = fmt::format("include \"b.block\";\n{}", kStages);
    EXPECT_EQ(
        errorOf({{"a.effect", include}, {"b.block", "\n oops"}}),
        "b.block:2:2: expected include, variant, uniform, input, pass or stage, found 'oops'");
    EXPECT_EQ(errorOf({{"a.effect", include}, {"b.block", "include \"c.block\";"}}),
              "b.block:1:10: a block includes nothing; only effects do");
    EXPECT_EQ(errorOf({{"a.effect", include}, {"b.block", "input uint a at 0 from uint32;"}}),
              "b.block:1:1: a block has no inputs; each effect has its own");
    EXPECT_EQ(errorOf({{"a.effect", "include \"b.block\";" + include}, {"b.block", ""}}),
              "a.effect:1:28: \"b.block\" is included twice");
}

TEST(EffectLoader, IncludesAreBounded) {
    std::string text(kStages);
    Files files;
    for (int i = 0; i <= 16; ++i) {
        text += fmt::format("include \"b{}.block\";\n", i);
        files[fmt::format("b{}.block", i)] = "";
    }
    files["a.effect"] = text;
    EXPECT_EQ(errorOf(files), "a.effect:19:10: an effect includes at most 16 blocks");
}

TEST(EffectLoader, AnEffectDrawsOrComputes) {
    EXPECT_EQ(errorIn("stage fragment {}"), "a.effect:1:1: the effect has no vertex stage");
    EXPECT_EQ(errorIn("stage vertex {}"), "a.effect:1:1: the effect has no fragment stage");
    const std::string compute = "stage compute {}\n";
    EXPECT_EQ(errorIn(compute + "stage shared {}"),
              "a.effect:2:1: a shared stage beside a compute stage; an effect draws or computes");
    EXPECT_EQ(errorIn(compute + "stage vertex {}"),
              "a.effect:2:1: a vertex stage beside a compute stage; an effect draws or computes");
    EXPECT_EQ(errorIn(compute + compute),
              "a.effect:2:1: a second compute stage; the first is in line 1");
    EXPECT_EQ(errorIn(compute + "input uint a at 0 from uint32;"),
              "a.effect:2:1: a is an input of an effect that computes; its GLSL reads buffers "
              "instead");
    EXPECT_EQ(errorIn(compute + "pass p { depth less; cull none; polygon fill; }"),
              "a.effect:2:1: pass p is of an effect that computes and draws nothing");
    const Files files{{"a.effect", "uniform int n;\nstage compute { void main() {} }"}};
    const auto effect = loadEffect("a.effect", from(files));
    ASSERT_TRUE(effect.ok()) << effect.status();
    EXPECT_EQ(stageText(*effect, StageKind::Compute),
              "#line 1 0\nuniform int n;\n#line 2 0\n void main() {} \n");
    EXPECT_EQ(stageText(*effect, StageKind::Vertex), "");
}

TEST(EffectLoader, RefusesNamesThatWouldLeaveTheFolder) {
    const Files none;
    for (const char* name :
         {"../a.effect", "a/b.effect", "A.effect", ".effect", "a", "a.effect.effect"})
        EXPECT_EQ(loadEffect(name, from(none)).status().code(), absl::StatusCode::kInvalidArgument)
            << name;
}

TEST(EffectLoader, ReadsAFolder) {
    const test::TemporaryFolder folder;
    folder.write("a.effect", kStages);
    EXPECT_TRUE(loadEffect("a.effect", effectFolder(folder.path())).ok());
    EXPECT_EQ(loadEffect("b.effect", effectFolder(folder.path())).status().code(),
              absl::StatusCode::kNotFound);
}

}  // namespace
}  // namespace eyrie::effects
