// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/x3d_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>

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

}  // namespace

std::string x3dForAssimp(std::string_view x3d) {
    std::string result;
    for (std::size_t at = 0; at < x3d.size();) {
        const std::size_t image = x3d.find("<ImageTexture", at);
        const std::size_t transform = x3d.find("<TextureTransform", at);
        const std::size_t begin = std::min({image, transform, x3d.size()});
        result += x3d.substr(at, begin - at);
        const std::string_view tag = x3d.substr(begin, endOfTag(x3d.substr(begin)));
        result += begin == image ? imageForAssimp(tag) : transformForAssimp(tag);
        at = begin + tag.size();
    }
    return result;
}

}  // namespace eyrie::import
