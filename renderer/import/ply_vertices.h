// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <absl/status/status.h>

#include "renderer/import/ply_body.h"
#include "renderer/import/ply_layout.h"

namespace eyrie::import {

/// Reads the vertices of a PLY body into its mesh: places and, where complete, normals, colours
/// and, if asked for, texture coordinates.
template <typename Values>
class PlyVertices {
public:
    /// `body` outlives this.
    PlyVertices(PlyBody<Values>& body, bool withPlaces) : body_(body), withPlaces_(withPlaces) {}

    /// Of the element that the body is at.
    absl::Status read();

    /// How colours were taken, for TriangleMesh::notes; `isTextured` where images stand for them.
    void addNotes(bool isTextured) const;

private:
    absl::Status lookForBytes(const VertexLayout& layout);
    absl::Status measureColours(const VertexLayout& layout, double& mostReal, double& mostWide);
    absl::Status store(const VertexLayout& layout, const VertexRow& row, std::uint64_t index);

    PlyBody<Values>& body_;
    bool withPlaces_;
    ByteColours bytes_;
    bool isOddlyOfBytes_ = false;  ///< one of these shows
    std::uint64_t notOpaque_ = 0;  ///< vertices
};

}  // namespace eyrie::import
