// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_part.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include <glm/common.hpp>

#include "renderer/mesh/eym_writer.h"
#include "renderer/mesh/kd_tree.h"

namespace eyrie::import {
namespace {

/// Vertices that parts outside of [first, last] have, too.
std::vector<std::uint32_t> sharedOutside(const std::vector<std::array<std::uint32_t, 2>>& sharedBy,
                                         std::uint32_t first, std::uint32_t last) {
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t i = 0; i < sharedBy.size(); ++i)
        if (sharedBy[i][0] < first || sharedBy[i][1] > last)
            vertices.push_back(i);
    return vertices;
}

/// What is left of a mesh's vertices after `lod`.
PartSurface surfaceOf(const PartMesh& own, mesh::LodPart lod, double reachMetres,
                      const mesh::KdNode& box, const mesh::LodOptions& options) {
    PartSurface surface;
    surface.boxMin = box.boxMin;
    surface.boxMax = box.boxMax;
    surface.boundSteps = lod.errorSteps;
    surface.reachMetres = reachMetres;
    surface.lod.height = lod.height;
    surface.mesh.lattice = own.mesh.lattice;
    surface.isEndless = lod.patch.triangles.size() > options.mostUseful();
    if (surface.isEndless)
        return surface;
    surface.lod = std::move(lod);
    const std::vector<std::uint32_t> vertices =
        compact(own.mesh.positions.size(), surface.lod.patch.triangles);
    surface.mesh = withVertices(own.mesh, vertices);
    surface.mesh.exact.clear();  // leaves have them
    surface.firstUse = chosenOf(own.firstUse, vertices);
    surface.sharedBy = chosenOf(own.sharedBy, vertices);
    return surface;
}

absl::StatusOr<std::uint64_t> appendEym(const PartWork& work, const mesh::PackedMesh& mesh,
                                        const mesh::KdTree& tree, const mesh::LodTree& lod,
                                        const mesh::Backs& backs, const std::stop_token& stop) {
    const std::uint64_t offset = work.out.size();
    RETURN_IF_ERROR(mesh::writeEym(mesh, tree, lod, backs,
                                   {.isCoded = !work.options.isRaw,
                                    .sourceHash = work.sourceHash,
                                    .exactForm = work.exactForm},
                                   work.out, stop));
    return offset;
}

/// The vertices of two surfaces, those that both have once; `a` and `b` become their numbers.
PartMesh merged(const PartSurface& left, const PartSurface& right, std::vector<std::uint32_t>& a,
                std::vector<std::uint32_t>& b) {
    PartMesh both;
    both.mesh.lattice = left.mesh.lattice;
    const auto take = [&](const PartSurface& from, std::vector<std::uint32_t>& numbers) {
        const std::size_t vertex = numbers.size();
        numbers.push_back(static_cast<std::uint32_t>(both.firstUse.size() - 1));
        if (both.mesh.positions.size() == both.firstUse.size())
            return;
        both.mesh.positions.push_back(from.mesh.positions[vertex]);
        both.mesh.normals.push_back(from.mesh.normals[vertex]);
        if (!from.mesh.colours.empty())
            both.mesh.colours.push_back(from.mesh.colours[vertex]);
        both.sharedBy.push_back(from.sharedBy[vertex]);
    };
    while (a.size() < left.firstUse.size() || b.size() < right.firstUse.size()) {
        constexpr auto kEnd = std::numeric_limits<std::uint64_t>::max();
        const std::uint64_t ofA = a.size() < left.firstUse.size() ? left.firstUse[a.size()] : kEnd;
        const std::uint64_t ofB =
            b.size() < right.firstUse.size() ? right.firstUse[b.size()] : kEnd;
        both.firstUse.push_back(std::min(ofA, ofB));
        if (ofA <= ofB)
            take(left, a);
        if (ofB <= ofA)
            take(right, b);
    }
    return both;
}

/// Appends the triangles of a surface to the mesh in which its vertices have `numbers`.
void appendTriangles(PartMesh& both, mesh::LodPart& lod,
                     const std::vector<std::uint32_t>& numbers) {
    for (mesh::Triangle& triangle : lod.patch.triangles) {
        for (std::uint32_t& corner : triangle) corner = numbers[corner];
        both.mesh.triangles.push_back(triangle);
    }
}

/// A node above two others.
mesh::KdTree treeOver(const PartSurface& left, const PartSurface& right) {
    const std::size_t middle = left.lod.patch.triangles.size();
    const std::size_t end = middle + right.lod.patch.triangles.size();
    mesh::KdTree tree;
    tree.nodes = {
        {glm::min(left.boxMin, right.boxMin), glm::max(left.boxMax, right.boxMax), 1, 2, 0, end},
        {left.boxMin, left.boxMax, -1, -1, 0, middle},
        {right.boxMin, right.boxMax, -1, -1, middle, end}};
    tree.order.resize(end);
    std::iota(tree.order.begin(), tree.order.end(), 0U);
    return tree;
}

}  // namespace

