// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/collada_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include "renderer/import/mended_text.h"
#include "renderer/import/xml_tag.h"

namespace eyrie::import {
namespace {

/// Calls `use` with each tag that begins with `opening`, and where it begins.
template <typename Use>
void forEachTag(std::string_view xml, std::string_view opening, const Use& use) {
    for (std::size_t at = xml.find(opening); at != std::string_view::npos;) {
        const std::string_view tag = xml.substr(at, endOfTag(xml.substr(at)));
        use(tag, at);
        at = xml.find(opening, at + tag.size());
    }
}

/// A number of a set; 0 where the attribute has none, as the format has it.
unsigned int numberOf(std::string_view value) {
    unsigned int number = 0;
    std::from_chars(value.data(), value.data() + value.size(), number);
    return number;
}

std::set<unsigned int> setsOf(std::string_view collada) {
    std::set<unsigned int> sets;
    forEachTag(collada, "<input ", [&](std::string_view tag, std::size_t) {
        if (xmlAttribute(tag, "semantic") == "TEXCOORD")
            sets.insert(numberOf(xmlAttribute(tag, "set")));
    });
    return sets;
}

/// The set that each name stands for. A name that stands for several has the first.
std::map<std::string_view, unsigned int> bindingsOf(std::string_view collada) {
    std::map<std::string_view, unsigned int> bindings;
    forEachTag(collada, "<bind_vertex_input ", [&](std::string_view tag, std::size_t) {
        if (xmlAttribute(tag, "input_semantic") == "TEXCOORD")
            bindings.emplace(xmlAttribute(tag, "semantic"),
                             numberOf(xmlAttribute(tag, "input_set")));
    });
    return bindings;
}

/// Numbers between blanks, as many as are asked for; nothing of other text.
template <std::size_t N>
std::optional<std::array<double, N>> numbersOf(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\n";
    std::array<double, N> numbers{};
    for (double& number : numbers) {
        text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
        const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
        if (read.ec != std::errc() || !std::isfinite(number))
            return std::nullopt;
        text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
    }
    return numbers;
}

/// Row by row, of a skew's angle in degrees and two axes: what lies along the first comes to lie at
/// that angle to it, moved along the second. Nothing where the angle leads to or beyond the second.
std::optional<std::string> matrixOfSkew(std::string_view skew) {
    const auto numbers = numbersOf<7>(skew);
    if (!numbers)
        return std::nullopt;
    const auto& [degrees, ax, ay, az, bx, by, bz] = *numbers;
    const glm::dvec3 first(ax, ay, az), along = glm::normalize(glm::dvec3(bx, by, bz));
    const glm::dvec3 across = first - along * glm::dot(first, along);
    const glm::dvec3 normal = glm::normalize(across);
    const double angle = glm::radians(degrees),
                 before = std::atan2(glm::dot(first, along), glm::dot(first, normal));
    constexpr double kLeastCosine = 1e-6;
    if (!(std::cos(before + angle) > kLeastCosine))
        return std::nullopt;
    const double shift = std::tan(before + angle) - std::tan(before);
    const glm::dmat3 rows = glm::dmat3(1) + glm::outerProduct(normal, along) * shift;
    std::string matrix;
    for (int row = 0; row < 3; ++row)
        matrix += fmt::format("{} {} {} 0 ", rows[row].x, rows[row].y, rows[row].z);
    return matrix + "0 0 0 1";
}

/// With matrices for skews, of which Assimp ends the program; nothing where there are none.
std::optional<std::string> withoutSkews(std::string_view collada) {
    constexpr std::string_view kEnd = "</skew>";
    MendedText mended(collada);
    std::size_t end = 0, done = 0;
    forEachTag(collada, "<skew", [&](std::string_view tag, std::size_t at) {
        const std::size_t content = at + tag.size();
        if (end < content)
            end = collada.find(kEnd, content);
        if (end == collada.npos || at < done)  // the format has none within another
            return;
        if (const auto matrix = matrixOfSkew(collada.substr(content, end - content))) {
            done = end + kEnd.size();
            mended.replace(at, done - at, fmt::format("<matrix>{}</matrix>", *matrix));
        }
    });
    return mended.finish();
}

std::string withNumberedTextures(std::string_view collada) {
    const std::set<unsigned int> sets = setsOf(collada);
    const std::map<std::string_view, unsigned int> bindings = bindingsOf(collada);
    std::string result;
    std::size_t done = 0;
    forEachTag(collada, "<texture ", [&](std::string_view tag, std::size_t at) {
        const std::string_view name = xmlAttribute(tag, "texcoord");
        const auto bound = bindings.find(name);
        const auto set = bound != bindings.end() ? sets.find(bound->second) : sets.end();
        if (name.empty() || set == sets.end())
            return;
        result += collada.substr(done, at - done);
        result += withValue(tag, name, fmt::format("{}", std::distance(sets.begin(), set)));
        done = at + tag.size();
    });
    return result += collada.substr(done);
}

}  // namespace

std::string colladaForAssimp(std::string_view collada) {
    const std::optional<std::string> straight = withoutSkews(collada);
    return withNumberedTextures(straight ? std::string_view(*straight) : collada);
}

}  // namespace eyrie::import
