// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

#include "fabric/box.h"
#include "fabric/vec.h"
#include "renderer/lod/view.h"

namespace eyrie::draw {

/// Which nodes of an object's LOD tree the coming frames may need: for each level those within the
/// radius at which it would be drawn, whatever the direction of view, around where the camera will
/// be when they have been loaded. The children of a node of error e are drawn within e * focal /
/// tau.
class Prefetch {
public:
    using Clock = std::chrono::steady_clock;

    /// Nodes looked at in one frame: what is beyond is too far from the view to matter soon.
    static constexpr std::size_t kMostNodes = 4096;

    /// The camera of this frame, drawn at `now`, and where the object is; with the frame before it
    /// tells the motion.
    void follow(const lod::View& view, const fabric::Mat4& worldFromObject, Clock::time_point now);

    /// The most likely first: coarse levels, then those nearest the direction of view. `latency` is
    /// how far ahead to look. A Tree has
    ///   Node                       names one of its nodes; copied
    ///   root()
    ///   bounds(node)               object space, metres
    ///   errorMetres(node)          of drawing it in place of what lies below; infinite where it
    ///                              cannot be drawn itself
    ///   forEachChild(node, visit)
    template <typename Tree>
    std::vector<typename Tree::Node> nodes(const Tree& tree, double tauPixels,
                                           std::chrono::duration<double> latency) const;

private:
    fabric::Vec3 eyeIn(std::chrono::duration<double> time) const;
    /// Cosine between the direction of view and the direction from `eye` to `bounds`.
    double alignment(const fabric::Box& bounds, const fabric::Vec3& eye) const;

    fabric::Vec3 eye_{0};            ///< object space
    fabric::Vec3 metresASecond_{0};  ///< object space
    fabric::Vec3 forward_{0, 0, -1};
    double focalPixels_ = 1;
    Clock::time_point time_;
};

/// From `eye` to the nearest point of `bounds`; 0 inside.
double distanceTo(const fabric::Box& bounds, const fabric::Vec3& eye);

template <typename Tree>
std::vector<typename Tree::Node> Prefetch::nodes(const Tree& tree, double tauPixels,
                                                 std::chrono::duration<double> latency) const {
    struct Candidate {
        typename Tree::Node node;
        int depth;
        double alignment;
        bool isNear;  // within the radius of its children
    };
    const fabric::Vec3 eye = eyeIn(latency);
    const auto candidate = [&](const typename Tree::Node& node, int depth) {
        const fabric::Box bounds = tree.bounds(node);
        const double radius = tree.errorMetres(node) * focalPixels_ / tauPixels;
        return Candidate{node, depth, alignment(bounds, eye), radius > distanceTo(bounds, eye)};
    };
    // Breadth first, so that the limit leaves out the finest levels.
    std::vector<Candidate> candidates{candidate(tree.root(), 0)};
    for (std::size_t next = 0; next < candidates.size(); ++next) {
        const Candidate parent = candidates[next];
        if (parent.isNear)
            tree.forEachChild(parent.node, [&](const typename Tree::Node& child) {
                if (candidates.size() < kMostNodes)
                    candidates.push_back(candidate(child, parent.depth + 1));
            });
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) {
                         return a.depth != b.depth ? a.depth < b.depth : a.alignment > b.alignment;
                     });
    std::vector<typename Tree::Node> nodes;
    for (const Candidate& one : candidates) nodes.push_back(one.node);
    return nodes;
}

}  // namespace eyrie::draw
