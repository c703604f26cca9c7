// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kBlank = " \t\r\v\f";
constexpr std::string_view kExportAgain = "export the mesh again as PLY";

struct TypeName {
    std::string_view name;
    PlyType type;
};
constexpr std::array<TypeName, 16> kTypeNames = {{
    {"char", PlyType::Int8},
    {"int8", PlyType::Int8},
    {"uchar", PlyType::UInt8},
    {"uint8", PlyType::UInt8},
    {"short", PlyType::Int16},
    {"int16", PlyType::Int16},
    {"ushort", PlyType::UInt16},
    {"uint16", PlyType::UInt16},
    {"int", PlyType::Int32},
    {"int32", PlyType::Int32},
    {"uint", PlyType::UInt32},
    {"uint32", PlyType::UInt32},
    {"float", PlyType::Float32},
    {"float32", PlyType::Float32},
    {"double", PlyType::Float64},
    {"float64", PlyType::Float64},
}};

/// What follows the words `comment TextureFile`, blanks within included; nothing if it is not so.
std::string_view textureFileOf(std::string_view line) {
    for (const std::string_view word : {"comment", "TextureFile"}) {
        line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
        if (!line.starts_with(word) || line.find_first_of(kBlank) != word.size())
            return {};
        line.remove_prefix(word.size());
    }
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    return line.substr(0, line.find_last_not_of(kBlank) + 1);
}

/// Text of a file for a message: short, and without bytes that a terminal would act on.
std::string quoted(std::string_view text) {
    std::string result = "'";
    for (const char c : text.substr(0, 60)) result += c >= ' ' && c <= '~' ? c : '?';
    return result + (text.size() > 60 ? "...'" : "'");
}

std::vector<std::string_view> words(std::string_view line) {
    std::vector<std::string_view> result;
    for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
        result.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(kBlank, end);
    }
    return result;
}

class Parser {
public:
    explicit Parser(std::string_view file) : file_(file) {}

    absl::StatusOr<PlyHeader> parse();

private:
    absl::Status checkMagic();
    bool nextLine(std::string_view& line);
    absl::Status parseLine(std::string_view line);
    absl::Status parseFormat(const std::vector<std::string_view>& line);
    absl::Status parseElement(const std::vector<std::string_view>& line);
    absl::Status parseProperty(const std::vector<std::string_view>& line);
    absl::StatusOr<PlyType> parseType(std::string_view word, bool mustBeInteger) const;
    absl::Status wrong(std::string_view field, std::string_view found,
                       std::string_view expected) const;

    std::string_view file_;
    std::size_t at_ = 0;
    std::size_t line_ = 0;
    char separator_ = '\n';
    bool hasFormat_ = false;
    PlyHeader header_;
};

absl::Status Parser::wrong(std::string_view field, std::string_view found,
                           std::string_view expected) const {
    return absl::InvalidArgumentError(fmt::format("header line {}, {}: found {}, expected {}; {}",
                                                  line_, field, quoted(found), expected,
                                                  kExportAgain));
}

absl::Status Parser::checkMagic() {
    if (file_.empty())
        return absl::InvalidArgumentError(
            fmt::format("the file is empty, expected a PLY header; {}", kExportAgain));
    if (file_.starts_with("\x1f\x8b") || file_.starts_with("\x28\xb5\x2f\xfd"))
        return absl::InvalidArgumentError(
            "the file is compressed, expected plain PLY; decompress it first (gunzip, zstd -d)");
    const std::size_t end = file_.find_first_of("\r\n");
    if (end != std::string_view::npos && file_[end] == '\r' &&
        (end + 1 == file_.size() || file_[end + 1] != '\n'))
        separator_ = '\r';  // classic Mac OS
    return absl::OkStatus();
}

bool Parser::nextLine(std::string_view& line) {
    const std::size_t end = file_.find(separator_, at_);
    if (end == std::string_view::npos)
        return false;
    line = file_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    return true;
}

absl::Status Parser::parseFormat(const std::vector<std::string_view>& line) {
    static constexpr std::array<std::pair<std::string_view, PlyEncoding>, 3> kEncodings = {{
        {"ascii", PlyEncoding::Ascii},
        {"binary_little_endian", PlyEncoding::LittleEndian},
        {"binary_big_endian", PlyEncoding::BigEndian},
    }};
    for (const auto& [name, encoding] : kEncodings) {
        if (line.size() == 3 && line[1] == name && line[2] == "1.0") {
            header_.encoding = encoding;
            hasFormat_ = true;
            return absl::OkStatus();
        }
    }
    return wrong("format", line.size() > 1 ? line[1] : "",
                 "ascii, binary_little_endian or binary_big_endian, and version 1.0");
}

absl::Status Parser::parseElement(const std::vector<std::string_view>& line) {
    PlyElement element;
    if (line.size() != 3)
        return wrong("element", line.size() > 1 ? line[1] : "", "a name and a count");
    element.name = line[1];
    const char* end = line[2].data() + line[2].size();
    const auto parsed = std::from_chars(line[2].data(), end, element.count);
    if (parsed.ec != std::errc() || parsed.ptr != end)
        return wrong(fmt::format("count of element {}", quoted(line[1])), line[2],
                     "a whole number, not negative");
    header_.elements.push_back(std::move(element));
    return absl::OkStatus();
}

