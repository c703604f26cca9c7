// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/x3d_caveats.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <fmt/format.h>

#include "renderer/import/xml_tag.h"

namespace eyrie::import {
namespace {

/// Whether an X3D file has nodes of that kind.
bool hasNodes(std::string_view x3d, std::string_view kind) {
    constexpr std::string_view kEnds = " \t\r\n>/";
    const std::string opening = fmt::format("<{}", kind);
    for (std::size_t at = x3d.find(opening); at != std::string_view::npos;
         at = x3d.find(opening, at + 1))
        if (const std::size_t end = at + opening.size();
            end < x3d.size() && kEnds.find(x3d[end]) != std::string_view::npos)
            return true;
    return false;
}

std::string kindsAmong(std::string_view x3d, std::span<const std::string_view> kinds) {
    std::string found;
    for (const std::string_view kind : kinds)
        if (hasNodes(x3d, kind))
            found += fmt::format("{}{}", found.empty() ? "" : ", ", kind);
    return found;
}

/// Assimp gives such colours to faces' corners, and those that share a vertex have the last one's.
std::uint64_t countShapesWithColouredFaces(std::string_view x3d) {
    constexpr std::string_view kShape = "<Shape", kEnd = "</Shape";
    std::uint64_t count = 0;
    for (std::size_t at = x3d.find(kShape); at != std::string_view::npos;
         at = x3d.find(kShape, at)) {
        const std::string_view shape = x3d.substr(at, x3d.find(kEnd, at) - at);
        const std::size_t set = shape.find("colorPerVertex");
        if (set != std::string_view::npos && shape.find("<Color") != std::string_view::npos)
            count += xmlAttribute(shape.substr(set - 1), "colorPerVertex") == "false" ? 1 : 0;
        at += shape.size();
    }
    return count;
}

/// X3D 4.0 has such; scenes of before have them out of their switches.
std::uint64_t countHidden(std::string_view x3d) {
    constexpr std::string_view kAttribute = "visible";
    constexpr std::size_t kMostBehind = sizeof(" = 'false'");
    std::uint64_t count = 0;
    for (std::size_t at = x3d.find(kAttribute, 1); at < x3d.size();
         at = x3d.find(kAttribute, at + 1)) {
        const std::string_view set = x3d.substr(at - 1, 1 + kAttribute.size() + kMostBehind);
        count += xmlAttribute(set, kAttribute) == "false" ? 1 : 0;
    }
    return count;
}

/// Assimp has them as if their corners went counter-clockwise, as it does IndexedFaceSets, which
/// are mended (x3d_text.h), and no other shapes.
std::uint64_t countClockwiseTriangleSets(std::string_view x3d) {
    constexpr std::string_view kOpening = "<TriangleSet";
    std::uint64_t count = 0;
    for (std::size_t at = x3d.find(kOpening); at < x3d.size();) {
        const std::string_view tag = x3d.substr(at, endOfTag(x3d.substr(at)));
        count += xmlAttribute(tag, "ccw") == "false" ? 1 : 0;
        at = x3d.find(kOpening, at + tag.size());
    }
    return count;
}

}  // namespace

std::vector<std::string> x3dCaveats(std::string_view text) {
    constexpr std::array<std::string_view, 15> kHolders = {
        "Anchor",  "Billboard", "CADAssembly",   "CADFace",      "CADLayer",
        "CADPart", "Collision", "GeoLOD",        "GeoTransform", "HAnimHumanoid",
        "LOD",     "Layer",     "ProtoInstance", "ScreenGroup",  "ViewpointGroup"};
    constexpr std::array<std::string_view, 8> kShapes = {
        "GeoElevationGrid",  "IndexedQuadSet",      "NurbsPatchSurface", "NurbsSweptSurface",
        "NurbsSwungSurface", "NurbsTrimmedSurface", "QuadSet",           "Text"};
    std::vector<std::string> caveats;
    if (const std::string found = kindsAmong(text, kHolders); !found.empty())
        caveats.push_back(
            fmt::format("left out all that is in nodes of the kinds {}, which are not read: put it "
                        "into Groups and Transforms",
                        found));
    if (const std::string found = kindsAmong(text, kShapes); !found.empty())
        caveats.push_back(fmt::format(
            "left out shapes of the kinds {}, which are not read: export them as triangles",
            found));
    if (const std::uint64_t shapes = countShapesWithColouredFaces(text); shapes > 0)
        caveats.push_back(
            fmt::format("colours of faces of {} shapes are not taken right where these share "
                        "vertices: give colours to vertices",
                        shapes));
    if (const std::uint64_t hidden = countHidden(text); hidden > 0)
        caveats.push_back(fmt::format(
            "shows {} nodes, too, that are not to be seen (visible='false'): leave these out",
            hidden));
    if (const std::uint64_t sets = countClockwiseTriangleSets(text); sets > 0)
        caveats.push_back(
            fmt::format("{} TriangleSets have their back in front, as their corners go clockwise "
                        "(ccw='false'): make them IndexedTriangleSets",
                        sets));
    return caveats;
}

}  // namespace eyrie::import
