// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/attribute_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <span>

#include <fmt/format.h>

#include "coordinator/config/eqc_writer.h"

namespace eyrie::config {
namespace {

using Scope = AttributeScope;

enum class Type { Setting, Real, Text, Character, Mask };

struct Known {
    Scope scope;
    std::string_view name;
    Type type;
    bool isOnScreen = false;  ///< without effect where there is no screen
};

/// Those of Equalizer's Programming Guide, with the deprecated names that files still have.
constexpr std::array kKnown{
    Known{Scope::Config, "eye_base", Type::Real},
    Known{Scope::Config, "robustness", Type::Setting},
    Known{Scope::Node, "launch_command", Type::Text, true},
    Known{Scope::Node, "launch_command_quote", Type::Character, true},
    Known{Scope::Node, "launch_timeout", Type::Setting, true},
    Known{Scope::Node, "thread_model", Type::Setting},
    Known{Scope::Node, "hint_affinity", Type::Setting, true},
    Known{Scope::Node, "hint_statistics", Type::Setting},
    Known{Scope::Pipe, "hint_thread", Type::Setting},
    Known{Scope::Pipe, "hint_affinity", Type::Setting, true},
    Known{Scope::Pipe, "hint_cuda_gl_interop", Type::Setting, true},
    Known{Scope::View, "deflect_host", Type::Text, true},
    Known{Scope::View, "displaycluster", Type::Text, true},  // its name before
    Known{Scope::Window, "hint_core_profile", Type::Setting},
    Known{Scope::Window, "hint_opengl_major", Type::Setting},
    Known{Scope::Window, "hint_opengl_minor", Type::Setting},
    Known{Scope::Window, "hint_stereo", Type::Setting},
    Known{Scope::Window, "hint_doublebuffer", Type::Setting, true},
    Known{Scope::Window, "hint_decoration", Type::Setting, true},
    Known{Scope::Window, "hint_fullscreen", Type::Setting, true},
    Known{Scope::Window, "hint_swapsync", Type::Setting, true},
    Known{Scope::Window, "hint_drawable", Type::Setting},
    Known{Scope::Window, "hint_statistics", Type::Setting},
    Known{Scope::Window, "hint_screensaver", Type::Setting, true},
    Known{Scope::Window, "hint_grab_pointer", Type::Setting, true},
    Known{Scope::Window, "hint_width", Type::Setting},
    Known{Scope::Window, "hint_height", Type::Setting},
    Known{Scope::Window, "planes_color", Type::Setting},
    Known{Scope::Window, "planes_alpha", Type::Setting},
    Known{Scope::Window, "planes_depth", Type::Setting},
    Known{Scope::Window, "planes_stencil", Type::Setting},
    Known{Scope::Window, "planes_accum", Type::Setting, true},
    Known{Scope::Window, "planes_accum_alpha", Type::Setting, true},
    Known{Scope::Window, "planes_samples", Type::Setting},
    Known{Scope::Channel, "hint_statistics", Type::Setting},
    Known{Scope::Channel, "hint_sendtoken", Type::Setting},
    Known{Scope::Channel, "dump_image", Type::Text},
    Known{Scope::Compound, "stereo_mode", Type::Setting},
    Known{Scope::Compound, "stereo_anaglyph_left_mask", Type::Mask},
    Known{Scope::Compound, "stereo_anaglyph_right_mask", Type::Mask},
    Known{Scope::Compound, "update_fov", Type::Setting, true},
    Known{Scope::Compound, "hint_offset", Type::Setting, true},
    Known{Scope::Connection, "hostname", Type::Text},
    Known{Scope::Connection, "type", Type::Setting},
    Known{Scope::Connection, "port", Type::Setting},
    Known{Scope::Connection, "filename", Type::Text},
    Known{Scope::Connection, "bandwidth", Type::Setting},
    Known{Scope::Connection, "tcpip_port", Type::Setting},
    Known{Scope::Connection, "pipe_filename", Type::Text},
    Known{Scope::Connection, "launch_command", Type::Text, true},
    Known{Scope::Connection, "launch_command_quote", Type::Character, true},
    Known{Scope::Connection, "launch_timeout", Type::Setting, true},
    Known{Scope::SwapBarrier, "nv_group", Type::Setting, true},
    Known{Scope::SwapBarrier, "nv_barrier", Type::Setting, true},
};

constexpr std::array<std::string_view, 8> kScopeNames{
    "CONFIG", "NODE", "PIPE", "VIEW", "WINDOW", "CHANNEL", "COMPOUND", "CONNECTION"};

constexpr std::array<std::string_view, 31> kSettings{
    "async", "draw_sync", "local_sync", "ON",       "OFF",        "AUTO",   "FASTEST", "NICEST",
    "QUAD",  "ANAGLYPH",  "PASSIVE",    "VERTICAL", "HORIZONTAL", "window", "pbuffer", "FBO",
    "ASYNC", "DRAW_SYNC", "LOCAL_SYNC", "RGBA16F",  "RGBA32F",    "EXTERN", "CORE",    "SOCKET",
    "TCPIP", "PIPE",      "RSP",        "RDMA",     "UDT",        "SDP",    "MCIP_RSP"};

std::string lowered(std::string_view text) {
    std::string result(text);
    for (char& each : result)
        each = static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
    return result;
}

const Known* knownOf(Scope scope, std::string_view name) {
    const auto known = std::ranges::find_if(kKnown, [&](const Known& each) {
        return each.scope == scope && each.name == lowered(name);
    });
    return known == kKnown.end() ? nullptr : &*known;
}

/// ON, 24, CORE 1, …
bool readSetting(const Statement& statement, ValueReader& reader, Attribute& attribute) {
    const std::vector<Scalar>& values = statement.values;
    const bool isPlain = statement.form == Statement::Form::Plain;
    if (isPlain && values.size() == 1 && values[0].kind == Scalar::Kind::Integer &&
        values[0].isNumber()) {
        attribute.value = static_cast<std::int64_t>(std::clamp(values[0].number, -1e15, 1e15));
        return true;
    }
    const bool isWord = isPlain && !values.empty() && values.size() <= 2 &&
                        values[0].kind == Scalar::Kind::Word &&
                        std::ranges::find(kSettings, values[0].text) != kSettings.end();
    if (!isWord || (values.size() == 2 && values[1].kind != Scalar::Kind::Integer)) {
        reader.expected(statement, "a whole number or a word such as ON, OFF, AUTO or FBO");
        return false;
    }
    Attribute::Words words;
    for (const Scalar& value : values) words.words.push_back(value.text);
    attribute.value = std::move(words);
    return true;
}

bool readMask(const Statement& statement, ValueReader& reader, Attribute& attribute) {
    ColourMask mask;
    const std::size_t errors = reader.findings().errors();
    reader.flags(statement, {{"RED", &mask.red}, {"GREEN", &mask.green}, {"BLUE", &mask.blue}});
    if (reader.findings().errors() > errors)
        return false;
    Attribute::Words words;
    for (const Scalar& value : statement.values) words.words.push_back(value.text);
    attribute.value = std::move(words);
    return true;
}

bool readText(const Statement& statement, ValueReader& reader, Attribute& attribute) {
    std::string text;
    const std::size_t errors = reader.findings().errors();
    reader.text(statement, text);
    attribute.value = std::move(text);
    return reader.findings().errors() == errors;
}

bool readCharacter(const Statement& statement, ValueReader& reader, Attribute& attribute) {
    const Scalar* const value = ValueReader::single(statement);
    const bool isOne = value != nullptr && value->kind == Scalar::Kind::Character &&
                       value->text.size() == 1 && value->text[0] >= ' ' && value->text[0] <= '~';
    if (!isOne) {
        reader.expected(statement, "one character of ASCII in single quotes");
        return false;
    }
    attribute.value = value->text;
    return true;
}

bool readReal(const Statement& statement, ValueReader& reader, Attribute& attribute) {
    double number = 0;
    const std::size_t errors = reader.findings().errors();
    reader.number(statement, number);
    attribute.value = number;
    return reader.findings().errors() == errors;
}

bool readValue(const Statement& statement, Type type, ValueReader& reader, Attribute& attribute) {
    switch (type) {
        case Type::Setting:
            return readSetting(statement, reader, attribute);
        case Type::Real:
            return readReal(statement, reader, attribute);
        case Type::Text:
            return readText(statement, reader, attribute);
        case Type::Character:
            return readCharacter(statement, reader, attribute);
        case Type::Mask:
            break;
    }
    return readMask(statement, reader, attribute);
}

bool isCharacter(std::string_view name) {
    return std::ranges::any_of(kKnown, [name = lowered(name)](const Known& known) {
        return known.type == Type::Character && name.ends_with(known.name);
    });
}

/// Masks may be empty, and no setting's words are colours.
bool isMask(const std::vector<std::string>& words) {
    return words.empty() || words[0] == "RED" || words[0] == "GREEN" || words[0] == "BLUE";
}

/// Of CORE 1 the second is a number, as only words after the first are.
Scalar laterWord(const std::string& text) {
    double number = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool isNumber = end.ec == std::errc() && end.ptr == text.data() + text.size();
    return {isNumber ? Scalar::Kind::Integer : Scalar::Kind::Word, text, number};
}

void read(const Statement& statement, const Known& known, ValueReader& reader,
          Attributes& attributes) {
    Attribute attribute{statement.keyword, {}, statement.place};
    if (!readValue(statement, known.type, reader, attribute))
        return;
    if (known.isOnScreen)
        reader.findings().onScreen(
            statement.place,
            fmt::format("'{}' has no effect {}", statement.keyword,
                        known.name.starts_with("launch_") ? "where renderers are services"
                                                          : "without a screen"));
    const auto before = std::ranges::find(attributes, attribute.name, &Attribute::name);
    if (before == attributes.end())
        attributes.push_back(std::move(attribute));
    else
        *before = std::move(attribute);
}

}  // namespace

Statement statementOf(const Attribute& attribute) {
    if (const auto* number = std::get_if<std::int64_t>(&attribute.value))
        return plain(attribute.name, numberScalar(static_cast<double>(*number)));
    if (const auto* number = std::get_if<double>(&attribute.value))
        return plain(attribute.name, numberScalar(*number));
    if (const auto* text = std::get_if<std::string>(&attribute.value))
        return plain(
            attribute.name,
            {isCharacter(attribute.name) ? Scalar::Kind::Character : Scalar::Kind::Text, *text});
    Statement statement{attribute.name};
    const std::vector<std::string>& words = std::get<Attribute::Words>(attribute.value).words;
    for (const std::string& word : words)
        statement.values.push_back(statement.values.empty() ? Scalar{Scalar::Kind::Word, word}
                                                            : laterWord(word));
    statement.form = isMask(words) ? Statement::Form::List : Statement::Form::Plain;
    return statement;
}

const Attribute* find(const Attributes& attributes, std::string_view name) {
    const auto found = std::ranges::find(attributes, name, &Attribute::name);
    return found == attributes.end() ? nullptr : &*found;
}

void readAttribute(const Statement& statement, Scope scope, ValueReader& reader,
                   Attributes& attributes) {
    if (const Known* const known = knownOf(scope, statement.keyword))
        read(statement, *known, reader, attributes);
    else
        reader.findings().warning(
            statement.place,
            fmt::format("'{}' is no setting here and is left out", statement.keyword));
}

void readAttributes(const Statement& block, Scope scope, ValueReader& reader,
                    Attributes& attributes) {
    if (block.form != Statement::Form::Block)
        return reader.expected(block, "a block { }");
    for (const Statement& statement : block.statements)
        readAttribute(statement, scope, reader, attributes);
}

void readGlobal(const Statement& statement, ValueReader& reader, Attributes& globals) {
    for (std::size_t i = 0; i < kScopeNames.size(); ++i)
        for (const std::string_view kind : {"IATTR", "SATTR", "FATTR", "CATTR"}) {
            const std::string prefix = fmt::format("EQ_{}_{}_", kScopeNames[i], kind);
            if (!statement.keyword.starts_with(prefix))
                continue;
            const Known* const known =
                knownOf(static_cast<Scope>(i), statement.keyword.substr(prefix.size()));
            if (known != nullptr)
                return read(statement, *known, reader, globals);
        }
    reader.findings().warning(
        statement.place,
        fmt::format("'{}' is no global setting and is left out", statement.keyword));
}

}  // namespace eyrie::config
