// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/part_mesh.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>

#include <absl/status/status.h>

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

}  // namespace

absl::StatusOr<PartMesh> packPart(const PartWork& work, std::uint32_t part,
                                  const ImportControl& control) {
    ASSIGN_OR_RETURN(Gathered gathered, gather(work, part));
    PackOptions options = work.options.pack;
    options.lattice = work.spool.lattice;
    PackCounts counts;
    ASSIGN_OR_RETURN(mesh::PackedMesh all,
                     packMesh(std::move(gathered.mesh), counts, options, {{}, control.stop}));
    if (all.triangles.size() != gathered.numbers.size())
        return absl::InternalError("a part of the mesh lost triangles that it should have");
    PartMesh own;
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

}  // namespace eyrie::import
