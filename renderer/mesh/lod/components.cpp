// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/components.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderer/mesh/lod/closing_pieces.h"
#include "renderer/mesh/lod/piece_points.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Share of the patch's longest side: what has no neighbour as near stays.
constexpr double kReach = 1.0 / 16;

class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// A patch taken apart, from which pieces go.
class Dropper {
public:
    Dropper(const PackedMesh& mesh, const Components& components, const KdNode& node, Patch& patch)
        : mesh_(mesh), patch_(patch) {
        gather(components, node);
        std::vector<PiecePoint> all = points();
        glm::dvec3 low(kInfinity);
        glm::dvec3 high(-kInfinity);
        for (const PiecePoint& point : all) {
            low = glm::min(low, point.position);
            high = glm::max(high, point.position);
        }
        reach_ = kReach * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
        there_.emplace(std::move(all));
    }

    void run(std::size_t target, double limitSteps);

private:
    struct Piece {
        std::vector<std::uint32_t> triangles;
        bool mayGo = false;
        std::uint64_t least = std::numeric_limits<std::uint64_t>::max();  ///< position, as packed
    };
    struct Way {
        double bound = kInfinity;
        std::uint32_t piece = kNone;
        std::uint32_t receiver = kNone;  ///< a triangle
        /// Ties go by the piece: the result is the same everywhere.
        bool operator<(const Way& other) const {
            return bound != other.bound ? bound > other.bound : piece > other.piece;
        }
    };

    void gather(const Components& components, const KdNode& node);
    std::vector<PiecePoint> points() const;
    Way wayOf(std::uint32_t piece) const;
    glm::dvec3 position(std::uint32_t vertex) const {
        return glm::dvec3(unpackPosition(mesh_.positions[vertex]));
    }

    const PackedMesh& mesh_;
    Patch& patch_;
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> pieceOf_;  ///< of a triangle
    std::vector<bool> isThere_;           ///< of a piece
    std::optional<PiecePoints> there_;
    double reach_ = 0;  ///< steps
};

/// Pieces by their least positions, which is the same whatever else there is in the mesh.
void Dropper::gather(const Components& components, const KdNode& node) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> byComponent;
    for (std::uint32_t i = 0; i < patch_.triangles.size(); ++i)
        byComponent.emplace_back(components.of(patch_.triangles[i][0]), i);
    std::sort(byComponent.begin(), byComponent.end());
    for (std::size_t i = 0; i < byComponent.size(); ++i) {
        const auto [component, triangle] = byComponent[i];
        if (i == 0 || component != byComponent[i - 1].first)
            pieces_.push_back({.triangles = {}, .mayGo = components.mayGo(component, node)});
        Piece& piece = pieces_.back();
        piece.triangles.push_back(triangle);
        for (const std::uint32_t vertex : patch_.triangles[triangle])
            piece.least = std::min(piece.least, mesh_.positions[vertex]);
    }
    std::sort(pieces_.begin(), pieces_.end(),
              [](const Piece& a, const Piece& b) { return a.least < b.least; });
    pieceOf_.resize(byComponent.size());
    for (std::uint32_t i = 0; i < pieces_.size(); ++i)
        for (const std::uint32_t triangle : pieces_[i].triangles) pieceOf_[triangle] = i;
    isThere_.assign(pieces_.size(), true);
}

/// Each vertex once.
std::vector<PiecePoint> Dropper::points() const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> corners;
    for (std::uint32_t i = 0; i < patch_.triangles.size(); ++i)
        for (const std::uint32_t vertex : patch_.triangles[i]) corners.emplace_back(vertex, i);
    std::sort(corners.begin(), corners.end());
    std::vector<PiecePoint> result;
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (i == 0 || corners[i].first != corners[i - 1].first)
            result.push_back(
                {position(corners[i].first), pieceOf_[corners[i].second], corners[i].second});
    return result;
}

