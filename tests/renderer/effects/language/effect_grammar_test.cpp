// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/effect_grammar.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::effects {
namespace {

std::string messageOf(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

/// What parsing `text` as a.effect says; empty when it parses.
std::string errorOf(std::string_view text) {
    const auto file = parseEffectFile(text, "a.effect");
    if (!file.ok()) {
        EXPECT_EQ(file.status().code(), absl::StatusCode::kInvalidArgument);
    }
    return messageOf(file.status());
}

std::string terrainEffect() {
    std::ifstream file(EYRIE_SOURCE_DIR "/renderer/effects/terrain.effect");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(EffectGrammar, ReadsEveryKindOfStatement) {
    const auto file = parseEffectFile(R"(// A comment, and /* another */ before anything
include "object.block";
variant int LIGHTS 1..4;  // how many
variant bool FLAT;
uniform vec3 lightColours [ LIGHTS ] ;   // linear \
uniform sampler2D normalMap at 3;
input uvec2 packedVertex at 5 from uint32 or uint32[2];  // words
pass solid { depth greater; /* all */ cull none; polygon fill; }  // opaque
stage vertex { void main() { if (true) { } // }
  /* } */ } }
stage fragment {}
)",
                                      "a.effect");
    ASSERT_TRUE(file.ok()) << file.status();
    ASSERT_EQ(file->includes.size(), 1U);
    EXPECT_EQ(file->includes[0].file, "object.block");
    ASSERT_EQ(file->parameters.size(), 2U);
    EXPECT_EQ(file->parameters[0].name, "LIGHTS");
    EXPECT_EQ(file->parameters[0].low, 1);
    EXPECT_EQ(file->parameters[0].high, 4);
    EXPECT_EQ(file->parameters[0].comment, "how many");
    EXPECT_FALSE(file->parameters[0].isBool);
    EXPECT_EQ(file->parameters[1].name, "FLAT");
    EXPECT_TRUE(file->parameters[1].isBool);
    EXPECT_EQ(file->parameters[1].comment, "");
    ASSERT_EQ(file->uniforms.size(), 2U);
    EXPECT_EQ(file->uniforms[0].length, "LIGHTS");
    EXPECT_EQ(file->uniforms[0].comment, "linear");
    EXPECT_EQ(file->uniforms[0].unit, -1);
    EXPECT_EQ(file->uniforms[1].type, "sampler2D");
    EXPECT_EQ(file->uniforms[1].unit, 3);
    EXPECT_EQ(file->uniforms[1].place.line, 6U);
    ASSERT_EQ(file->inputs.size(), 1U);
    EXPECT_EQ(file->inputs[0].location, 5);
    EXPECT_EQ(file->inputs[0].sources, (std::vector<int>{1, 2}));
    ASSERT_EQ(file->passes.size(), 1U);
    EXPECT_EQ(file->passes[0].depth, "greater");
    EXPECT_EQ(file->passes[0].cull, "none");
    EXPECT_EQ(file->passes[0].polygon, "fill");
    EXPECT_EQ(file->passes[0].comment, "opaque");
    ASSERT_EQ(file->stages.size(), 2U);
    EXPECT_EQ(file->stages[0].kind, StageKind::Vertex);
    EXPECT_EQ(file->stages[0].body, " void main() { if (true) { } // }\n  /* } */ } ");
    EXPECT_EQ(file->stages[0].bodyPlace.line, 9U);
    EXPECT_EQ(file->stages[1].kind, StageKind::Fragment);
    EXPECT_EQ(file->stages[1].body, "");
}

TEST(EffectGrammar, AnEmptyFileIsAnEffectWithoutStatements) {
    EXPECT_EQ(errorOf(""), "");
    EXPECT_EQ(errorOf("\r\n // nothing"), "");
}

struct Wrong {
    std::string_view text;
    std::string_view message;
};

TEST(EffectGrammar, ErrorsNameLineAndColumnAndWhatWasExpected) {
    const std::string_view statements =
        "expected include, variant, uniform, input, pass or stage, found ";
    const std::vector<Wrong> table{
        {"pas solid {}",
         "1:1: expected include, variant, uniform, input, pass or stage, found 'pas'"},
        {"\n  ;", "2:3: expected include, variant, uniform, input, pass or stage, found ';'"},
        {"/* open", "1:1: the comment that begins here has no '*/' that ends it"},
        {"include object;",
         "1:9: expected a block's name in quotes, such as \"object.block\", "
         "found 'object'"},
        {"include \"a.block\"", "1:18: expected ';', found the end of the file"},
        {"variant float X;", "1:9: expected 'int' or 'bool', found 'float'"},
        {"variant int lights 1..4;",
         "1:13: expected the parameter's name in capitals, found "
         "'lights'"},
        {"variant int A one..4;", "1:15: expected a number of at most 6 digits, found 'one'"},
        {"variant int A 1-4;", "1:16: expected '..' between two numbers, found '-'"},
        {"variant int A 1..;", "1:18: expected a number of at most 6 digits, found ';'"},
        {"variant int A 1..1234567;",
         "1:18: expected a number of at most 6 digits, found '1234567'"},
        {"uniform 3;", "1:9: expected a GLSL type, found '3'"},
        {"uniform vec3 Colour;",
         "1:14: expected the uniform's name in lowerCamelCase, found "
         "'Colour'"},
        {"uniform vec3 a_b;", "1:14: expected the uniform's name in lowerCamelCase, found 'a_b'"},
        {"uniform vec3 a[3];",
         "1:16: expected the variant parameter, in capitals, that is the "
         "array's length, found '3'"},
        {"uniform vec3 a[N;", "1:17: expected ']', found ';'"},
        {"uniform sampler2D a at x;", "1:24: expected a texture unit's number, found 'x'"},
        {"uniform vec3 a b;", "1:16: expected ';', found 'b'"},
        {"input ;", "1:7: expected a GLSL type, found ';'"},
        {"input uint A", "1:12: expected the input's name in lowerCamelCase, found 'A'"},
        {"input uint a;", "1:13: expected 'at' and a location, found ';'"},
        {"input uint a at b", "1:17: expected a location's number, found 'b'"},
        {"input uint a at 0;", "1:18: expected 'from' and a source format, found ';'"},
        {"input uint a at 0 from int;",
         "1:24: expected a source format, uint32 or uint32[N], "
         "found 'int'"},
        {"input uint a at 0 from uint32 or;",
         "1:33: expected a source format, uint32 or "
         "uint32[N], found ';'"},
        {"input uint a at 0 from uint32[n];", "1:31: expected a number of words, found 'n'"},
        {"input uint a at 0 from uint32[2;", "1:32: expected ']', found ';'"},
        {"pass {", "1:6: expected the pass's name in lowerCamelCase, found '{'"},
        {"pass a depth", "1:8: expected '{', found 'depth'"},
        {"pass a { depth; }", "1:15: expected the state's value, found ';'"},
        {"pass a { depth less cull", "1:21: expected ';', found 'cull'"},
        {"pass a { depth less;",
         "1:21: expected a setting such as 'depth greater;', or '}', "
         "found the end of the file"},
        {"pass a { blend on; }", "1:16: a pass sets depth, cull and polygon, not 'blend'"},
        {"pass a { cull none;\n cull back; }", "2:7: cull is set a second time in this pass"},
        {"stage geometry {}",
         "1:7: expected 'vertex', 'fragment', 'shared' or 'compute', found 'geometry'"},
        {"stage vertex;", "1:13: expected '{', found ';'"},
        {"stage vertex { {}", "1:15: the stage that begins here has no '}' that ends it"},
        {"stage vertex {\n\n /* }", "3:2: the comment that begins here has no '*/' that ends it"},
        {"\xC3\xA9",
         "1:1: expected include, variant, uniform, input, pass or stage, found byte "
         "0xc3"},
        {"// a\n\x01", "2:1: byte 0x01 is not text"},
    };
    for (const Wrong& wrong : table)
        EXPECT_EQ(errorOf(wrong.text), "a.effect:" + std::string(wrong.message)) << wrong.text;
    EXPECT_NE(errorOf("}").find(statements), std::string::npos);
}

TEST(EffectGrammar, NestingAndSizeAreBounded) {
    const auto nested = [](int depth) {
        return "stage vertex {" + std::string(static_cast<std::size_t>(depth), '{') +
               std::string(static_cast<std::size_t>(depth), '}') + "}";
    };
    EXPECT_EQ(errorOf(nested(kMaxBraceDepth)), "");
    EXPECT_EQ(errorOf(nested(kMaxBraceDepth + 1)),
              "a.effect:1:79: braces nest too deep: at most 64 may be open");
    EXPECT_EQ(errorOf(nested(500'000)), errorOf(nested(kMaxBraceDepth + 1)));
    EXPECT_EQ(errorOf(std::string(kMaxEffectBytes, ' ')), "");
    EXPECT_EQ(errorOf(std::string(kMaxEffectBytes + 1, ' ')),
              "a.effect: has 1048577 bytes; an effect file has at most 1048576");
}

/// Parsed, or refused with a place inside the text.
void expectAnAnswer(const std::string& text) {
    const std::string error = errorOf(text);
    if (error.empty())
        return;
    std::size_t line = 0;
    std::size_t column = 0;
    RC_ASSERT(std::sscanf(error.c_str(), "a.effect:%zu:%zu: ", &line, &column) == 2);
    std::istringstream lines(text + "\n");
    std::string at;
    for (std::size_t i = 0; i < line; ++i) RC_ASSERT(std::getline(lines, at).good());
    RC_ASSERT(column >= 1 && column <= at.size() + 1);
}

TEST(EffectGrammar, EveryTruncationParsesOrIsRefusedWithAPlace) {
    const std::string text = terrainEffect();
    ASSERT_GT(text.size(), 1000U);
    for (std::size_t size = 0; size < text.size(); ++size) expectAnAnswer(text.substr(0, size));
}

RC_GTEST_PROP(EffectGrammar, AnyBytesParseOrAreRefusedWithAPlace, (const std::string& text)) {
    expectAnAnswer(text);
}

RC_GTEST_PROP(EffectGrammar, EditedEffectsParseOrAreRefusedWithAPlace, ()) {
    static const std::string original = terrainEffect();
    std::string text = original;
    const int edits = *rc::gen::inRange(1, 6);
    for (int i = 0; i < edits; ++i) {
        const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
        const auto from = *rc::gen::inRange<std::size_t>(0, original.size());
        const auto length = *rc::gen::inRange<std::size_t>(0, 40);
        text.replace(at, *rc::gen::inRange<std::size_t>(0, 40), original.substr(from, length));
    }
    expectAnAnswer(text);
}

RC_GTEST_PROP(EffectGrammar, WordsInAnyOrderParseOrAreRefusedWithAPlace, ()) {
    const auto words =
        *rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(std::vector<std::string>{
            "variant", "int", "bool", "A",     "1",       "..",   "uniform", "vec3",
            "a",       "[",   "]",    "at",    "input",   "from", "uint32",  "or",
            "pass",    "{",   "}",    "depth", "less",    ";",    "stage",   "vertex",
            "//",      "/*",  "*/",   "\n",    "include", "\"",   "a.block"}));
    std::string text;
    for (const std::string& word : words) text += word + " ";
    expectAnAnswer(text);
}

}  // namespace
}  // namespace eyrie::effects
