// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/lod_tree.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include <absl/status/status.h>
#include <glm/geometric.hpp>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#include "renderer/mesh/lod/components.h"
#include "renderer/mesh/lod/patch_colours.h"
#include "renderer/mesh/lod/patch_normals.h"
#include "renderer/mesh/lod/shared_points.h"
#include "renderer/mesh/lod/sheet_ends.h"
#include "renderer/mesh/lod/simplify.h"

namespace eyrie::mesh {
namespace {

/// What a node is drawn by has to be this much less than what its children are drawn by.
constexpr double kWorthwhile = 0.8;
/// Of the diagonal of a node's box: pieces whose loss makes no larger an error go before surfaces
/// are simplified. A node that is drawn as large as the picture shows it as some pixels.
constexpr double kSmallPiece = 1.0 / 256;
/// Of the same: a larger error shows that what had to give way should not have.
constexpr double kTooFar = 1.0 / 32;
/// Points are drawn where they are at most half a pixel apart, triangles up to tau: a sample is the
/// better if its error is this part of the triangles'.
constexpr double kWorthPoints = 0.5;

/// Seams give a point several vertices, so a surface may have more of them than triangles.
bool hasMoreVerticesThan(std::size_t most, const std::vector<Triangle>& triangles) {
    if (triangles.size() * 3 <= most)
        return false;
    std::vector<std::uint32_t> vertices;
    vertices.reserve(triangles.size() * 3);
    for (const Triangle& triangle : triangles)
        vertices.insert(vertices.end(), triangle.begin(), triangle.end());
    std::sort(vertices.begin(), vertices.end());
    const auto end = std::unique(vertices.begin(), vertices.end());
    return static_cast<std::size_t>(end - vertices.begin()) > most;
}

template <typename T>
void appendAll(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// All triangles of both; of more than `mostSampled` without normals.
void append(const PackedMesh& mesh, std::size_t mostSampled, Patch& to, Patch from) {
    if (to.tints.empty() != from.tints.empty()) {
        to.tints = tintsOf(mesh, to);
        from.tints = tintsOf(mesh, from);
    }
    if (to.triangles.size() + from.triangles.size() > mostSampled) {
        to.normals = {};  // memory that nothing comes of
        from.normals = {};
    } else if (to.normals.empty() != from.normals.empty()) {
        to.normals = normalChangesOf(mesh, to);
        from.normals = normalChangesOf(mesh, from);
    }
    appendAll(to.triangles, from.triangles);
    appendAll(to.shifts, from.shifts);
    appendAll(to.tints, from.tints);
    appendAll(to.normals, from.normals);
}

class Builder {
public:
    Builder(const PackedMesh& mesh, const KdTree& tree, const LodOptions& options,
            const std::function<void(double)>& progress, const std::stop_token& stop,
            LodParts* parts)
        : mesh_(mesh),
          tree_(tree),
          options_(options),
          progress_(progress),
          stop_(stop),
          parts_(parts),
          colours_(mesh),
          staying_(whereOthersEnd(mesh, SheetEnds(mesh, options.goesOnAt))),
          sharedFrom_(sharedFrom(mesh, tree, options.goesOnAt)) {
        lod_.geometry.resize(tree.nodes.size());
        lod_.points.resize(tree.nodes.size());
        lod_.normalErrors.resize(tree.nodes.size());
        errorSteps_.resize(tree.nodes.size());
        reachSteps_.resize(tree.nodes.size());
    }

    LodTree build();

private:
    LodPart visit(std::size_t index, std::size_t depth);
    LodPart finest(std::size_t index) const;
    const Components& components();
    Simplified simplified(const Patch& patch, const KdNode& node, std::size_t depth,
                          std::size_t target);
    std::optional<Simplified> simplifiedOrNothing(const LodPart& part, const KdNode& node,
                                                  std::size_t depth);
    LodLevel& level(std::size_t height);
    void standFor(LodPart& part, std::size_t index, std::size_t depth);
    void record(const LodPart& part, std::size_t before, const NormalError& normals);
    double reachMetres(double steps) const;

    const PackedMesh& mesh_;
    const KdTree& tree_;
    const LodOptions& options_;
    const std::function<void(double)>& progress_;
    const std::stop_token& stop_;
    LodParts* parts_;
    const SurfaceColours colours_;
    const std::vector<std::uint8_t> staying_;     ///< of a vertex
    const std::vector<std::uint8_t> sharedFrom_;  ///< of a vertex
    LodTree lod_;
    std::vector<double> errorSteps_;
    std::vector<double> reachSteps_;
    std::once_flag componentsMade_;
    std::optional<Components> components_;
    std::mutex mutex_;  ///< of lod_.levels and done_
    std::uint64_t done_ = 0;
};

LodPart Builder::finest(std::size_t index) const {
    const KdNode& node = tree_.nodes[index];
    LodPart part;
    part.patch.triangles.reserve(node.triangleEnd - node.triangleBegin);
    for (std::uint64_t i = node.triangleBegin; i < node.triangleEnd; ++i)
        part.patch.triangles.push_back(mesh_.triangles[tree_.order[i]]);
    part.patch.shifts.resize(part.patch.triangles.size());
    return part;
}

LodPart Builder::visit(std::size_t index, std::size_t depth) {
    const KdNode& node = tree_.nodes[index];
    if (stop_.stop_requested())
        return {};
    const bool isOverParts = parts_ != nullptr && !parts_->leaves.empty();
    if (node.isLeaf() && isOverParts)
        return std::move(parts_->leaves[index]);
    // Over parts there are more triangles of the source than are counted here.
    if (node.isLeaf() ||
        (!isOverParts && node.triangleEnd - node.triangleBegin <= options_.nodeTriangles))
        return finest(index);
    LodPart left, right;
    oneapi::tbb::parallel_invoke(
        [&] { left = visit(static_cast<std::size_t>(node.left), depth + 1); },
        [&] { right = visit(static_cast<std::size_t>(node.right), depth + 1); });
    if (stop_.stop_requested())
        return {};
    append(mesh_, options_.mostSampled, left.patch, std::move(right.patch));
    left.height = std::max(left.height, right.height);
    left.errorSteps = std::max(left.errorSteps, right.errorSteps);
    left.reachSteps = std::max(left.reachSteps, right.reachSteps);
    standFor(left, index, depth);
    return left;
}

/// Only what surfaces of one piece do not need. Where sheets end is found once more: of a soup that
/// is more than could be kept. Whoever makes them helps nobody else while others help: what it took
/// on meanwhile could come to wait for what it makes here.
const Components& Builder::components() {
    std::call_once(componentsMade_, [this] {
        oneapi::tbb::this_task_arena::isolate([this] {
            components_.emplace(mesh_, tree_, SheetEnds(mesh_, options_.goesOnAt),
                                options_.goesOnAt);
        });
    });
    return *components_;
}

/// The node's surface with about `target` triangles: simplified, or, where that leaves too many or
/// goes too far, without its smallest pieces first.
Simplified Builder::simplified(const Patch& patch, const KdNode& node, std::size_t depth,
                               std::size_t target) {
    const Staying staying{staying_, sharedFrom_, depth};
    const double diagonal = glm::length(glm::dvec3(node.boxMax) - glm::dvec3(node.boxMin));
    Simplified plain = simplify(mesh_, patch, target, staying);
    const double error = plain.patch.error();
    if ((plain.isDone() && error <= kTooFar * diagonal) || components().count() == 1)
        return plain;
    Patch fewer = patch;
    dropComponents(mesh_, components(), node, target, kSmallPiece * diagonal, fewer);
    Simplified sparse = simplify(mesh_, fewer, target, staying);
    dropComponents(mesh_, components(), node, sparse.target,
                   std::numeric_limits<double>::infinity(), sparse.patch);
    const bool areBothDone = plain.isDone() && sparse.isDone();
    const bool isSparseBetter = areBothDone
                                    ? sparse.patch.error() < error
                                    : sparse.patch.triangles.size() < plain.patch.triangles.size();
    sparse.points = plain.points;
    return isSparseBetter ? sparse : plain;
}

/// Nothing where that does not pay.
std::optional<Simplified> Builder::simplifiedOrNothing(const LodPart& part, const KdNode& node,
                                                       std::size_t depth) {
    const std::size_t before = part.patch.triangles.size();
    if (before > options_.mostUnsimplified())
        return std::nullopt;
    Simplified result = simplified(part.patch, node, depth,
                                   std::min<std::size_t>(before / 2, options_.nodeTriangles));
    {
        const std::lock_guard lock(mutex_);
        level(part.height + 1).points += result.points;
    }
    const std::vector<Triangle>& triangles = result.patch.triangles;
    if (triangles.size() > kMaxNodeTriangles || hasMoreVerticesThan(kMaxLeafVertices, triangles) ||
        static_cast<double>(triangles.size()) > kWorthwhile * static_cast<double>(before))
        return std::nullopt;
    return result;
}

/// Finds what is drawn for a node: fewer triangles, which then stand for it further up; or points,
/// where there are none, or worse ones; or neither, and the node is drawn by its children. Without
/// triangles of its own the part stays as it is.
void Builder::standFor(LodPart& part, std::size_t index, std::size_t depth) {
    const KdNode& node = tree_.nodes[index];
    std::optional<Simplified> fewer = simplifiedOrNothing(part, node, depth);
    const std::size_t before = part.patch.triangles.size();
    const double diagonal = glm::length(glm::dvec3(node.boxMax) - glm::dvec3(node.boxMin));
    const bool mayBeBetter = !fewer || fewer->patch.error() > kSmallPiece * diagonal;
    if (before >= options_.sampledTriangles && before <= options_.mostSampled && mayBeBetter)
        lod_.points[index] = samplePoints(
            mesh_, part.patch, colours_, options_.nodePoints,
            fewer ? kWorthPoints * fewer->patch.error() : std::numeric_limits<double>::infinity());
    if (lod_.points[index]) {
        part.errorSteps = std::max(part.errorSteps, lod_.points[index]->errorSteps());
        lod_.normalErrors[index] = sampledNormalError(mesh_, part.patch);
    } else if (fewer) {
        part.patch = std::move(fewer->patch);
        ++part.height;
        lod_.geometry[index] = part.patch.triangles;
        lod_.normalErrors[index] = normalError(mesh_, part.patch);
        record(part, before, lod_.normalErrors[index]);
    }
    part.errorSteps = std::max(part.errorSteps, part.patch.error());
    part.reachSteps = std::max(part.reachSteps, colourReach(mesh_, part.patch));
    errorSteps_[index] = part.errorSteps;
    reachSteps_[index] = part.reachSteps;
}

/// Under the lock. The finest has height 1.
LodLevel& Builder::level(std::size_t height) {
    if (lod_.levels.size() < height)
        lod_.levels.resize(height);
    return lod_.levels[height - 1];
}

void Builder::record(const LodPart& part, std::size_t before, const NormalError& normals) {
    const std::lock_guard lock(mutex_);
    LodLevel& level = this->level(part.height);
    ++level.nodes;
    level.trianglesBefore += before;
    level.trianglesAfter += part.patch.triangles.size();
    const double errorSteps = part.patch.error();
    level.largestErrorMetres =
        std::max(level.largestErrorMetres, errorSteps * mesh_.lattice.stepMetres);
    level.largestReachMetres =
        std::max(level.largestReachMetres, reachMetres(colourReach(mesh_, part.patch)));
    level.normals.hold(normals);
    done_ += before;
    // Each level has about half the triangles of the one below: two thirds of a mesh's in all.
    if (progress_)
        progress_(std::min(
            1.0, static_cast<double>(done_) / (2.0 * static_cast<double>(mesh_.triangles.size()))));
}

/// What reading and the lattice round included, of the source's vertices and of points on
/// triangles.
double Builder::reachMetres(double steps) const {
    return steps > 0 ? 2 * mesh_.errorMetres() + steps * mesh_.lattice.stepMetres : 0;
}

LodTree Builder::build() {
    if (!tree_.nodes.empty()) {
        LodPart root = visit(0, 0);
        if (parts_ != nullptr)
            parts_->root = std::move(root);
    }
    lod_.errorMetres.reserve(errorSteps_.size());
    for (const double steps : errorSteps_)
        lod_.errorMetres.push_back(mesh_.errorMetres() + steps * mesh_.lattice.stepMetres);
    for (const double steps : reachSteps_) lod_.colourReachMetres.push_back(reachMetres(steps));
    return std::move(lod_);
}

}  // namespace

absl::StatusOr<LodTree> buildLodTree(const PackedMesh& mesh, const KdTree& tree,
                                     const LodOptions& options,
                                     const std::function<void(double)>& progress,
                                     const std::stop_token& stop, LodParts* parts) {
    LodTree lod = Builder(mesh, tree, options, progress, stop, parts).build();
    if (stop.stop_requested())
        return absl::CancelledError("simplifying the mesh was cancelled");
    return lod;
}

}  // namespace eyrie::mesh
