// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/effect_grammar.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "renderer/effects/language/effect_rules.h"

namespace eyrie::effects {
namespace {

/// What the actions below fill. Words of a statement are kept until it ends, then it is added.
struct Draft {
    EffectFile file;
    Parameter parameter;
    Uniform uniform;
    Input input;
    Pass pass;
    Stage stage;
    std::string doc;
    std::string stateName;
};

template <typename In>
Place placeOf(const In& in) {
    const auto position = in.position();
    return {position.source, position.line, position.column};
}

/// Of a Digits rule, so that it fits.
template <typename In>
int number(const In& in) {
    int value = 0;
    std::from_chars(in.begin(), in.end(), value);
    return value;
}

template <typename Rule>
struct Action : tao::pegtl::nothing<Rule> {};

/// Actions whose whole work is one assignment from the matched text.
#define EYRIE_SET(RULE, TARGET, VALUE)                  \
    template <>                                         \
    struct Action<rules::RULE> {                        \
        template <typename In>                          \
        static void apply(const In& in, Draft& draft) { \
            draft.TARGET = VALUE;                       \
        }                                               \
    };
EYRIE_SET(DocText, doc, in.string())
EYRIE_SET(ParameterName, parameter.name, in.string())
EYRIE_SET(BoolWord, parameter.isBool, in.size() > 0)
EYRIE_SET(Low, parameter.low, number(in))
EYRIE_SET(High, parameter.high, number(in))
EYRIE_SET(UniformType, uniform.type, in.string())
EYRIE_SET(UniformName, uniform.name, in.string())
EYRIE_SET(Length, uniform.length, in.string())
EYRIE_SET(Unit, uniform.unit, number(in))
EYRIE_SET(InputType, input.type, in.string())
EYRIE_SET(InputName, input.name, in.string())
EYRIE_SET(Location, input.location, number(in))
EYRIE_SET(SourceCount, input.sources.back(), number(in))
EYRIE_SET(PassName, pass.name, in.string())
EYRIE_SET(StateName, stateName, in.string())
#undef EYRIE_SET

#define EYRIE_STAGE(KIND)                                                        \
    template <>                                                                  \
    struct Action<rules::KIND##Word> {                                           \
        static void apply0(Draft& draft) { draft.stage.kind = StageKind::KIND; } \
    };
EYRIE_STAGE(Vertex)
EYRIE_STAGE(Fragment)
EYRIE_STAGE(Shared)
EYRIE_STAGE(Compute)
#undef EYRIE_STAGE

template <>
struct Action<rules::SourceType> {
    static void apply0(Draft& draft) { draft.input.sources.push_back(1); }
};

template <>
struct Action<rules::FileName> {
    template <typename In>
    static void apply(const In& in, Draft& draft) {
        draft.file.includes.push_back({in.string(), placeOf(in)});
    }
};

template <>
struct Action<rules::StateValue> {
    template <typename In>
    static void apply(const In& in, Draft& draft) {
        Pass& pass = draft.pass;
        std::string* state = draft.stateName == "depth"     ? &pass.depth
                             : draft.stateName == "cull"    ? &pass.cull
                             : draft.stateName == "polygon" ? &pass.polygon
                                                            : nullptr;
        if (state == nullptr)
            throw tao::pegtl::parse_error(
                fmt::format("a pass sets depth, cull and polygon, not '{}'", draft.stateName), in);
        if (!state->empty())
            throw tao::pegtl::parse_error(
                fmt::format("{} is set a second time in this pass", draft.stateName), in);
        *state = in.string();
    }
};

template <>
struct Action<rules::Body> {
    template <typename In>
    static void apply(const In& in, Draft& draft) {
        draft.stage.body = in.string();
        draft.stage.bodyPlace = placeOf(in);
    }
};

/// Adds the statement that has ended to `list`, and makes room for the next.
template <typename Statement, typename In>
void add(std::vector<Statement>& list, Statement& statement, const In& in) {
    statement.place = placeOf(in);
    list.push_back(std::exchange(statement, {}));
}

template <typename Statement, typename In>
void addDocumented(std::vector<Statement>& list, Statement& statement, const In& in, Draft& draft) {
    std::string comment = std::exchange(draft.doc, {});
    // A backslash that ends a line would make C++ take the next line as comment, too.
    comment.erase(std::min(comment.find_last_not_of(" \t\r\\") + 1, comment.size()));
    statement.comment = std::move(comment);
    add(list, statement, in);
}

#define EYRIE_ADD(RULE, LIST, STATEMENT)                                \
    template <>                                                         \
    struct Action<rules::RULE> {                                        \
        template <typename In>                                          \
        static void apply(const In& in, Draft& draft) {                 \
            addDocumented(draft.file.LIST, draft.STATEMENT, in, draft); \
        }                                                               \
    };
EYRIE_ADD(Variant, parameters, parameter)
EYRIE_ADD(Uniform, uniforms, uniform)
EYRIE_ADD(Input, inputs, input)
EYRIE_ADD(Pass, passes, pass)
#undef EYRIE_ADD

template <>
struct Action<rules::Stage> {
    template <typename In>
    static void apply(const In& in, Draft& draft) {
        add(draft.file.stages, draft.stage, in);
    }
};

template <typename Rule>
using Control = tao::pegtl::must_if<rules::Expected, tao::pegtl::normal, false>::control<Rule>;

bool isWord(char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

/// How far into a word or number `offset` is: rules fail where a word stops being what they want.
std::size_t bytesIntoWord(std::string_view text, std::size_t offset) {
    std::size_t begin = offset;
    if (offset < text.size() && isWord(text[offset]))
        while (begin > 0 && isWord(text[begin - 1])) --begin;
    return offset - begin;
}

/// What stands at `offset`, for messages: a word or number, one other character, or the end.
std::string foundAt(std::string_view text, std::size_t offset) {
    constexpr std::size_t kLongest = 40;
    if (offset >= text.size())
        return "the end of the file";
    const std::string_view rest = text.substr(offset, kLongest);
    const auto end = std::find_if_not(rest.begin(), rest.end(), isWord);
    if (end != rest.begin())
        return fmt::format("'{}'", std::string_view(rest.begin(), end));
    const auto byte = static_cast<unsigned char>(rest[0]);
    return byte > 0x20 && byte < 0x7F ? fmt::format("'{}'", rest[0])
                                      : fmt::format("byte 0x{:02x}", byte);
}

/// Text only: a NUL would end the text early for GL, and other control bytes are never meant.
absl::Status checkBytes(std::string_view text, std::string_view name) {
    if (text.size() > kMaxEffectBytes)
        return absl::InvalidArgumentError(fmt::format(
            "{}: has {} bytes; an effect file has at most {}", name, text.size(), kMaxEffectBytes));
    const auto bad = std::find_if(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\n' && c != '\t' && c != '\r') || byte == 0x7F;
    });
    if (bad == text.end())
        return absl::OkStatus();
    const auto before = std::string_view(text.begin(), bad);
    const auto lines = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
    const Place place{std::string(name), lines + 1, before.size() - (before.rfind('\n') + 1) + 1};
    return absl::InvalidArgumentError(messageAt(
        place, fmt::format("byte 0x{:02x} is not text", static_cast<unsigned char>(*bad))));
}

}  // namespace

std::string messageAt(const Place& place, std::string_view message) {
    return fmt::format("{}:{}:{}: {}", place.file, place.line, place.column, message);
}

absl::StatusOr<EffectFile> parseEffectFile(std::string_view text, std::string_view name) {
    if (absl::Status status = checkBytes(text, name); !status.ok())
        return status;
    Draft draft;
    draft.file.name = name;
    tao::pegtl::memory_input in(text.data(), text.size(), std::string(name));
    try {
        tao::pegtl::parse<rules::File, Action, Control>(in, draft);
    } catch (const tao::pegtl::parse_error& error) {
        const auto& position = error.positions().front();
        Place place{position.source, position.line, position.column};
        std::string message(error.message());
        if (message.starts_with("expected")) {
            const std::size_t into = bytesIntoWord(text, position.byte);
            place.column -= into;
            message += fmt::format(", found {}", foundAt(text, position.byte - into));
        }
        return absl::InvalidArgumentError(messageAt(place, message));
    }
    return std::move(draft.file);
}

}  // namespace eyrie::effects
