// SPDX-License-Identifier: Apache-2.0
#include "tools/effect_compiler/glsl_validator.h"

#include <gtest/gtest.h>

#include "renderer/effects/language/effect_loader.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::effects {
namespace {

/// The verdict of EYRIE_GLSLANG_VALIDATOR, which CMake found, on an effect with these stages.
absl::Status validate(const std::string& text, const char* validator = EYRIE_GLSLANG_VALIDATOR) {
    const test::TemporaryFolder folder;
    folder.write("a.effect", text);
    folder.write("b.block",
                 "variant bool BAD;\n\nstage fragment {\nfloat half_(float x) {\n"
                 "    return x * undefinedInBlock;\n}\n}\n");
    auto effect = loadEffect("a.effect", effectFolder(folder.path()));
    if (!effect.ok())
        return effect.status();
    return validateGlsl(*effect, validator);
}

std::string messageOf(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

TEST(GlslValidator, AcceptsAnEffectWhoseVariantsAllCompile) {
    EXPECT_EQ(validate("variant int N 1..3;\nuniform float unused;\nstage vertex {\n"
                       "void main() { gl_Position = vec4(N); }\n}\nstage fragment {\n"
                       "out vec4 c;\nvoid main() { c = vec4(N); }\n}\n"),
              absl::OkStatus());
}

TEST(GlslValidator, NamesTheEffectFilesLineAndTheVariantThatFails) {
    const absl::Status status = validate(
        "variant bool BAD;\nstage vertex {\nvoid main() { gl_Position = vec4(1); }\n}\n"
        "stage fragment {\nout vec4 c;\nvoid main() {\n#if BAD\n    c = vec4(oops);\n"
        "#else\n    c = vec4(1);\n#endif\n}\n}\n");
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(messageOf(status).find("a.effect:9: error: 'oops' : undeclared identifier"),
              std::string::npos)
        << status;
    EXPECT_NE(messageOf(status).find("a.effect: the GLSL above is refused with BAD=1"),
              std::string::npos)
        << status;
}

TEST(GlslValidator, NamesABlocksLine) {
    const absl::Status status = validate(
        "include \"b.block\";\nstage vertex {void main() {}}\n"
        "stage fragment {out vec4 c; void main() { c = vec4(half_(1.0)); }}");
    EXPECT_NE(messageOf(status).find("b.block:5: error: 'undefinedInBlock'"), std::string::npos)
        << status;
}

TEST(GlslValidator, NamesTheLineOfADeclarationThatGlslRefuses) {
    const absl::Status status = validate(
        "\nuniform float sample;\nstage vertex {void main() {}}\nstage fragment {void main() {}}");
    EXPECT_NE(messageOf(status).find("a.effect:2: error: "), std::string::npos) << status;
}

TEST(GlslValidator, RefusesStagesThatDoNotFitTogether) {
    const absl::Status status = validate(
        "stage vertex { out vec3 passed; void main() { passed = vec3(1); }}\n"
        "stage fragment { in vec2 passed; out vec4 c; void main() { c = passed.xyxy; }}");
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
    EXPECT_NE(messageOf(status).find("passed"), std::string::npos) << status;
}

TEST(GlslValidator, RefusesStagesThatDoNotFitTogetherInOneVariant) {
    const absl::Status status = validate(
        "variant int N 1..4;\nvariant bool OTHER;\n"
        "stage vertex {\n#if N == 3\nout vec3 passed;\n#else\nout vec2 passed;\n#endif\n"
        "void main() { passed.x = 1.0; }\n}\n"
        "stage fragment { in vec2 passed; out vec4 c; void main() { c = passed.xyxy; }}");
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
    EXPECT_NE(messageOf(status).find("N=3"), std::string::npos) << status;
}

TEST(GlslValidator, JudgesAComputeStage) {
    const std::string head = "uniform int n;\nstage compute {\nlayout(local_size_x = 4) in;\n";
    EXPECT_EQ(validate(head + "layout(std430, binding = 0) buffer B { int b[]; };\n"
                              "void main() { b[gl_LocalInvocationIndex] = n; }\n}\n"),
              absl::OkStatus());
    const absl::Status status = validate(head + "void main() { b[0] = n; }\n}\n");
    EXPECT_NE(messageOf(status).find("a.effect:4: error: 'b' : undeclared identifier"),
              std::string::npos)
        << status;
}

TEST(GlslValidator, SaysWhenItCannotBeRun) {
    const absl::Status status =
        validate("stage vertex {void main() {}}\nstage fragment {void main() {}}", "/no/such/tool");
    EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
    EXPECT_NE(messageOf(status).find("/no/such/tool"), std::string::npos) << status;
}

}  // namespace
}  // namespace eyrie::effects
