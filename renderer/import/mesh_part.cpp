// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_part.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>
#include <glm/common.hpp>

#include "renderer/import/mesh_reader.h"
#include "renderer/mesh/eym_writer.h"
#include "renderer/mesh/kd_tree.h"

namespace eyrie::import {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Some of a source's vertices, numbered anew in their order.
class Chosen {
public:
    explicit Chosen(std::uint64_t vertices) : bits_(vertices / 64 + 1, 0) {}

    void add(std::uint32_t vertex) { bits_[vertex / 64] |= bitOf(vertex); }
    /// Before numbers are asked for.
    void number() {
        for (const std::uint64_t word : bits_) {
            before_.push_back(count_);
            count_ += static_cast<std::uint32_t>(std::popcount(word));
        }
    }
    std::uint32_t numberOf(std::uint32_t vertex) const {
        return before_[vertex / 64] +
               static_cast<std::uint32_t>(std::popcount(bits_[vertex / 64] & (bitOf(vertex) - 1)));
    }
    std::uint32_t count() const { return count_; }

    /// Their rows, in order.
    template <typename Row>
    absl::Status gather(const RowFile<Row>& file, std::vector<Row>& rows) const {
        RowCache<Row> blocks(file, 1);
        rows.reserve(count_);
        for (std::size_t word = 0; word < bits_.size(); ++word)
            for (std::uint64_t left = bits_[word]; left != 0; left &= left - 1) {
                ASSIGN_OR_RETURN(
                    const Row* const row,
                    blocks.at(word * 64 + static_cast<std::size_t>(std::countr_zero(left))));
                rows.push_back(*row);
            }
        return absl::OkStatus();
    }

private:
    static std::uint64_t bitOf(std::uint32_t vertex) { return std::uint64_t{1} << vertex % 64; }

    std::vector<std::uint64_t> bits_;
    std::vector<std::uint32_t> before_;  ///< a word
    std::uint32_t count_ = 0;
};

/// A part's triangles and its guests, in the order of their numbers.
struct Gathered {
    std::vector<std::uint32_t> numbers;
    std::vector<std::uint32_t> owners;
    TriangleMesh mesh;
};

absl::StatusOr<std::vector<Guest>> trianglesOf(const PartWork& work, std::uint32_t part) {
    const SplitNode& node = work.split.part(part);
    ASSIGN_OR_RETURN(std::vector<Guest> all, work.sharing.guests.read(part));
    const std::size_t guests = all.size();
    all.reserve(guests + node.end - node.begin);
    RETURN_IF_ERROR(work.split.triangles[node.file].forBlocks(
        node.begin, node.end, [&](std::span<const SpooledTriangle> block) {
            for (const SpooledTriangle& row : block) all.push_back({row, part, part});
            return absl::OkStatus();
        }));
    const auto isBefore = [](const Guest& a, const Guest& b) {
        return a.triangle.number < b.triangle.number;
    };
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(guests);
    std::sort(all.begin(), middle, isBefore);
    std::inplace_merge(all.begin(), middle, all.end(), isBefore);
    return all;
}

absl::StatusOr<Gathered> gather(const PartWork& work, std::uint32_t part) {
    ASSIGN_OR_RETURN(const std::vector<Guest> all, trianglesOf(work, part));
    Chosen chosen(work.spool.vertexCount);
    for (const Guest& guest : all)
        for (const std::uint32_t vertex : guest.triangle.vertices) chosen.add(vertex);
    chosen.number();
    Gathered gathered;
    gathered.numbers.reserve(all.size());
    gathered.owners.reserve(all.size());
    gathered.mesh.triangles.reserve(all.size());
    for (const Guest& guest : all) {
        gathered.numbers.push_back(guest.triangle.number);
        gathered.owners.push_back(guest.owner);
        mesh::Triangle corners = guest.triangle.vertices;
        for (std::uint32_t& corner : corners) corner = chosen.numberOf(corner);
        gathered.mesh.triangles.push_back(corners);
    }
    RETURN_IF_ERROR(chosen.gather(work.spool.positions, gathered.mesh.positions));
    if (work.spool.hasNormals)
        RETURN_IF_ERROR(chosen.gather(work.spool.normals, gathered.mesh.normals));
    if (work.spool.hasColours)
        RETURN_IF_ERROR(chosen.gather(work.spool.colours, gathered.mesh.colours));
    for (fabric::Rgba& colour : gathered.mesh.colours) colour = againstPlain(colour);
    return gathered;
}

template <typename T>
std::vector<T> chosenOf(const std::vector<T>& from, const std::vector<std::uint32_t>& vertices) {
    std::vector<T> to;
    if (!from.empty())
        for (const std::uint32_t vertex : vertices) to.push_back(from[vertex]);
    return to;
}

/// The vertices of a mesh that `triangles` use, ascending, and `triangles` numbered by them.
std::vector<std::uint32_t> compact(std::size_t vertexCount,
                                   std::vector<mesh::Triangle>& triangles) {
    std::vector<std::uint32_t> numberOf(vertexCount, kNone);
    for (const mesh::Triangle& triangle : triangles)
        for (const std::uint32_t corner : triangle) numberOf[corner] = 0;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t i = 0; i < vertexCount; ++i)
        if (numberOf[i] != kNone) {
            numberOf[i] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(i);
        }
    for (mesh::Triangle& triangle : triangles)
        for (std::uint32_t& corner : triangle) corner = numberOf[corner];
    return vertices;
}

