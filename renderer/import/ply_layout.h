// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/status.h>

#include "renderer/import/ply_header.h"

/// What the elements and properties of a PLY file mean to a mesh.
namespace eyrie::import {

/// Where a vertex property's value goes: x y z, nx ny nz, r g b a, u v, or nowhere.
enum VertexSlot : std::size_t {
    kX = 0,
    kNormalX = 3,
    kRed = 6,
    kAlpha = 9,
    kU = 10,
    kV = 11,
    kIgnored = 12,
    kVertexSlots = 13
};

using VertexRow = std::array<double, kVertexSlots>;

/// The slot of each property of a vertex element. Lists, unknown names and repeated ones are
/// ignored, and so are texture coordinates unless they are asked for.
struct VertexLayout {
    explicit VertexLayout(const PlyElement& element, bool withPlaces = false);

    /// Whether the slot and the two after it are filled.
    bool hasThree(std::size_t first) const {
        return isFilled[first] && isFilled[first + 1] && isFilled[first + 2];
    }
    bool hasPlaces() const { return isFilled[kU] && isFilled[kV]; }
    bool isReal(std::size_t slot) const { return isFilled[slot] && !isInteger(types[slot]); }
    bool isWide(std::size_t slot) const { return isFilled[slot] && types[slot] == PlyType::UInt16; }

    std::vector<std::size_t> slots;             ///< one a property
    std::array<PlyType, kVertexSlots> types{};  ///< of the property that fills a slot
    std::array<bool, kVertexSlots> isFilled{};
};

/// Which of a file's colours reach to 255 though their type does not say so (byte_colours.h).
struct ByteColours {
    bool areReals = false;  ///< which reach to 1 otherwise
    bool areWide = false;   ///< of 16 bits, to 65,535 otherwise
};

/// A colour value of a property of `type` as a byte, clamped; not-a-number is 0.
std::uint8_t colourByte(double value, PlyType type, const ByteColours& bytes);

/// The same of an opacity: a real one reaches to 255 where it is above kMostOfFractions itself.
std::uint8_t opacityByte(double value, PlyType type, const ByteColours& bytes);

/// The property that lists the corners of a face or strip; null if there is none.
const PlyProperty* findCorners(const PlyElement& element);

/// How a file lays the images that it names on its surface.
struct TextureLayout {
    explicit TextureLayout(const PlyHeader& header);

    bool isUsed() const { return images > 0 && (ofVertices || ofFaces != nullptr); }
    /// Whether faces say something that their vertices do not.
    bool isByFace() const { return ofFaces != nullptr || number != nullptr; }

    std::size_t images = 0;                ///< named
    bool ofVertices = false;               ///< vertices have texture coordinates
    const PlyProperty* ofFaces = nullptr;  ///< the list of those of a face's corners; comes first
    const PlyProperty* number = nullptr;   ///< a face's, of its image; the first without it
};

/// What the file has of a surface's look that is not read: for TriangleMesh::notes. Without
/// `withTextures` those are left out whatever there is.
std::vector<std::string> notesOf(const PlyHeader& header, bool withTextures);

/// InvalidArgument unless the header promises a mesh: vertices with positions, few enough for
/// 32-bit numbers, and faces or strips that list them.
absl::Status checkIsMesh(const PlyHeader& header);

}  // namespace eyrie::import
