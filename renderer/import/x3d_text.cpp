// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/x3d_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "renderer/import/xml_tag.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kBlank = " \t\r\n,";

/// The first of the quoted strings of an MFString; nothing where the value does not begin with one.
std::string_view firstString(std::string_view value) {
    value.remove_prefix(std::min(value.find_first_not_of(kBlank), value.size()));
    for (const std::string_view quote : {"\"", "&quot;", "&#34;"})
        if (value.starts_with(quote)) {
            value.remove_prefix(quote.size());
            return value.substr(0, value.find(quote));
        }
    return {};
}

std::string imageForAssimp(std::string_view tag) {
    const std::string_view url = xmlAttribute(tag, "url");
    const std::string_view first = firstString(url);
    if (first.empty())
        return std::string(tag);
    std::string name;
    for (const char c : first) name += c == ' ' ? "%20" : std::string(1, c);
    return withValue(tag, url, name);
}

/// The numbers of an attribute, as far as it has them, over those in `numbers`.
template <std::size_t N>
void readNumbers(std::string_view value, std::array<double, N>& numbers) {
    for (double& number : numbers) {
        value.remove_prefix(std::min(value.find_first_not_of(kBlank), value.size()));
        const auto read = std::from_chars(value.data(), value.data() + value.size(), number);
        if (read.ec != std::errc())
            return;
        value.remove_prefix(static_cast<std::size_t>(read.ptr - value.data()));
    }
}

/// What Assimp makes of a transform is scale * rotation * (place + translation - centre), and the
/// format says scale * rotation * (place + translation + centre) - centre.
std::string transformForAssimp(std::string_view tag) {
    const std::string_view value = xmlAttribute(tag, "center");
    std::array<double, 2> centre = {0, 0}, scale = {1, 1};
    std::array<double, 1> angle = {0};
    readNumbers(value, centre);
    readNumbers(xmlAttribute(tag, "scale"), scale);
    readNumbers(xmlAttribute(tag, "rotation"), angle);
    if (value.empty() || scale[0] == 0 || scale[1] == 0)
        return std::string(tag);
    const glm::dmat2 turn(std::cos(angle[0]), std::sin(angle[0]), -std::sin(angle[0]),
                          std::cos(angle[0]));
    const glm::dvec2 scaledBack(centre[0] / scale[0], centre[1] / scale[1]);
    const glm::dvec2 other = glm::transpose(turn) * scaledBack - glm::dvec2(centre[0], centre[1]);
    return withValue(tag, value, fmt::format("{} {}", other.x, other.y));
}

/// Of strips of so many vertices each, which follow each other, out of those that are left; empty
/// where fewer are.
std::string indicesOfStrips(std::string_view counts, std::uint64_t& verticesLeft) {
    std::string indices;
    std::uint64_t first = 0;
    while (true) {
        counts.remove_prefix(std::min(counts.find_first_not_of(kBlank), counts.size()));
        std::uint64_t count = 0;
        const auto read = std::from_chars(counts.data(), counts.data() + counts.size(), count);
        if (read.ec != std::errc())
            return indices;
        counts.remove_prefix(static_cast<std::size_t>(read.ptr - counts.data()));
        if (count > verticesLeft)
            return {};
        verticesLeft -= count;
        for (std::uint64_t i = first; i < first + count; ++i) indices += fmt::format("{} ", i);
        indices += "-1 ";
        first += count;
    }
}

/// What mending a tag may ask of the file.
struct Source {
    std::string_view x3d;
    bool hasMaterials;
    std::uint64_t verticesLeft;  ///< for strips: a file has no more vertices than bytes
    std::size_t shapeEnd = 0;    ///< the last found; nobody looks before it again
    std::size_t appearance = 0;  ///< the same
};

/// Where `what` is next, from `from` on, which is never less than before; `found` keeps it.
std::size_t next(std::string_view x3d, std::string_view what, std::size_t from,
                 std::size_t& found) {
    if (found < from)
        found = x3d.find(what, from);
    return found;
}

std::string stripsForAssimp(std::string_view tag, Source& source) {
    const std::string indices =
        indicesOfStrips(xmlAttribute(tag, "stripCount"), source.verticesLeft);
    return fmt::format("<IndexedTriangleStripSet index='{}'{}", indices,
                       tag.substr(std::string_view("<TriangleStripSet").size()));
}

/// Indices with those of each face, which ends with -1, the other way around.
std::string turned(std::string_view indices) {
    std::string result;
    std::vector<std::string_view> face;
    while (true) {
        indices.remove_prefix(std::min(indices.find_first_not_of(kBlank), indices.size()));
        const std::string_view index = indices.substr(0, indices.find_first_of(kBlank));
        indices.remove_prefix(index.size());
        if (!index.empty() && index != "-1") {
            face.push_back(index);
            continue;
        }
        for (auto corner = face.rbegin(); corner != face.rend(); ++corner)
            result.append(*corner).append(" ");
        face.clear();
        if (index.empty())
            return result;
        result += "-1 ";
    }
}

