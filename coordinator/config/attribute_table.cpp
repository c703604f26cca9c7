// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/attribute_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <functional>
#include <span>

#include <fmt/format.h>

#include "coordinator/config/eqc_writer.h"
#include "fabric/near_name.h"

namespace eyrie::config {
namespace {

using Scope = AttributeScope;

enum class Type { Setting, Real, Text, Character, Mask };

struct Known {
    Scope scope;
    std::string_view name;
    Type type;
    Finding::Kind kind = Finding::Kind::Note;  ///< of what is said where it has no effect
    std::string_view why = {};                 ///< it has none; empty: it has one
    /// Values of which nothing is said, besides AUTO, as all is so anyway or they have an effect:
    /// numbers up to this (ON is 1 and OFF 0), and this word.
    std::int64_t upTo = -1;
    std::string_view word = {};
};

constexpr Finding::Kind kOnScreen = Finding::Kind::OnScreen;
constexpr Finding::Kind kNote = Finding::Kind::Note;
constexpr std::string_view kNoScreen = "there is no screen";
constexpr std::string_view kServices = "renderers are services, which are not launched from here";
constexpr std::string_view kReplaced =
    "whatever is set, others draw what a renderer that fails had";
constexpr std::string_view kMeasured = "statistics are always measured";
constexpr std::string_view kCores = "renderers run where the system puts their processes";
constexpr std::string_view kOpenGl = "renderers draw with the core profile of OpenGL 4.5";
constexpr std::string_view kViewport = "a window's size is its viewport's, in pixels";
constexpr std::string_view kEightBits = "pictures have 8 bits of red, green, blue and alpha";
constexpr std::string_view kRemoved = "Equalizer has it no more";

/// Those of Equalizer's Programming Guide, with the deprecated names that files still have.
constexpr std::array kKnown{
    Known{Scope::Config, "eye_base", Type::Real},
    Known{Scope::Config, "robustness", Type::Setting, kNote, kReplaced, -1, "on"},
    Known{Scope::Node, "launch_command", Type::Text, kNote, kServices},
    Known{Scope::Node, "launch_command_quote", Type::Character, kNote, kServices},
    Known{Scope::Node, "launch_timeout", Type::Setting, kNote, kServices},
    Known{Scope::Node, "thread_model", Type::Setting, kNote,
          "as many frames are under way at once as `latency` says, and one", -1, "async"},
    Known{Scope::Node, "hint_affinity", Type::Setting, kNote, kCores, 0},
    Known{Scope::Node, "hint_statistics", Type::Setting, kNote, kMeasured, -1, "on"},
    Known{Scope::Pipe, "hint_thread", Type::Setting, kNote,
          "each pipe is a renderer of its own, in its own process", -1, "on"},
    Known{Scope::Pipe, "hint_affinity", Type::Setting, kNote, kCores, 0},
    Known{Scope::Pipe, "hint_cuda_GL_interop", Type::Setting, kNote, "renderers do not use CUDA",
          0},
    Known{Scope::View, "deflect_host", Type::Text, kOnScreen, kNoScreen},
    Known{Scope::View, "DisplayCluster", Type::Text, kOnScreen, kNoScreen},  // its name before
    Known{Scope::Window, "hint_core_profile", Type::Setting, kNote, kOpenGl, -1, "on"},
    Known{Scope::Window, "hint_opengl_major", Type::Setting, kNote, kOpenGl, 4},
    Known{Scope::Window, "hint_opengl_minor", Type::Setting, kNote, kOpenGl, 5},
    Known{Scope::Window, "hint_stereo", Type::Setting, kNote,
          "ON gives each eye a picture of its own where `stereo_mode` is AUTO; all else counts as "
          "OFF",
          1},
    Known{Scope::Window, "hint_doublebuffer", Type::Setting, kOnScreen, kNoScreen},
    Known{Scope::Window, "hint_decoration", Type::Setting, kOnScreen, kNoScreen},
    Known{Scope::Window, "hint_fullscreen", Type::Setting, kOnScreen, kNoScreen},
    Known{Scope::Window, "hint_swapsync", Type::Setting, kOnScreen, kNoScreen},
    Known{
        Scope::Window, "hint_drawable", Type::Setting, kNote,
        "all is drawn into framebuffer objects; with `hint_stereo` ON, FBO and pbuffer alone make "
        "`stereo_mode` AUTO an anaglyph",
        -1, "fbo"},
    Known{Scope::Window, "hint_statistics", Type::Setting, kNote, kMeasured, -1, "on"},
    Known{Scope::Window, "hint_screensaver", Type::Setting, kOnScreen, kNoScreen},
    Known{Scope::Window, "hint_grab_pointer", Type::Setting, kOnScreen, kNoScreen},
    Known{Scope::Window, "hint_width", Type::Setting, kNote, kViewport},
    Known{Scope::Window, "hint_height", Type::Setting, kNote, kViewport},
    Known{Scope::Window, "planes_color", Type::Setting, kNote, kEightBits, 8},
    Known{Scope::Window, "planes_alpha", Type::Setting, kNote, kEightBits, 8},
    Known{Scope::Window, "planes_depth", Type::Setting, kNote, "depth is a number of 32 bits", 32},
    Known{Scope::Window, "planes_stencil", Type::Setting, kNote, "nothing is drawn by a stencil",
          0},
    Known{Scope::Window, "planes_accum", Type::Setting, kOnScreen, kNoScreen},
    Known{Scope::Window, "planes_accum_alpha", Type::Setting, kOnScreen, kNoScreen},
    Known{Scope::Window, "planes_samples", Type::Setting, kNote,
          "a channel draws one sample a pixel; compounds with `subpixel` draw more", 1},
    Known{Scope::Channel, "hint_statistics", Type::Setting, kNote, kMeasured, -1, "on"},
    Known{Scope::Channel, "hint_sendtoken", Type::Setting, kNote, kUnpaced, 0},
    Known{Scope::Channel, "dump_image", Type::Text, kNote,
          "`eyrie render --config` writes pictures"},
    Known{Scope::Compound, "stereo_mode", Type::Setting},
    Known{Scope::Compound, "stereo_anaglyph_left_mask", Type::Mask},
    Known{Scope::Compound, "stereo_anaglyph_right_mask", Type::Mask},
    Known{Scope::Compound, "update_FOV", Type::Setting, kNote, kRemoved},
    Known{Scope::Compound, "hint_offset", Type::Setting, kNote, kRemoved},
    Known{Scope::Connection, "hostname", Type::Text, kNote, kAddresses},
    Known{Scope::Connection, "type", Type::Setting, kNote, kGrpc, -1, "tcpip"},
    Known{Scope::Connection, "port", Type::Setting, kNote, kAddresses},
    Known{Scope::Connection, "filename", Type::Text, kNote, kAddresses},
    Known{Scope::Connection, "bandwidth", Type::Setting, kNote, kUnpaced},
    Known{Scope::Connection, "tcpip_port", Type::Setting, kNote, kAddresses},
    Known{Scope::Connection, "pipe_filename", Type::Text, kNote, kAddresses},
    Known{Scope::Connection, "launch_command", Type::Text, kNote, kServices},
    Known{Scope::Connection, "launch_command_quote", Type::Character, kNote, kServices},
    Known{Scope::Connection, "launch_timeout", Type::Setting, kNote, kServices},
    Known{Scope::SwapBarrier, "NV_group", Type::Setting, kOnScreen, kNoScreen},
    Known{Scope::SwapBarrier, "NV_barrier", Type::Setting, kOnScreen, kNoScreen},
};

constexpr std::array<std::string_view, 8> kScopeNames{
    "CONFIG", "NODE", "PIPE", "VIEW", "WINDOW", "CHANNEL", "COMPOUND", "CONNECTION"};

constexpr std::array<std::string_view, 32> kSettings{
    "async", "draw_sync", "local_sync", "ON",       "OFF",        "AUTO",   "FASTEST",  "NICEST",
    "QUAD",  "ANAGLYPH",  "PASSIVE",    "VERTICAL", "HORIZONTAL", "window", "pbuffer",  "FBO",
    "ASYNC", "DRAW_SYNC", "LOCAL_SYNC", "RGBA16F",  "RGBA32F",    "EXTERN", "CORE",     "SOCKET",
    "TCPIP", "PIPE",      "RSP",        "RDMA",     "UDT",        "SDP",    "MCIP_RSP", "anaglyph"};

std::string lowered(std::string_view text) {
    std::string result(text);
    for (char& each : result)
        each = static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
    return result;
}

char letterOf(Type type) {
    switch (type) {
        case Type::Real:
            return 'F';
        case Type::Text:
            return 'S';
        case Type::Character:
            return 'C';
        case Type::Setting:
        case Type::Mask:
            break;
    }
    return 'I';
}

/// As in EQ_WINDOW_IATTR_HINT_STEREO; empty where a setting has none.
std::string globalNameOf(const Known& known) {
    const auto scope = static_cast<std::size_t>(known.scope);
    if (scope >= kScopeNames.size())
        return {};
    std::string name(known.name);
    for (char& each : name)
        each = static_cast<char>(std::toupper(static_cast<unsigned char>(each)));
    return fmt::format("EQ_{}_{}ATTR_{}", kScopeNames[scope], letterOf(known.type), name);
}

/// Whether `written` is `name` but for case and, of a global one, the letter of its type.
bool isMisspelt(std::string_view written, std::string_view name) {
    const std::size_t letter = name.find("ATTR_");
    std::string a = lowered(written);
    std::string b = lowered(name);
    if (letter != std::string_view::npos && a.size() == b.size())
        a[letter - 1] = b[letter - 1];
    return a == b;
}

/// The setting whose name, exactly, it is, as Equalizer reads them; others are left out with a
/// warning. `nameOf` those that are not meant is empty.
const Known* knownOf(const Statement& statement, ValueReader& reader, std::string_view kind,
                     const std::function<std::string(const Known&)>& nameOf) {
    std::string meant;
    std::vector<std::string> names;
    for (const Known& each : kKnown) {
        const std::string name = nameOf(each);
        if (name.empty())
            continue;
        names.push_back(name);
        if (name == statement.keyword)
            return &each;
        if (isMisspelt(statement.keyword, name))
            meant = fmt::format("; '{}' is one", name);
    }
    if (meant.empty())
        meant = fabric::didYouMean(statement.keyword, names);
    reader.findings().warning(statement.place, fmt::format("'{}' is no {} and is left out{}",
                                                           statement.keyword, kind, meant));
    return nullptr;
}

/// As Equalizer spells it, whatever the case of its letters; empty for none.
std::string_view settingOf(std::string_view word) {
    const auto exactly = std::ranges::find(kSettings, word);
    const auto found = exactly != kSettings.end()
                           ? exactly
                           : std::ranges::find_if(kSettings, [&](std::string_view each) {
                                 return lowered(each) == lowered(word);
                             });
    return found == kSettings.end() ? std::string_view() : *found;
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
    const bool isWord =
        isPlain && !values.empty() && values.size() <= 2 && values[0].kind == Scalar::Kind::Word;
    const std::string_view word = isWord ? settingOf(values[0].text) : "";
    if (word.empty() || (values.size() == 2 && values[1].kind != Scalar::Kind::Integer)) {
        reader.expected(statement, "a whole number or a word such as ON, OFF, AUTO or FBO");
        return false;
    }
    if (word != values[0].text)
        reader.findings().warning(
            statement.place,
            fmt::format("'{}' is {}, which is read as {}: Equalizer itself knows it "
                        "in that case alone",
                        statement.keyword, values[0].text, word));
    Attribute::Words words;
    for (const Scalar& value : values) words.words.push_back(value.text);
    words.words.front() = word;
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

/// Whether there is nothing to say of the setting's value.
bool isTaken(const Known& known, const Attribute& attribute) {
    if (const auto* number = std::get_if<std::int64_t>(&attribute.value))
        return *number <= known.upTo;
    const auto* const words = std::get_if<Attribute::Words>(&attribute.value);
    if (words == nullptr || words->words.size() != 1)
        return false;
    const std::string word = lowered(words->words.front());
    return word == "auto" || word == known.word || (word == "off" && known.upTo >= 0) ||
           (word == "on" && known.upTo >= 1);
}

void read(const Statement& statement, const Known& known, ValueReader& reader,
          Attributes& attributes) {
    Attribute attribute{statement.keyword, {}, statement.place};
    if (!readValue(statement, known.type, reader, attribute))
        return;
    if (!known.why.empty() && !isTaken(known, attribute))
        reader.hasNoEffect(statement, known.why, known.kind);
    const auto before = std::ranges::find(attributes, attribute.name, &Attribute::name);
    if (before == attributes.end()) {
        attributes.push_back(std::move(attribute));
    } else {
        reader.givenAgain(statement, statement.keyword);
        *before = std::move(attribute);
    }
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
    const auto nameOf = [scope](const Known& each) {
        return each.scope == scope ? std::string(each.name) : std::string();
    };
    if (const Known* const known = knownOf(statement, reader, "setting here", nameOf))
        read(statement, *known, reader, attributes);
}

void readAttributes(const Statement& block, Scope scope, ValueReader& reader,
                    Attributes& attributes) {
    if (block.form != Statement::Form::Block)
        return reader.expected(block, "a block { }");
    for (const Statement& statement : block.statements)
        readAttribute(statement, scope, reader, attributes);
}

void readGlobal(const Statement& statement, ValueReader& reader, Attributes& globals) {
    if (const Known* const known = knownOf(statement, reader, "global setting", globalNameOf))
        read(statement, *known, reader, globals);
}

}  // namespace eyrie::config
