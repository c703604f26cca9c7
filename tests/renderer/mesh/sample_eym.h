// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "renderer/mesh/eym_writer.h"
#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/vertex_packing.h"
#include "tests/renderer/mesh/sample_meshes.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::test {

/// The bytes of a small .eym file with all that there may be in one.
inline std::string sampleEym(bool isCoded) {
    const TemporaryFolder folder;
    mesh::PackedMesh soup = texturedSoup(40, 1);
    soup.materials[2].flags = 0;  // points stand for nothing that is blended
    for (const std::uint64_t position : soup.positions)
        soup.exact.push_back(soup.lattice.metres(mesh::unpackPosition(position)) + 0.01);
    soup.lights = {{{{0, 0, -1}, {1, 1, 1}}},
                   {{{1, 2, 3}, {1, 0.5, 0}, 10, fabric::LightCone{{1, 0, 0}, 10, 20}}}};
    const mesh::KdTree tree = mesh::buildKdTree(soup.positions, soup.triangles, {10}).value();
    mesh::OutputFile out = mesh::OutputFile::create(folder.file("m.eym")).value();
    const auto lod = mesh::buildLodTree(
        soup, tree, {.nodeTriangles = 10, .sampledTriangles = 20, .nodePoints = 16});
    if (!lod.value().points[0].has_value() ||
        !mesh::writeEym(soup, tree, *lod, mesh::findBacks(soup, tree), {.isCoded = isCoded}, out)
             .ok() ||
        !out.commit().ok())
        throw std::runtime_error("cannot make a small .eym file");
    return readFile(folder.file("m.eym"));
}

}  // namespace eyrie::test
