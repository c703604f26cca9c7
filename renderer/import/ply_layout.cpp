// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

constexpr std::uint64_t kMaxVertices = std::numeric_limits<std::uint32_t>::max() - 1;

struct SlotName {
    std::string_view name;
    std::size_t slot;
};
constexpr std::array<SlotName, 14> kSlotNames = {{
    {"x", 0},
    {"y", 1},
    {"z", 2},
    {"nx", 3},
    {"ny", 4},
    {"nz", 5},
    {"red", 6},
    {"green", 7},
    {"blue", 8},
    {"alpha", 9},
    {"diffuse_red", 6},
    {"diffuse_green", 7},
    {"diffuse_blue", 8},
    {"diffuse_alpha", 9},
}};

std::size_t slotOf(std::string_view name) {
    for (const SlotName& entry : kSlotNames)
        if (entry.name == name)
            return entry.slot;
    return kIgnored;
}

/// As MeshLab, Blender and photogrammetry programs call them.
constexpr std::array<std::string_view, 6> kTextureCoordinates = {"s", "t",         "u",
                                                                 "v", "texture_u", "texture_v"};

bool hasTextureCoordinates(const PlyHeader& header) {
    const PlyElement* const vertex = header.find("vertex");
    const PlyElement* const face = header.find("face");
    return std::ranges::any_of(kTextureCoordinates,
                               [&](std::string_view name) { return vertex->find(name); }) ||
           (face != nullptr && face->find("texcoord") != nullptr) ||
           header.find("multi_texture_vertex") != nullptr;
}

bool hasFaceColours(const PlyHeader& header) {
    const PlyElement* const face = header.find("face");
    return face != nullptr &&
           (face->find("red") != nullptr || face->find("diffuse_red") != nullptr);
}

std::string elementNames(const PlyHeader& header) {
    std::string names;
    for (const PlyElement& element : header.elements)
        names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", element.name, element.count);
    return names.empty() ? "none" : names;
}

absl::Status checkVertexElement(const PlyElement& vertex) {
    if (!VertexLayout(vertex).hasThree(kX))
        return absl::InvalidArgumentError(
            "header, element vertex: expected the properties x, y and z; export the mesh again");
    if (vertex.count == 0 || vertex.count > kMaxVertices)
        return absl::InvalidArgumentError(
            fmt::format("header, count of element vertex: found {}, expected 1 to {}; export the "
                        "mesh again, or split it",
                        vertex.count, kMaxVertices));
    return absl::OkStatus();
}

absl::Status checkFaceElement(const PlyElement& element) {
    if (element.count == 0)
        return absl::OkStatus();
    const PlyProperty* corners = findCorners(element);
    if (corners == nullptr || !corners->isList() || !isInteger(corners->type))
        return absl::InvalidArgumentError(fmt::format(
            "header, element {}: found no list of whole numbers called vertex_indices or "
            "vertex_index, expected one; export the mesh again with faces",
            element.name));
    return absl::OkStatus();
}

}  // namespace

VertexLayout::VertexLayout(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
        std::size_t slot = property.isList() ? std::size_t{kIgnored} : slotOf(property.name);
        if (isFilled[slot])
            slot = kIgnored;
        slots.push_back(slot);
        if (slot != kIgnored) {
            isFilled[slot] = true;
            types[slot] = property.type;
        }
    }
}

std::uint8_t colourByte(double value, PlyType type) {
    if (!isInteger(type))
        value *= 255;
    else if (type == PlyType::UInt16)
        value /= 257;
    return static_cast<std::uint8_t>(value > 0 ? std::lround(std::min(value, 255.0)) : 0);
}

const PlyProperty* findCorners(const PlyElement& element) {
    const PlyProperty* property = element.find("vertex_indices");
    return property != nullptr ? property : element.find("vertex_index");
}

std::vector<std::string> notesOf(const PlyHeader& header) {
    std::vector<std::string> leftOut;
    if (header.textureFiles > 0)
        leftOut.push_back(fmt::format("texture files ({})", header.textureFiles));
    if (hasTextureCoordinates(header))
        leftOut.emplace_back("texture coordinates");
    if (hasFaceColours(header))
        leftOut.emplace_back("colours of faces");
    if (leftOut.empty())
        return {};
    return {fmt::format(
        "left out its {}: of PLY only vertices' colours are read; for textures export it as OBJ or "
        "glTF",
        fmt::join(leftOut, ", "))};
}

absl::Status checkIsMesh(const PlyHeader& header) {
    const PlyElement* vertex = header.find("vertex");
    if (vertex == nullptr)
        return absl::InvalidArgumentError(fmt::format(
            "header: found the elements {}, expected one called vertex; export the mesh "
            "again as PLY",
            elementNames(header)));
    for (const std::string_view name : {"vertex", "face", "tristrips"})
        if (std::count_if(header.elements.begin(), header.elements.end(),
                          [name](const PlyElement& e) { return e.name == name; }) > 1)
            return absl::InvalidArgumentError(fmt::format(
                "header: found element {} more than once, expected once; export the mesh again",
                name));
    RETURN_IF_ERROR(checkVertexElement(*vertex));
    std::uint64_t faces = 0;
    for (const std::string_view name : {"face", "tristrips"}) {
        if (const PlyElement* element = header.find(name); element != nullptr) {
            RETURN_IF_ERROR(checkFaceElement(*element));
            faces += element->count;
        }
    }
    if (faces == 0)
        return absl::InvalidArgumentError(fmt::format(
            "header: found {} vertices and zero faces (elements: {}), expected an element face or "
            "tristrips that is not empty; a point cloud cannot be drawn as a mesh: reconstruct its "
            "surface first, or export the mesh with its faces",
            vertex->count, elementNames(header)));
    return absl::OkStatus();
}

}  // namespace eyrie::import