absl::StatusOr<WrittenPart> writePart(const PartWork& work, std::uint32_t part,
                                      const ImportControl& control) {
    ASSIGN_OR_RETURN(const PartMesh own, packPart(work, part, control));
    ASSIGN_OR_RETURN(const mesh::KdTree tree,
                     mesh::buildKdTree(own.mesh.positions, own.mesh.triangles,
                                       {work.options.leafTriangles}, control.stop));
    const std::vector<std::uint32_t> goesOnAt = sharedOutside(own.sharedBy, part, part);
    const mesh::LodOptions options{.goesOnAt = goesOnAt,
                                   .leafTriangles = work.options.leafTriangles};
    mesh::LodParts parts;
    ASSIGN_OR_RETURN(
        const mesh::LodTree lod,
        mesh::buildLodTree(
            own.mesh, tree, options, [&](double share) { control.report("levels", share); },
            control.stop, &parts));
    const mesh::Backs backs{work.isBehind ? mesh::gatherPockets(own.mesh, tree, own.isBehind)
                                          : mesh::pocketsEverywhere(tree),
                            {}};
    WrittenPart written;
    ASSIGN_OR_RETURN(written.offset, appendEym(work, own.mesh, tree, lod, backs, control.stop));
    written.nodes = tree.nodes.size();
    written.vertices = own.newVertices;
    written.computedNormals = own.computedNormals;
    written.levels = lod.levels;
    written.pointNodes = lod.pointNodes();
    written.errorMetres = lod.errorMetres.front();
    written.surface = surfaceOf(own, std::move(parts.root), lod.colourReachMetres.front(),
                                tree.nodes.front(), options);
    written.surface.pockets = backs.pockets.front();
    return written;
}

absl::StatusOr<WrittenPart> writeAbove(const PartWork& work, const SplitNode& node,
                                       PartSurface left, PartSurface right,
                                       const ImportControl& control) {
    mesh::LodOptions options{.leafTriangles = work.options.leafTriangles};
    mesh::KdTree tree = treeOver(left, right);
    PartMesh both;
    both.mesh.lattice = work.spool.lattice;
    mesh::Pockets pockets = left.pockets;
    pockets.add(right.pockets);
    WrittenPart written;
    mesh::LodTree lod;
    if (left.isEndless || right.isEndless || tree.order.size() > options.mostUseful()) {
        const double bound = std::max(left.boundSteps, right.boundSteps);
        const mesh::Lattice& lattice = work.spool.lattice;
        lod.geometry.resize(1);
        lod.normalErrors.resize(1);
        lod.errorMetres = {lattice.errorMetres() + bound * lattice.stepMetres};
        lod.colourReachMetres = {std::max(left.reachMetres, right.reachMetres)};
        written.surface.isEndless = true;
        written.surface.boundSteps = bound;
        written.surface.reachMetres = lod.colourReachMetres[0];
        written.surface.boxMin = tree.nodes[0].boxMin;
        written.surface.boxMax = tree.nodes[0].boxMax;
        written.surface.lod.height = std::max(left.lod.height, right.lod.height);
    } else {
        std::vector<std::uint32_t> ofLeft, ofRight;
        both = merged(left, right, ofLeft, ofRight);
        appendTriangles(both, left.lod, ofLeft);
        appendTriangles(both, right.lod, ofRight);
        const std::vector<std::uint32_t> goesOnAt =
            sharedOutside(both.sharedBy, node.firstPart, node.lastPart);
        options.goesOnAt = goesOnAt;
        mesh::LodParts parts;
        parts.leaves = {{}, std::move(left.lod), std::move(right.lod)};
        left = right = {};  // memory that is needed now
        ASSIGN_OR_RETURN(lod,
                         mesh::buildLodTree(both.mesh, tree, options, {}, control.stop, &parts));
        written.levels = lod.levels;
        written.pointNodes = lod.pointNodes();
        written.surface = surfaceOf(both, std::move(parts.root), lod.colourReachMetres[0],
                                    tree.nodes[0], options);
    }
    written.surface.pockets = pockets;
    written.errorMetres = lod.errorMetres[0];
    written.nodes = 1;
    // Of the node alone: its own triangles, as a leaf has them.
    both.mesh.triangles = std::move(lod.geometry[0]);
    tree.nodes.resize(1);
    tree.nodes[0] = {tree.nodes[0].boxMin,      tree.nodes[0].boxMax, -1, -1, 0,
                     both.mesh.triangles.size()};
    tree.order.resize(both.mesh.triangles.size());
    std::iota(tree.order.begin(), tree.order.end(), 0U);
    lod.geometry = {{}};
    lod.points.resize(1);
    lod.errorMetres.resize(1);
    lod.colourReachMetres.resize(1);
    lod.normalErrors.resize(1);
    ASSIGN_OR_RETURN(written.offset,
                     appendEym(work, both.mesh, tree, lod, {{pockets}, {}}, control.stop));
    return written;
}

}  // namespace eyrie::import
