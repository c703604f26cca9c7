// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <tao/pegtl.hpp>

#include "renderer/effects/language/effect_grammar.h"

/// The grammar of effect files as PEGTL rules (Colin Hirsch and Daniel Frey, "Parsing Expression
/// Grammar Template Library"). Only effect_grammar.cpp includes this.
///
/// A rule that has a message below ends the parse where it fails, so it stands only where nothing
/// else may follow. No rule refers to itself: the stack does not grow with the text.
namespace eyrie::effects::rules {

namespace peg = tao::pegtl;

/// Ends the parse `at` bytes from here.
template <typename ParseInput>
[[noreturn]] void fail(ParseInput& in, std::size_t at, const char* message) {
    in.bump(at);
    throw peg::parse_error(message, in);
}

/// The last byte of the comment that begins at `at`, or `at` where none does. As in GLSL, a
/// backslash before the line's end continues a line comment.
template <typename ParseInput>
std::size_t endOfComment(ParseInput& in, std::size_t at) {
    const char second = in.size(at + 2) > at + 1 ? in.peek_char(at + 1) : '\0';
    if (in.peek_char(at) != '/' || (second != '/' && second != '*'))
        return at;
    std::size_t end = at + 2;
    for (; in.size(end + 1) > end; ++end) {
        if (second == '/' && in.peek_char(end) == '\n' && in.peek_char(end - 1) != '\\')
            return end;
        if (second == '*' && end > at + 2 && in.peek_char(end) == '/' &&
            in.peek_char(end - 1) == '*')
            return end;
    }
    if (second == '*')
        fail(in, at, "the comment that begins here has no '*/' that ends it");
    return end - 1;
}

// Between words.
struct BlockComment {
    using rule_t = BlockComment;
    using subs_t = peg::empty_list;

    template <typename ParseInput>
    static bool match(ParseInput& in) {
        if (in.size(2) < 2 || in.peek_char(0) != '/' || in.peek_char(1) != '*')
            return false;
        in.bump(endOfComment(in, 0) + 1);
        return true;
    }
};
struct LineComment : peg::seq<peg::two<'/'>, peg::until<peg::eolf>> {};
struct Blank : peg::star<peg::sor<peg::space, BlockComment, LineComment>> {};

/// A comment on the same line as what it describes.
struct DocText : peg::until<peg::at<peg::eolf>> {};
struct Doc : peg::opt<peg::star<peg::blank>, peg::two<'/'>, peg::star<peg::blank>, DocText> {};

struct Semicolon : peg::one<';'> {};
struct OpenBrace : peg::one<'{'> {};
struct CloseBrace : peg::one<'}'> {};
struct CloseBracket : peg::one<']'> {};
struct DotDot : peg::string<'.', '.'> {};
struct Digits : peg::seq<peg::rep_min_max<1, 6, peg::digit>, peg::not_at<peg::identifier_other>> {};

/// A word on its own, so that `passion` does not begin with `pass`.
template <char... Letters>
struct Word : peg::seq<peg::string<Letters...>, peg::not_at<peg::identifier_other>> {};
struct IncludeWord : Word<'i', 'n', 'c', 'l', 'u', 'd', 'e'> {};
struct VariantWord : Word<'v', 'a', 'r', 'i', 'a', 'n', 't'> {};
struct UniformWord : Word<'u', 'n', 'i', 'f', 'o', 'r', 'm'> {};
struct InputWord : Word<'i', 'n', 'p', 'u', 't'> {};
struct PassWord : Word<'p', 'a', 's', 's'> {};
struct StageWord : Word<'s', 't', 'a', 'g', 'e'> {};

// include "object.block";
struct FileName : peg::plus<peg::sor<peg::identifier_other, peg::one<'.'>>> {};
struct QuotedFile : peg::seq<peg::one<'"'>, FileName, peg::one<'"'>> {};
struct Include : peg::seq<IncludeWord, Blank, QuotedFile, Blank, Semicolon> {};

// variant int LIGHTS 1..4;  variant bool FLAT;
struct ParameterName
    : peg::seq<peg::upper, peg::star<peg::sor<peg::upper, peg::digit, peg::one<'_'>>>,
               peg::not_at<peg::identifier_other>> {};
struct Low : Digits {};
struct High : Digits {};
struct IntParameter
    : peg::seq<Word<'i', 'n', 't'>, Blank, ParameterName, Blank, Low, Blank, DotDot, Blank, High> {
};
struct BoolWord : Word<'b', 'o', 'o', 'l'> {};
struct BoolParameter : peg::seq<BoolWord, Blank, ParameterName> {};
struct ParameterKind : peg::sor<IntParameter, BoolParameter> {};
struct Variant : peg::seq<VariantWord, Blank, ParameterKind, Blank, Semicolon, Doc> {};

/// What C++ also calls something: lowerCamelCase.
struct Name : peg::seq<peg::lower, peg::star<peg::alnum>, peg::not_at<peg::identifier_other>> {};

// uniform vec3 lightColours[LIGHTS];  uniform sampler2D normalMap at 0;
struct UniformType : peg::identifier {};
struct UniformName : Name {};
struct Length : ParameterName {};
struct Array : peg::seq<peg::one<'['>, Blank, Length, Blank, CloseBracket> {};
struct AtWord : Word<'a', 't'> {};
struct Unit : Digits {};
struct AtUnit : peg::seq<AtWord, Blank, Unit> {};
struct Uniform : peg::seq<UniformWord, Blank, UniformType, Blank, UniformName, Blank,
                          peg::opt<Array, Blank>, peg::opt<AtUnit, Blank>, Semicolon, Doc> {};

// input uvec2 packedVertex at 0 from uint32 or uint32[2];
struct InputType : peg::identifier {};
struct InputName : Name {};
struct InputAt : AtWord {};
struct Location : Digits {};
struct FromWord : Word<'f', 'r', 'o', 'm'> {};
struct SourceType : Word<'u', 'i', 'n', 't', '3', '2'> {};
struct SourceCount : Digits {};
struct SourceArray : peg::seq<peg::one<'['>, Blank, SourceCount, Blank, CloseBracket> {};
struct Source : peg::seq<SourceType, Blank, peg::opt<SourceArray, Blank>> {};
struct MoreSources : peg::star<Word<'o', 'r'>, Blank, Source> {};
struct Input : peg::seq<InputWord, Blank, InputType, Blank, InputName, Blank, InputAt, Blank,
                        Location, Blank, FromWord, Blank, Source, MoreSources, Semicolon, Doc> {};

// pass solid { depth greater; cull none; polygon fill; }
struct PassName : Name {};
struct StateName : peg::identifier {};
struct StateValue : peg::identifier {};
struct Setting : peg::seq<StateName, Blank, StateValue, Blank, Semicolon, Blank> {};
struct Pass : peg::seq<PassWord, Blank, PassName, Blank, OpenBrace, Blank, peg::star<Setting>,
                       CloseBrace, Doc> {};

/// GLSL up to the brace that closes the stage, which it leaves. Braces in comments do not count.
struct Body {
    using rule_t = Body;
    using subs_t = peg::empty_list;

