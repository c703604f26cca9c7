// SPDX-License-Identifier: Apache-2.0
#include "cli/import_notes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

namespace eyrie::cli {
namespace {

long percent(double share) { return std::lround(100 * share); }

/// "5, 7, 0 %", from the finest level.
std::string percentages(const std::vector<mesh::LodLevel>& levels,
                        double (mesh::PointCounts::*share)() const) {
    std::string text;
    for (const mesh::LodLevel& level : levels)
        text += fmt::format("{}{}", text.empty() ? "" : ", ", percent((level.points.*share)()));
    return text + " %";
}

/// "3 faces of fewer than three corners, 122 triangles that were there already"; empty where
/// nothing was left out.
std::string leftOutOf(const import::MeshImportReport& made) {
    std::string text;
    const auto add = [&](std::uint64_t count, std::string_view what) {
        if (count > 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    };
    add(made.droppedFaces, "faces of fewer than three corners");
    add(made.counts.degenerateTriangles, "triangles without area");
    add(made.counts.duplicateTriangles, "triangles that were there already");
    return text;
}

/// Of those that are left: more tell that the lattice is too coarse.
constexpr double kMostWithoutArea = 0.01;

double borderShareOf(const mesh::LodLevel& level) { return level.points.borderShare(); }

}  // namespace

std::vector<std::string> notesOf(const import::MeshImportReport& made) {
    std::vector<std::string> notes = made.notes;
    const import::PackCounts& counts = made.counts;
    if (const std::string leftOut = leftOutOf(made); !leftOut.empty())
        notes.push_back("left out " + leftOut);
    if (static_cast<double>(counts.degenerateTriangles - counts.emptyTriangles) >
        kMostWithoutArea * static_cast<double>(made.triangles))
        notes.push_back(fmt::format(
            "corners are rounded to {:.3g} m, as they are in a mesh of this extent: where many "
            "triangles are smaller, look for vertices far from all others, or split the mesh",
            made.stepMetres));
    const auto most = std::ranges::max_element(made.levels, {}, borderShareOf);
    if (most != made.levels.end() && borderShareOf(*most) > mesh::kMostBorderShare)
        notes.push_back(fmt::format(
            "{} % of the vertices of level {} stay because nodes meet there, more than {} %: what "
            "is promised holds, but pictures take more triangles than that needs; where they are "
            "too slow raise tau or import fewer triangles",
            percent(borderShareOf(*most)), most - made.levels.begin() + 1,
            percent(mesh::kMostBorderShare)));
    return notes;
}

std::string keptLine(const import::MeshImportReport& made) {
    if (made.levels.empty())
        return "";
    return fmt::format(
        "of the vertices, by level from the finest, stay {} where nodes meet, and "
        "{} at open edges or where sheets touch",
        percentages(made.levels, &mesh::PointCounts::borderShare),
        percentages(made.levels, &mesh::PointCounts::stayingShare));
}

}  // namespace eyrie::cli
