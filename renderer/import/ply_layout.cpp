// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/byte_colours.h"

namespace eyrie::import {
namespace {

constexpr std::uint64_t kMaxVertices = std::numeric_limits<std::uint32_t>::max() - 1;

struct SlotName {
    std::string_view name;
    std::size_t slot;
};
/// Colours and texture coordinates are called as by Blender, MeshLab and photogrammetry programs.
constexpr std::array<SlotName, 24> kSlotNames = {{
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
    {"r", 6},
    {"g", 7},
    {"b", 8},
    {"a", 9},
    {"s", kU},
    {"t", kV},
    {"u", kU},
    {"v", kV},
    {"texture_u", kU},
    {"texture_v", kV},
}};

std::size_t slotOf(std::string_view name) {
    for (const SlotName& entry : kSlotNames)
        if (entry.name == name)
            return entry.slot;
    return kIgnored;
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

VertexLayout::VertexLayout(const PlyElement& element, bool withPlaces) {
    for (const PlyProperty& property : element.properties) {
        std::size_t slot = property.isList() ? std::size_t{kIgnored} : slotOf(property.name);
        if (isFilled[slot] || (!withPlaces && (slot == kU || slot == kV)))
            slot = kIgnored;
        slots.push_back(slot);
        if (slot != kIgnored) {
            isFilled[slot] = true;
            types[slot] = property.type;
        }
    }
}

std::uint8_t colourByte(double value, PlyType type, const ByteColours& bytes) {
    if (!isInteger(type))
        value *= bytes.areReals ? 1 : 255;
    else if (type == PlyType::UInt16)
        value /= bytes.areWide ? 1 : 257;
    return static_cast<std::uint8_t>(value > 0 ? std::lround(std::min(value, 255.0)) : 0);
}

std::uint8_t opacityByte(double value, PlyType type, const ByteColours& bytes) {
    return colourByte(value, type, {value > kMostOfFractions, bytes.areWide});
}

const PlyProperty* findCorners(const PlyElement& element) {
    const PlyProperty* property = element.find("vertex_indices");
    return property != nullptr ? property : element.find("vertex_index");
}

TextureLayout::TextureLayout(const PlyHeader& header)
    : images(header.textureFiles.size()),
      ofVertices(VertexLayout(*header.find("vertex"), true).hasPlaces()) {
    const PlyElement* const face = header.find("face");
    if (face == nullptr)
        return;
    const PlyProperty* const places = face->find("texcoord");
    ofFaces = places != nullptr && places->isList() ? places : nullptr;
    const PlyProperty* const property = face->find("texnumber");
    number = property != nullptr && !property->isList() ? property : nullptr;
}

std::vector<std::string> notesOf(const PlyHeader& header, bool withTextures) {
    std::vector<std::string> notes;
    const TextureLayout layout(header);
    const bool hasPlaces = layout.ofVertices || layout.ofFaces != nullptr;
    if (layout.isUsed() && !withTextures)
        notes.push_back(fmt::format(
            "left out its {} textures, which a mesh that is imported part by part cannot have; "
            "allow more memory, so that it is imported at once",
            layout.images));
    if (layout.images > 0 && !hasPlaces)
        notes.push_back(fmt::format(
            "left out its {} textures: it has no texture coordinates that are known here (s t, "
            "u v or texture_u texture_v of vertices, a list texcoord of faces)",
            layout.images));
    if (layout.images == 0 && hasPlaces)
        notes.emplace_back(
            "its texture coordinates are of no use: it names no image (comment TextureFile)");
    if (header.find("multi_texture_vertex") != nullptr)
        notes.emplace_back(
            "left out its texture coordinates of the element multi_texture_vertex; for textures "
            "export it as OBJ or glTF");
    if (hasFaceColours(header))
        notes.emplace_back("left out its colours of faces: of PLY those of vertices are read");
    return notes;
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