mesh::PackedMesh withVertices(const mesh::PackedMesh& mesh,
                              const std::vector<std::uint32_t>& vertices) {
    mesh::PackedMesh chosen;
    chosen.lattice = mesh.lattice;
    chosen.positions = chosenOf(mesh.positions, vertices);
    chosen.normals = chosenOf(mesh.normals, vertices);
    chosen.colours = chosenOf(mesh.colours, vertices);
    chosen.exact = chosenOf(mesh.exact, vertices);
    return chosen;
}

/// A part on the lattice, without its guests.
struct OwnMesh {
    mesh::PackedMesh mesh;
    std::vector<std::uint64_t> firstUse;                 ///< as PartSurface has it
    std::vector<std::array<std::uint32_t, 2>> sharedBy;  ///< the same
    std::uint64_t newVertices = 0;                       ///< that are in no part before it
    bool computedNormals = false;
    std::vector<bool> isBehind;  ///< of its triangles, where that is known
};

/// Three times the number of the first triangle that uses a vertex, and its corner there; and
/// whether a part before `part` does.
void findFirstUses(const std::vector<mesh::Triangle>& triangles, const Gathered& gathered,
                   std::uint32_t part, std::vector<std::uint64_t>& firstUse,
                   std::vector<bool>& isOld) {
    constexpr auto kUnused = std::numeric_limits<std::uint64_t>::max();
    std::fill(firstUse.begin(), firstUse.end(), kUnused);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangles[i][corner];
            if (firstUse[vertex] == kUnused)
                firstUse[vertex] = 3 * std::uint64_t{gathered.numbers[i]} + corner;
            if (gathered.owners[i] < part)
                isOld[vertex] = true;
        }
}

std::vector<std::array<std::uint32_t, 2>> sharersOf(const std::vector<std::uint64_t>& positions,
                                                    const std::vector<SharedPoint>& points,
                                                    std::uint32_t part) {
    std::unordered_map<std::uint64_t, std::array<std::uint32_t, 2>> shared;
    for (const SharedPoint& point : points) {
        auto& range = shared.try_emplace(point.position, std::array{part, part}).first->second;
        range = {std::min(range[0], point.other), std::max(range[1], point.other)};
    }
    std::vector<std::array<std::uint32_t, 2>> sharers;
    sharers.reserve(positions.size());
    for (const std::uint64_t position : positions) {
        const auto found = shared.find(position);
        sharers.push_back(found == shared.end() ? std::array{part, part} : found->second);
    }
    return sharers;
}