Dropper::Way Dropper::wayOf(std::uint32_t index) const {
    const Piece& piece = pieces_[index];
    glm::dvec3 sum(0.0);
    double before = 0;
    for (const std::uint32_t triangle : piece.triangles) {
        for (const std::uint32_t vertex : patch_.triangles[triangle]) sum += position(vertex);
        before = std::max(before, double{patch_.shifts[triangle].longest()});
    }
    const PiecePoint* to =
        there_->nearest(sum / (3.0 * static_cast<double>(piece.triangles.size())), index, reach_);
    if (to == nullptr)
        return {};
    double farthest = 0;  // of a triangle's points a corner is the farthest
    for (const std::uint32_t triangle : piece.triangles)
        for (const std::uint32_t vertex : patch_.triangles[triangle])
            farthest = std::max(farthest, glm::distance(position(vertex), to->position));
    return {before + farthest, index, to->triangle};
}

void Dropper::run(std::size_t target, double limitSteps) {
    std::priority_queue<Way> queue;
    const auto look = [&](std::uint32_t piece) {
        if (const Way way = wayOf(piece); way.piece != kNone && way.bound <= limitSteps)
            queue.push(way);
    };
    for (std::uint32_t i = 0; i < pieces_.size(); ++i)
        if (pieces_[i].mayGo)
            look(i);
    std::size_t left = patch_.triangles.size();
    while (left > target && !queue.empty()) {
        const Way way = queue.top();
        queue.pop();
        const Way now = wayOf(way.piece);
        if (now.bound != way.bound || now.receiver != way.receiver) {
            if (now.piece != kNone && now.bound <= limitSteps)
                queue.push(now);
            continue;
        }
        isThere_[way.piece] = false;
        there_->remove(way.piece);
        left -= pieces_[way.piece].triangles.size();
        patch_.shifts[way.receiver].hold(Shifts().andThen(static_cast<float>(way.bound)));
    }
    const auto keepThose = [&](auto& ofTriangles) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < ofTriangles.size(); ++i)
            if (isThere_[pieceOf_[i]])
                ofTriangles[kept++] = ofTriangles[i];
        ofTriangles.resize(kept);
    };
    keepThose(patch_.triangles);
    keepThose(patch_.shifts);
    keepThose(patch_.tints);
    keepThose(patch_.normals);
}

}  // namespace

Components::Components(const PackedMesh& mesh, const KdTree& tree, const SheetEnds& ends,
                       std::span<const std::uint32_t> goesOnAt) {
    DisjointSets sets(mesh.positions.size());
    std::vector<std::uint32_t> byPosition(mesh.positions.size());
    std::iota(byPosition.begin(), byPosition.end(), 0U);
    // By one thread: one that helped others meanwhile could come to wait for what it makes here.
    std::sort(byPosition.begin(), byPosition.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(mesh.positions[a], a) < std::pair(mesh.positions[b], b);
    });
    for (std::size_t i = 1; i < byPosition.size(); ++i)
        if (mesh.positions[byPosition[i]] == mesh.positions[byPosition[i - 1]])
            sets.join(byPosition[i], byPosition[i - 1]);
    for (const Triangle& triangle : mesh.triangles) {
        sets.join(triangle[0], triangle[1]);
        sets.join(triangle[0], triangle[2]);
    }
    ofVertex_.resize(mesh.positions.size());
    for (std::uint32_t i = 0; i < ofVertex_.size(); ++i) {
        const std::uint32_t root = sets.find(i);  // never after i, so it has its number
        if (root == i) {
            ofVertex_[i] = static_cast<std::uint32_t>(first_.size());
            first_.push_back(std::numeric_limits<std::uint64_t>::max());
        } else {
            ofVertex_[i] = ofVertex_[root];
        }
    }
    last_.assign(first_.size(), 0);
    for (std::uint64_t i = 0; i < tree.order.size(); ++i) {
        const std::uint32_t component = of(mesh.triangles[tree.order[i]][0]);
        first_[component] = std::min(first_[component], i);
        last_[component] = i;
    }
    for (const std::uint32_t vertex : goesOnAt)
        last_[of(vertex)] = std::numeric_limits<std::uint64_t>::max();
    isClosing_ = closingPieces(mesh, ends, ofVertex_, count());
}

void dropComponents(const PackedMesh& mesh, const Components& components, const KdNode& node,
                    std::size_t target, double limitSteps, Patch& patch) {
    if (patch.triangles.size() > target && components.count() > 1)
        Dropper(mesh, components, node, patch).run(target, limitSteps);
}

}  // namespace eyrie::mesh
