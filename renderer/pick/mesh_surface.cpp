// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/frustum.h"
#include "fabric/status.h"
#include "renderer/lod/view.h"
#include "renderer/mesh/vertex_packing.h"
#include "renderer/pick/line_triangle.h"

namespace eyrie::pick {
namespace {

using fabric::Vec3;

/// A leaf's page or pages.
struct Leaf {
    mesh::NodeGeometry geometry;
    std::vector<Vec3> exact;  ///< the source's own positions; empty where the file has none

    std::uint64_t bytes() const { return geometry.block.size() + exact.size() * sizeof(Vec3); }
};

/// What is the same for a run of a leaf's triangles.
struct Run {
    std::size_t end = 0;  ///< of its indices
    bool hasBacks = true;
    bool isSeeThrough = false;
};

/// Like draw::MeshDrawable: from inside its bounds, or nearly, a surface is seen from behind.
bool isOutside(const mesh::EymFile& file, const Vec3& eye) {
    const fabric::Box bounds = file.bounds();
    return !bounds.grownBy(0.01 * glm::length(bounds.size())).contains(eye);
}

std::vector<Run> runsOf(const mesh::EymFile& file, std::uint32_t node, bool hidesBacks) {
    if (file.materials().empty())
        return {{file.nodes()[node].indexCount, !hidesBacks, false}};
    std::vector<Run> runs;
    std::size_t end = 0;
    for (const mesh::MaterialRange& range : file.ranges(node)) {
        const mesh::Material& material = file.materials()[range.material];
        const bool isHidden = hidesBacks && !material.isTwoSided() && !material.isSeeThrough();
        runs.push_back({end += range.indexCount, !isHidden && !material.isOneSided(),
                        material.isSeeThrough()});
    }
    return runs;
}

/// How far the positions that a file keeps are from those that its source states: what its error
/// has beside the lattice's, which it states to a float's precision, rounded up.
double readingErrorMetres(const mesh::EymFile& file) {
    const double lattice = file.lattice().errorMetres();
    const double beside = file.finestErrorMetres() - lattice;
    return beside > lattice / (1 << 23) ? beside : 0;
}

/// One ray's way through a mesh's tree. Everything in object space.
class Walk {
public:
    Walk(const mesh::EymFile& file, const Ray& ray, bool hidesBacks, const CastOptions& options)
        : file_(file),
          ray_(ray),
          frame_(ray.direction),
          hidesBacks_(hidesBacks),
          options_(options) {
        const fabric::Box bounds = file.bounds();
        const double coordinates =
            glm::length(ray.origin) + glm::length(bounds.min) + glm::length(bounds.max);
        rounding_ = 16 * std::numeric_limits<double>::epsilon() * coordinates;
        error_ = rounding_ +
                 (file.hasExactPositions() ? readingErrorMetres(file) : file.finestErrorMetres());
        reach_ = file.finestErrorMetres() + rounding_;
        farthest_ = options.farthest;
    }

    absl::Status go() { return visit(0); }

    double hit() const { return hit_; }
    const Vec3& normal() const { return normal_; }
    double error() const { return error_; }
    double nearest() const { return nearest_; }
    double farthest() const { return farthest_; }

private:
    Span ahead() const { return {tOfNear(), farthest_}; }
    static double tOfNear() { return fabric::kNearMetres; }

    Span spanIn(std::uint32_t node) const {
        return clip(ahead(), ray_, file_.bounds(node).grownBy(reach_));
    }

    absl::Status visit(std::uint32_t node) {
        if (spanIn(node).isEmpty())
            return absl::OkStatus();
        const mesh::Node& record = file_.nodes()[node];
        if (record.isLeaf())
            return record.indexCount == 0 ? absl::OkStatus() : visitLeaf(node);
        auto first = static_cast<std::uint32_t>(record.left);
        auto second = static_cast<std::uint32_t>(record.right);
        if (spanIn(second).begin < spanIn(first).begin)
            std::swap(first, second);
        RETURN_IF_ERROR(visit(first));
        return visit(second);
    }

    absl::Status visitLeaf(std::uint32_t node) {
        RETURN_IF_ERROR(checkDeadline(options_));
        ASSIGN_OR_RETURN(const auto leaf, readLeaf(node));
        place(*leaf);
        std::size_t at = 0;
        const auto indices = leaf->geometry.indices;
        for (const Run& run : runsOf(file_, node, hidesBacks_))
            for (; at + 2 < run.end && at + 2 < indices.size(); at += 3)
                visitTriangle(indices[at], indices[at + 1], indices[at + 2], run);
        return absl::OkStatus();
    }