/// With corners that go counter-clockwise, and what each has with them.
std::string facesForAssimp(std::string_view tag) {
    std::string result(tag);
    if (xmlAttribute(tag, "ccw") != "false")
        return result;
    const auto turn = [&](std::string_view name) {
        const std::string_view value = xmlAttribute(result, name);
        if (!value.empty())
            result = withValue(result, value, turned(value));
    };
    turn("coordIndex");
    turn("texCoordIndex");
    if (xmlAttribute(tag, "colorPerVertex") != "false")  // else they are of faces
        turn("colorIndex");
    if (xmlAttribute(tag, "normalPerVertex") != "false")
        turn("normalIndex");
    return result;
}

/// With a plain material where it has none, and others have: Assimp gives it that of another.
std::string shapeForAssimp(std::string_view tag, Source& source) {
    constexpr std::string_view kPlain =
        "<Appearance><Material diffuseColor='0.8 0.8 0.8'/></Appearance>";
    if (!source.hasMaterials || tag.ends_with("/>"))
        return std::string(tag);
    const auto begin = static_cast<std::size_t>(tag.data() - source.x3d.data()) + tag.size();
    const std::size_t end = next(source.x3d, "</Shape", begin, source.shapeEnd);
    const std::size_t appearance = next(source.x3d, "<Appearance", begin, source.appearance);
    const bool isPlain = appearance >= end;
    return std::string(tag).append(isPlain ? kPlain : std::string_view());
}

/// A tag that is mended, and how.
struct Mending {
    std::string_view opening;
    std::string (*mended)(std::string_view tag, Source& source);
};
constexpr std::array kMendings = {
    Mending{"<ImageTexture", [](std::string_view tag, Source&) { return imageForAssimp(tag); }},
    Mending{"<TextureTransform",
            [](std::string_view tag, Source&) { return transformForAssimp(tag); }},
    Mending{"<TriangleStripSet", stripsForAssimp},
    Mending{"</TriangleStripSet",
            [](std::string_view, Source&) { return std::string("</IndexedTriangleStripSet>"); }},
    Mending{"<Shape", shapeForAssimp},
    Mending{"<IndexedFaceSet", [](std::string_view tag, Source&) { return facesForAssimp(tag); }},
};

/// The end of a comment or of characters that are none of XML's; nothing of a tag.
std::optional<std::size_t> endOfOther(std::string_view text) {
    for (const auto& [begin, end] :
         {std::pair<std::string_view, std::string_view>{"<!--", "-->"}, {"<![CDATA[", "]]>"}})
        if (text.starts_with(begin))
            return std::min(text.find(end), text.size() - end.size()) + end.size();
    return std::nullopt;
}

/// With blanks for the commas between numbers: Assimp passes over what follows one without a blank.
std::string withoutCommas(std::string_view tag) {
    constexpr std::string_view kOfNumbers = "0123456789+-.eE \t\r\n,";
    std::string result(tag);
    for (std::size_t begin = tag.find_first_of("\"'"); begin < tag.size();) {
        const std::size_t end = std::min(tag.find(tag[begin], begin + 1), tag.size());
        if (std::min(tag.find_first_not_of(kOfNumbers, begin + 1), tag.size()) == end)
            std::replace(result.begin() + static_cast<std::ptrdiff_t>(begin),
                         result.begin() + static_cast<std::ptrdiff_t>(end), ',', ' ');
        begin = end < tag.size() ? tag.find_first_of("\"'", end + 1) : tag.size();
    }
    return result;
}

}  // namespace

std::string x3dForAssimp(std::string_view x3d) {
    Source source{
        .x3d = x3d, .hasMaterials = x3d.find("<Material") != x3d.npos, .verticesLeft = x3d.size()};
    std::string result;
    std::size_t copied = 0;
    for (std::size_t at = x3d.find('<'); at < x3d.size();) {
        const std::string_view rest = x3d.substr(at);
        const std::optional<std::size_t> other = endOfOther(rest);
        const std::string_view tag = rest.substr(0, other ? *other : endOfTag(rest));
        const auto* const mending = std::ranges::find_if(
            kMendings, [&](const Mending& one) { return rest.starts_with(one.opening); });
        const bool isMended = mending != kMendings.end();
        if (isMended || (!other && tag.find(',') != tag.npos)) {
            result.append(x3d.substr(copied, at - copied))
                .append(withoutCommas(isMended ? mending->mended(tag, source) : std::string(tag)));
            copied = at + tag.size();
        }
        at = x3d.find('<', at + tag.size());
    }
    return result.append(x3d.substr(copied));
}

}  // namespace eyrie::import
