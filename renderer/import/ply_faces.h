// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/status.h>

#include "renderer/import/ply_body.h"
#include "renderer/import/ply_layout.h"
#include "renderer/import/ply_textures.h"

namespace eyrie::import {

/// Reads the faces and strips of a PLY body into its mesh, and how they lie in its images.
template <typename Values>
class PlyFaces {
public:
    /// Both outlive this. `memoryBytes`: that polygons may take; 0: any.
    PlyFaces(PlyBody<Values>& body, const TextureLayout& layout, bool isTextured,
             std::uint64_t memoryBytes)
        : body_(body),
          layout_(layout),
          textures_(layout),
          isTextured_(isTextured),
          memoryBytes_(memoryBytes) {}

    /// Of the element that the body is at, "face" or "tristrips".
    absl::Status read();

    /// What waits until all vertices are known: textures, and faces of more than three corners.
    /// `path` is where the file would have its images.
    absl::Status finish(const std::string& path);

private:
    /// A face of more than three corners.
    struct Polygon {
        std::uint64_t face;
        std::size_t firstCorner;
        std::size_t cornerCount;
    };
    /// The last two corners of a strip and the turn its next triangle has.
    struct Strip {
        std::array<std::uint32_t, 2> last{};
        std::uint64_t corners = 0;
    };

    absl::Status readList(const PlyProperty& property, std::uint64_t index);
    absl::Status readFace(const PlyProperty& property, std::uint64_t index, std::uint64_t count);
    absl::Status addPolygon(std::uint64_t face, std::uint64_t corners);
    absl::Status readStrip(const PlyProperty& property, std::uint64_t index, std::uint64_t count);
    void extend(Strip& strip, std::uint32_t corner);
    absl::Status readTexturedFaces();
    absl::Status readTexturedFace(const PlyProperty* corners, std::uint64_t index);
    absl::Status readPlaces(std::uint64_t index);
    absl::Status triangulatePolygons();

    PlyBody<Values>& body_;
    const TextureLayout& layout_;
    PlyTextures textures_;
    bool isTextured_;
    std::uint64_t memoryBytes_;
    std::vector<Polygon> polygons_;
    std::vector<std::uint32_t> polygonCorners_;
    std::vector<double> places_;  ///< of the face being read
};

}  // namespace eyrie::import