    template <typename ParseInput>
    static bool match(ParseInput& in) {
        int depth = 0;
        for (std::size_t at = 0; in.size(at + 1) > at; ++at) {
            at = endOfComment(in, at);
            const char byte = in.peek_char(at);
            if (byte == '{' && ++depth > kMaxBraceDepth)
                fail(in, at, "braces nest too deep: at most 64 may be open");
            else if (byte == '}' && depth-- == 0) {
                in.bump(at);
                return true;
            }
        }
        fail(in, 0, "the stage that begins here has no '}' that ends it");
    }
};

// stage vertex { GLSL }  stage compute { GLSL }
struct VertexWord : Word<'v', 'e', 'r', 't', 'e', 'x'> {};
struct FragmentWord : Word<'f', 'r', 'a', 'g', 'm', 'e', 'n', 't'> {};
struct SharedWord : Word<'s', 'h', 'a', 'r', 'e', 'd'> {};
struct ComputeWord : Word<'c', 'o', 'm', 'p', 'u', 't', 'e'> {};
struct StageKind : peg::sor<VertexWord, FragmentWord, SharedWord, ComputeWord> {};
struct Stage : peg::seq<StageWord, Blank, StageKind, Blank, OpenBrace, Body, CloseBrace> {};

struct Statement : peg::sor<Include, Variant, Uniform, Input, Pass, Stage> {};
struct End : peg::eof {};
struct File : peg::seq<Blank, peg::star<Statement, Blank>, End> {};

/// Messages of the rules that end the parse where they fail.
struct Expected {
    template <typename Rule>
    static constexpr const char* message = nullptr;
};
template <>
inline constexpr const char* Expected::message<Semicolon> = "expected ';'";
template <>
inline constexpr const char* Expected::message<OpenBrace> = "expected '{'";
template <>
inline constexpr const char* Expected::message<CloseBrace> =
    "expected a setting such as 'depth greater;', or '}'";
template <>
inline constexpr const char* Expected::message<CloseBracket> = "expected ']'";
template <>
inline constexpr const char* Expected::message<DotDot> = "expected '..' between two numbers";
template <>
inline constexpr const char* Expected::message<QuotedFile> =
    "expected a block's name in quotes, such as \"object.block\"";
template <>
inline constexpr const char* Expected::message<ParameterKind> = "expected 'int' or 'bool'";
template <>
inline constexpr const char* Expected::message<ParameterName> =
    "expected the parameter's name in capitals";
template <>
inline constexpr const char* Expected::message<Low> = "expected a number of at most 6 digits";
template <>
inline constexpr const char* Expected::message<High> = "expected a number of at most 6 digits";
template <>
inline constexpr const char* Expected::message<UniformType> = "expected a GLSL type";
template <>
inline constexpr const char* Expected::message<UniformName> =
    "expected the uniform's name in lowerCamelCase";
template <>
inline constexpr const char* Expected::message<Length> =
    "expected the variant parameter, in capitals, that is the array's length";
template <>
inline constexpr const char* Expected::message<Unit> = "expected a texture unit's number";
template <>
inline constexpr const char* Expected::message<InputType> = "expected a GLSL type";
template <>
inline constexpr const char* Expected::message<InputName> =
    "expected the input's name in lowerCamelCase";
template <>
inline constexpr const char* Expected::message<InputAt> = "expected 'at' and a location";
template <>
inline constexpr const char* Expected::message<Location> = "expected a location's number";
template <>
inline constexpr const char* Expected::message<FromWord> = "expected 'from' and a source format";
template <>
inline constexpr const char* Expected::message<SourceType> =
    "expected a source format, uint32 or uint32[N]";
template <>
inline constexpr const char* Expected::message<SourceCount> = "expected a number of words";
template <>
inline constexpr const char* Expected::message<PassName> =
    "expected the pass's name in lowerCamelCase";
template <>
inline constexpr const char* Expected::message<StateValue> = "expected the state's value";
template <>
inline constexpr const char* Expected::message<StageKind> =
    "expected 'vertex', 'fragment', 'shared' or 'compute'";
template <>
inline constexpr const char* Expected::message<End> =
    "expected include, variant, uniform, input, pass or stage";

}  // namespace eyrie::effects::rules