absl::StatusOr<OwnMesh> packOwn(const PartWork& work, std::uint32_t part,
                                const ImportControl& control) {
    ASSIGN_OR_RETURN(Gathered gathered, gather(work, part));
    PackOptions options = work.options.pack;
    options.lattice = work.spool.lattice;
    PackCounts counts;
    ASSIGN_OR_RETURN(mesh::PackedMesh all,
                     packMesh(std::move(gathered.mesh), counts, options, {{}, control.stop}));
    if (all.triangles.size() != gathered.numbers.size())
        return absl::InternalError("a part of the mesh lost triangles that it should have");
    OwnMesh own;
    own.computedNormals = counts.normalsComputed;
    std::vector<std::uint64_t> firstUse(all.positions.size());
    std::vector<bool> isOld(all.positions.size(), false);
    findFirstUses(all.triangles, gathered, part, firstUse, isOld);
    std::vector<mesh::Triangle> triangles;
    triangles.reserve(all.triangles.size());
    for (std::size_t i = 0; i < all.triangles.size(); ++i)
        if (gathered.owners[i] == part) {
            triangles.push_back(all.triangles[i]);
            if (work.isBehind)
                own.isBehind.push_back((*work.isBehind)[gathered.numbers[i]]);
        }
    const std::vector<std::uint32_t> vertices = compact(all.positions.size(), triangles);
    own.mesh = withVertices(all, vertices);
    own.mesh.triangles = std::move(triangles);
    own.firstUse = chosenOf(firstUse, vertices);
    own.newVertices = static_cast<std::uint64_t>(std::count_if(
        vertices.begin(), vertices.end(), [&](std::uint32_t vertex) { return !isOld[vertex]; }));
    ASSIGN_OR_RETURN(const std::vector<SharedPoint> points, work.sharing.points.read(part));
    own.sharedBy = sharersOf(own.mesh.positions, points, part);
    return own;
}

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
PartSurface surfaceOf(const OwnMesh& own, mesh::LodPart lod, const mesh::KdNode& box,
                      const mesh::LodOptions& options) {
    PartSurface surface;
    surface.boxMin = box.boxMin;
    surface.boxMax = box.boxMax;
    surface.boundSteps = lod.patch.error();
    surface.lod.height = lod.height;
    surface.mesh.lattice = own.mesh.lattice;
    surface.isEndless =
        lod.patch.triangles.size() > mesh::kMostUnsimplified * options.nodeTriangles;
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
OwnMesh merged(const PartSurface& left, const PartSurface& right, std::vector<std::uint32_t>& a,
               std::vector<std::uint32_t>& b) {
    OwnMesh both;
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
void appendTriangles(OwnMesh& both, mesh::LodPart& lod, const std::vector<std::uint32_t>& numbers) {
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
    ASSIGN_OR_RETURN(const OwnMesh own, packOwn(work, part, control));
    ASSIGN_OR_RETURN(const mesh::KdTree tree,
                     mesh::buildKdTree(own.mesh.positions, own.mesh.triangles,
                                       {work.options.leafTriangles}, control.stop));
    const std::vector<std::uint32_t> goesOnAt = sharedOutside(own.sharedBy, part, part);
    const mesh::LodOptions options{.goesOnAt = goesOnAt};
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
    written.errorMetres = lod.errorMetres.front();
    written.surface = surfaceOf(own, std::move(parts.root), tree.nodes.front(), options);
    written.surface.pockets = backs.pockets.front();
    return written;
}

absl::StatusOr<WrittenPart> writeAbove(const PartWork& work, const SplitNode& node,
                                       PartSurface left, PartSurface right,
                                       const ImportControl& control) {
    std::vector<std::uint32_t> ofLeft, ofRight;
    OwnMesh both = merged(left, right, ofLeft, ofRight);
    appendTriangles(both, left.lod, ofLeft);
    appendTriangles(both, right.lod, ofRight);
    mesh::KdTree tree = treeOver(left, right);
    const std::vector<std::uint32_t> goesOnAt =
        sharedOutside(both.sharedBy, node.firstPart, node.lastPart);
    const mesh::LodOptions options{.goesOnAt = goesOnAt};
    WrittenPart written;
    mesh::LodTree lod;
    if (left.isEndless || right.isEndless) {
        const double bound = std::max(left.boundSteps, right.boundSteps);
        const mesh::Lattice& lattice = work.spool.lattice;
        lod.geometry.resize(1);
        lod.errorMetres = {lattice.errorMetres() + bound * lattice.stepMetres};
        written.surface.isEndless = true;
        written.surface.boundSteps = bound;
        written.surface.boxMin = tree.nodes[0].boxMin;
        written.surface.boxMax = tree.nodes[0].boxMax;
        written.surface.lod.height = std::max(left.lod.height, right.lod.height);
    } else {
        mesh::LodParts parts;
        parts.leaves = {{}, std::move(left.lod), std::move(right.lod)};
        ASSIGN_OR_RETURN(lod,
                         mesh::buildLodTree(both.mesh, tree, options, {}, control.stop, &parts));
        written.levels = lod.levels;
        written.surface = surfaceOf(both, std::move(parts.root), tree.nodes[0], options);
    }
    written.surface.pockets.add(left.pockets);
    written.surface.pockets.add(right.pockets);
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
    lod.errorMetres.resize(1);
    ASSIGN_OR_RETURN(written.offset, appendEym(work, both.mesh, tree, lod,
                                               {{written.surface.pockets}, {}}, control.stop));
    return written;
}

}  // namespace eyrie::import
