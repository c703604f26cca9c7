// SPDX-License-Identifier: Apache-2.0
// ISO/ASTM 52915 (AMF), ISO/IEC 19776-1 (X3D).
#include "renderer/import/stated_unit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>

#include <fmt/format.h>

#include "access/printable.h"
#include "renderer/import/xml_tag.h"

namespace eyrie::import {
namespace {

struct Unit {
    std::string_view name;
    double metres;
};
constexpr std::array kUnitsOfAmf = {
    Unit{"millimeter", 0.001}, Unit{"inch", 0.0254}, Unit{"feet", 0.3048},
    Unit{"meter", 1.0},        Unit{"micron", 1e-6},
};

/// The first tag from `at` on that begins so; empty without one.
std::string_view tagFrom(std::string_view xml, std::string_view opening, std::size_t at) {
    const std::size_t begin = std::min(xml.find(opening, at), xml.size());
    const std::string_view rest = xml.substr(begin);
    return rest.substr(0, endOfTag(rest));
}

/// 0 where it is no length.
double metresOf(std::string_view factor) {
    double metres = 0;
    const auto read = std::from_chars(factor.data(), factor.data() + factor.size(), metres);
    return read.ec == std::errc() && std::isfinite(metres) ? std::max(metres, 0.0) : 0;
}

/// Files with another one Assimp refuses. Without any the format has them in the first.
double unitOfAmf(std::string_view amf) {
    const std::string_view name = xmlAttribute(tagFrom(amf, "<amf", 0), "unit");
    if (name.empty())
        return kUnitsOfAmf.front().metres;
    const auto* const known = std::ranges::find(kUnitsOfAmf, name, &Unit::name);
    return known != kUnitsOfAmf.end() ? known->metres : 1;
}

double unitOfX3d(std::string_view x3d, std::vector<std::string>& notes) {
    constexpr std::string_view kOpening = "<unit ";
    std::string_view tag = tagFrom(x3d, kOpening, 0);
    while (!tag.empty() && xmlAttribute(tag, "category") != "length")
        tag = tagFrom(x3d, kOpening, static_cast<std::size_t>(tag.data() - x3d.data()) + 1);
    const std::string_view factor = xmlAttribute(tag, "conversionFactor");
    const double metres = metresOf(factor);
    if (metres > 0 || factor.empty())
        return factor.empty() ? 1 : metres;
    notes.push_back(
        fmt::format("taken to be in metres: the file says that its unit is {} m, which none is",
                    access::printable(factor)));
    return 1;
}

}  // namespace

double statedUnitOf(std::string_view text, const AssimpFormat& format,
                    std::vector<std::string>& notes) {
    if (format.extension == ".amf")
        return unitOfAmf(text);
    return format.extension == ".x3d" ? unitOfX3d(text, notes) : 1;
}

}  // namespace eyrie::import
