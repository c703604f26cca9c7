// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "renderer/import/triangle_mesh.h"
#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lod/lod_tree.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::test {

/// A mesh with levels of detail, of which files can be written that are always drawn with one
/// certain cut: nodes of it and below have no error, those above a huge one.
class ForcedCuts {
public:
    /// `nodeTriangles`: of leaves, and what stands for inner nodes.
    ForcedCuts(import::TriangleMesh source, std::uint32_t nodeTriangles);

    /// Writes a .eym that is drawn with a random cut, in which levels far apart meet, at any tau
    /// below a million pixels. Returns points, in metres, that two of the cut's nodes share.
    std::vector<fabric::Vec3> write(const std::string& path, std::mt19937& random) const;

private:
    std::vector<mesh::Triangle> drawnBy(std::size_t node) const;
    void choose(std::size_t node, std::mt19937& random, std::vector<std::size_t>& cut,
                std::vector<double>& errors) const;

    mesh::PackedMesh packed_;
    mesh::KdTree tree_;
    mesh::LodTree lod_;
};

}  // namespace eyrie::test
