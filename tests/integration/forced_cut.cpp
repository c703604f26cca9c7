// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/forced_cut.h"

#include <set>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "renderer/import/pack_mesh.h"
#include "renderer/mesh/eym_writer.h"
#include "renderer/mesh/output_file.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::test {
namespace {

constexpr double kHugeMetres = 1e20;

/// A fixture's input is sound: what fails is the code under test.
template <typename T>
T orThrow(absl::StatusOr<T> result) {
    if (!result.ok())
        throw std::runtime_error(result.status().ToString());
    return *std::move(result);
}

void orThrow(const absl::Status& status) {
    if (!status.ok())
        throw std::runtime_error(status.ToString());
}

}  // namespace

ForcedCuts::ForcedCuts(import::TriangleMesh source, std::uint32_t nodeTriangles) {
    import::PackCounts counts;
    packed_ = orThrow(import::packMesh(std::move(source), counts));
    tree_ = orThrow(mesh::buildKdTree(packed_.positions, packed_.triangles, {nodeTriangles}));
    lod_ = orThrow(mesh::buildLodTree(packed_, tree_, {nodeTriangles}));
}

std::vector<mesh::Triangle> ForcedCuts::drawnBy(std::size_t index) const {
    const mesh::KdNode& node = tree_.nodes[index];
    if (!node.isLeaf())
        return lod_.geometry[index];
    std::vector<mesh::Triangle> triangles;
    for (std::uint64_t i = node.triangleBegin; i < node.triangleEnd; ++i)
        triangles.push_back(packed_.triangles[tree_.order[i]]);
    return triangles;
}

void ForcedCuts::choose(std::size_t index, std::mt19937& random, std::vector<std::size_t>& cut,
                        std::vector<double>& errors) const {
    const mesh::KdNode& node = tree_.nodes[index];
    const bool isDrawn =
        node.isLeaf() || (index > 0 && !lod_.geometry[index].empty() && random() % 4 == 0);
    if (isDrawn) {
        cut.push_back(index);
        return;
    }
    errors[index] = kHugeMetres;
    choose(static_cast<std::size_t>(node.left), random, cut, errors);
    choose(static_cast<std::size_t>(node.right), random, cut, errors);
}

std::vector<fabric::Vec3> ForcedCuts::write(const std::string& path, std::mt19937& random) const {
    std::vector<std::size_t> cut;
    mesh::LodTree lod = lod_;
    lod.errorMetres.assign(tree_.nodes.size(), 0.0);
    choose(0, random, cut, lod.errorMetres);
    auto out = orThrow(mesh::OutputFile::create(path));
    orThrow(mesh::writeEym(packed_, tree_, lod, mesh::findBacks(packed_, tree_), {.isCoded = false},
                           out));
    orThrow(out.commit());

    std::unordered_map<std::uint32_t, int> nodesAt;  // of the cut, by vertex
    for (const std::size_t node : cut) {
        std::set<std::uint32_t> vertices;
        for (const mesh::Triangle& triangle : drawnBy(node))
            vertices.insert(triangle.begin(), triangle.end());
        for (const std::uint32_t vertex : vertices) ++nodesAt[vertex];
    }
    std::set<std::uint32_t> shared;
    for (const auto& [vertex, nodes] : nodesAt)
        if (nodes > 1)
            shared.insert(vertex);
    std::vector<fabric::Vec3> seams;
    for (const std::uint32_t vertex : shared)
        seams.push_back(packed_.lattice.metres(mesh::unpackPosition(packed_.positions[vertex])));
    return seams;
}

}  // namespace eyrie::test