absl::StatusOr<PlyType> Parser::parseType(std::string_view word, bool mustBeInteger) const {
    const auto found = std::find_if(kTypeNames.begin(), kTypeNames.end(),
                                    [word](const TypeName& entry) { return entry.name == word; });
    if (found == kTypeNames.end())
        return wrong("property type", word, "one of char uchar short ushort int uint float double");
    if (mustBeInteger && !isInteger(found->type))
        return wrong("list count type", word, "an integer type");
    return found->type;
}

absl::Status Parser::parseProperty(const std::vector<std::string_view>& line) {
    if (header_.elements.empty())
        return wrong("property", line.size() > 1 ? line.back() : "", "an element line before it");
    const bool isList = line.size() > 1 && line[1] == "list";
    if (line.size() != (isList ? 5U : 3U))
        return wrong("property", line.size() > 1 ? line[1] : "",
                     "a type and a name, or list, two types and a name");
    PlyProperty property;
    property.name = line.back();
    ASSIGN_OR_RETURN(property.type, parseType(line[line.size() - 2], false));
    if (isList) {
        ASSIGN_OR_RETURN(property.countType, parseType(line[2], true));
    }
    header_.elements.back().properties.push_back(std::move(property));
    return absl::OkStatus();
}

absl::Status Parser::parseLine(std::string_view text) {
    const std::vector<std::string_view> line = words(text);
    if (const std::string_view name = textureFileOf(text); !name.empty())
        header_.textureFiles.emplace_back(name);
    if (line.empty() || line[0] == "comment" || line[0] == "obj_info")
        return absl::OkStatus();
    if (line[0] == "format")
        return parseFormat(line);
    if (line[0] == "element")
        return parseElement(line);
    if (line[0] == "property")
        return parseProperty(line);
    return wrong("keyword", line[0], "format, element, property, comment, obj_info or end_header");
}

absl::StatusOr<PlyHeader> Parser::parse() {
    RETURN_IF_ERROR(checkMagic());
    std::string_view line;
    if (!nextLine(line) || words(line) != std::vector<std::string_view>{"ply"})
        return absl::InvalidArgumentError(
            fmt::format("first line: found {}, expected 'ply'; this is no PLY file: {}",
                        quoted(line.empty() ? file_ : line), kExportAgain));
    while (true) {
        if (!nextLine(line))
            return absl::InvalidArgumentError(fmt::format(
                "the header ends after line {} without end_header; the file is truncated: copy it "
                "again",
                line_));
        if (words(line) == std::vector<std::string_view>{"end_header"})
            break;
        RETURN_IF_ERROR(parseLine(line));
    }
    if (!hasFormat_)
        return absl::InvalidArgumentError(
            fmt::format("the header has no format line, expected ascii, binary_little_endian or "
                        "binary_big_endian; {}",
                        kExportAgain));
    header_.bodyOffset = at_;
    header_.lines = line_;
    return std::move(header_);
}

absl::Status checkCounts(const PlyHeader& header, std::uint64_t bodyBytes) {
    // The last value of a text needs no separator.
    std::uint64_t left = bodyBytes + (header.encoding == PlyEncoding::Ascii ? 1 : 0);
    for (const PlyElement& element : header.elements) {
        const std::uint64_t least = leastBytes(element, header.encoding);
        if (least != 0 && element.count > left / least)
            return absl::InvalidArgumentError(fmt::format(
                "header, count of element {}: found {}, which at {} bytes or more each need at "
                "least {:.0f} bytes, expected at most the {} that are left in the file; the file "
                "is truncated or its header is wrong: copy or export it again",
                quoted(element.name), element.count, least,
                static_cast<double>(element.count) * static_cast<double>(least), left));
        left -= element.count * least;
    }
    return absl::OkStatus();
}

}  // namespace

std::uint64_t leastBytes(const PlyElement& element, PlyEncoding encoding) {
    if (encoding == PlyEncoding::Ascii)
        return 2 * element.properties.size();
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties)
        bytes += sizeBytes(property.countType.value_or(property.type));
    return bytes;
}

std::size_t sizeBytes(PlyType type) {
    switch (type) {
        case PlyType::Int8:
        case PlyType::UInt8:
            return 1;
        case PlyType::Int16:
        case PlyType::UInt16:
            return 2;
        case PlyType::Int32:
        case PlyType::UInt32:
        case PlyType::Float32:
            return 4;
        case PlyType::Float64:
            return 8;
    }
    return 0;
}

bool isInteger(PlyType type) { return type != PlyType::Float32 && type != PlyType::Float64; }

const PlyProperty* PlyElement::find(std::string_view propertyName) const {
    const auto found =
        std::find_if(properties.begin(), properties.end(),
                     [propertyName](const PlyProperty& p) { return p.name == propertyName; });
    return found == properties.end() ? nullptr : &*found;
}

const PlyElement* PlyHeader::find(std::string_view elementName) const {
    const auto found = std::find_if(elements.begin(), elements.end(),
                                    [elementName](const auto& e) { return e.name == elementName; });
    return found == elements.end() ? nullptr : &*found;
}

absl::StatusOr<PlyHeader> parsePlyHeader(std::string_view file) {
    ASSIGN_OR_RETURN(PlyHeader header, Parser(file).parse());
    RETURN_IF_ERROR(checkCounts(header, file.size() - header.bodyOffset));
    return header;
}

}  // namespace eyrie::import
