// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "fabric/image.h"
#include "fabric/lights.h"
#include "fabric/vec.h"
#include "renderer/mesh/material.h"

namespace eyrie::import {

/// In mesh::Material::flags until textures are loaded: the format does not say whether its image's
/// alpha makes holes or a veil, so the image does ...
inline constexpr std::uint32_t kAlphaByImage = 1U << 31;
/// ... and the image, if there is one, takes the place of the colour, but for the opacity.
inline constexpr std::uint32_t kReplacesColour = 1U << 30;

/// An image that a source names, or has in it: `bytes` as a file of that name would have.
struct TextureSource {
    std::string name;  ///< a path as the source writes it, or, beside bytes, for messages
    std::vector<std::byte> bytes;
    std::uint32_t flags = 0;  ///< mesh::kClampsU and V

    bool operator==(const TextureSource&) const = default;
};

/// A mesh as its source gives it, in the source's own units (taken as metres) and order.
///
/// Invariant of every reader: positions are finite and every corner is below positions.size().
/// `normals`, `colours`, `textureCoordinates` and `materialOf` are empty or have one entry a
/// position; normals may have any length, zero and not-a-number included, and texture coordinates
/// be anything. The corners of a triangle have one material. Materials' images count in `textures`
/// as readers give them, and in `images` once they are loaded (texture_files.h).
struct TriangleMesh {
    std::vector<fabric::Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside
    std::vector<glm::vec3> normals;
    std::vector<fabric::Rgba> colours;
    std::vector<glm::vec2> textureCoordinates;  ///< from an image's upper left corner, v down
    std::vector<std::uint16_t> materialOf;
    std::vector<mesh::Material> materials;  ///< the first is plain, where there are any
    std::vector<TextureSource> textures;
    std::vector<mesh::Image> images;
    /// Bound on how far reading has moved positions from those that the file states.
    double roundingMetres = 0;
    fabric::FileLights lights;       ///< as source_lights.h has them
    std::uint64_t droppedFaces = 0;  ///< faces of the source with fewer than three corners
    std::vector<std::string> notes;  ///< what was odd in the source; a line each

    bool operator==(const TriangleMesh&) const = default;
};

}  // namespace eyrie::import