    /// Vertices as seen from the ray's origin.
    void place(const Leaf& leaf) {
        points_.clear();
        seen_.clear();
        const mesh::Lattice& lattice = file_.lattice();
        const Vec3 origin = lattice.originMetres - ray_.origin;
        for (std::size_t n = 0; n < leaf.geometry.positions.size(); ++n) {
            const Vec3 point =
                leaf.exact.empty()
                    ? origin + Vec3(mesh::unpackPosition(leaf.geometry.positions[n])) *
                                   lattice.stepMetres
                    : leaf.exact[n] - ray_.origin;
            points_.push_back(point);
            seen_.push_back(frame_.seen(point));
        }
    }

    void visitTriangle(std::uint16_t a, std::uint16_t b, std::uint16_t c, const Run& run) {
        const SeenTriangle seen = {seen_[a], seen_[b], seen_[c]};
        if (!mayPass(seen, frame_.reach(reach_)))
            return;
        const Passage passage{{points_[a], points_[b], points_[c]}, ray_.direction};
        const Span near = within(passage, reach_, ahead());
        if (!near.isEmpty())
            nearest_ = std::min(nearest_, near.begin);
        const std::optional<double> t = meets(seen);
        const Vec3 normal = passage.normal();
        const double facing = glm::dot(normal, ray_.direction);
        if (!t || *t < tOfNear() || (!run.hasBacks && facing > 0))
            return;
        if (*t < hit_) {
            hit_ = *t;
            normal_ = normal;
        }
        // What the ray meets of the source's triangle lies in a plate around this one.
        const double beside = error_ * glm::length(normal) / std::abs(facing);
        if (!run.isSeeThrough && *t - beside >= tOfNear() && meetsAllNear(passage, error_))
            farthest_ = std::min(farthest_, *t + beside);
    }

    absl::StatusOr<std::shared_ptr<const Leaf>> readLeaf(std::uint32_t node) {
        const RecentPages::Key key{options_.object, node};
        if (auto known = options_.pages.find(key))
            return std::static_pointer_cast<const Leaf>(known);
        auto leaf = std::make_shared<Leaf>();
        ASSIGN_OR_RETURN(leaf->geometry, file_.geometry(node));
        if (file_.hasExactPositions()) {
            ASSIGN_OR_RETURN(leaf->exact, file_.exactPositions(node));
        }
        options_.pages.keep(key, leaf, leaf->bytes());
        return leaf;
    }

    const mesh::EymFile& file_;
    const Ray ray_;
    const RayFrame frame_;
    const bool hidesBacks_;
    const CastOptions& options_;
    double rounding_ = 0;
    double error_ = 0;  ///< how far the source is from a point of a triangle
    /// How far all of the source may be from them: it has triangles that vanish on the lattice, and
    /// are left out also where the others keep their places.
    double reach_ = 0;
    std::vector<Vec3> points_;
    std::vector<Vec3> seen_;
    double hit_ = kNowhere;
    Vec3 normal_{0, 0, 1};
    double nearest_ = kNowhere;
    double farthest_ = kNowhere;
};

class MeshSurface final : public Surface {
public:
    MeshSurface(const fabric::SceneObject& object, std::shared_ptr<const mesh::EymFile> file)
        : worldFromObject_(object.worldFromObject),
          isSingleSided_(object.singleSided),
          file_(std::move(file)) {}

    absl::StatusOr<Cast> cast(const Ray& world, const CastOptions& options) const override {
        const Ray ray = inFrame(world, worldFromObject_);
        Walk walk(*file_, ray, isSingleSided_ && isOutside(*file_, ray.origin), options);
        RETURN_IF_ERROR(walk.go());
        Cast cast{std::nullopt, walk.nearest(), walk.farthest()};
        if (walk.hit() < kNowhere) {
            const fabric::Mat3 linear(worldFromObject_);
            cast.hit = Hit{walk.hit(), glm::inverse(glm::transpose(linear)) * walk.normal(),
                           walk.error() * lod::largestStretch(linear), std::nullopt};
        }
        return cast;
    }

private:
    const fabric::Mat4 worldFromObject_;
    const bool isSingleSided_;
    const std::shared_ptr<const mesh::EymFile> file_;
};

}  // namespace

std::unique_ptr<const Surface> meshSurface(const fabric::SceneObject& object,
                                           std::shared_ptr<const mesh::EymFile> file) {
    return std::make_unique<MeshSurface>(object, std::move(file));
}

}  // namespace eyrie::pick
