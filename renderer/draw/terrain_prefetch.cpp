// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_prefetch.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace eyrie::draw {
namespace {

using fabric::Vec3;
using std::chrono::duration;
using terrain::Quadtree;
using terrain::TileId;

/// Tiles looked at in one frame: what is beyond is too far from the view to matter soon.
constexpr std::size_t kMostCandidates = 4096;
/// Two frames further apart tell nothing of how the camera moves.
constexpr duration<double> kLongestStep{1.0};
constexpr duration<double> kFurthestAhead{1.0};

}  // namespace

void TerrainPrefetch::follow(const lod::View& view, const fabric::Mat4& worldFromObject) {
    const fabric::Mat4 objectFromWorld = glm::inverse(worldFromObject);
    const Vec3 eye(objectFromWorld * fabric::Vec4(view.eye, 1.0));
    const Clock::time_point now = Clock::now();
    const duration<double> step = now - time_;
    const bool tells = step < kLongestStep && step > duration<double>(0);
    metresASecond_ = tells ? (eye - eye_) / step.count() : Vec3(0);
    eye_ = eye;
    time_ = now;
    forward_ = glm::normalize(fabric::Mat3(objectFromWorld) * lod::middleDirection(view));
    focalPixels_ = view.greatestFocalPixels();
}

TerrainPrefetch::Candidate TerrainPrefetch::candidate(const TileId& tile, const Vec3& eye,
                                                      double focalOverTau) const {
    const fabric::Box box = index_.bounds(tile);
    const Vec3 toCentre = box.centre() - eye;
    const double distance = glm::length(eye - glm::clamp(eye, box.min, box.max));
    return {tile, glm::dot(forward_, toCentre) / std::max(glm::length(toCentre), 1e-9),
            tile.level > 0 && index_.tile(tile).greatestErrorMetres() * focalOverTau > distance};
}

std::vector<TileId> TerrainPrefetch::tiles(double tauPixels, duration<double> latency) const {
    const Vec3 eye = eye_ + metresASecond_ * std::min(latency, kFurthestAhead).count();
    const double focalOverTau = focalPixels_ / tauPixels;
    // Breadth first, so that the limit leaves out the finest levels.
    std::vector<Candidate> candidates{candidate(index_.quadtree.top(), eye, focalOverTau)};
    for (std::size_t next = 0; next < candidates.size(); ++next)
        for (int i = 0; i < 4 && candidates[next].isNear; ++i)
            if (const TileId child = Quadtree::child(candidates[next].tile, i);
                index_.quadtree.contains(child) && index_.tile(child).triangles > 0 &&
                candidates.size() < kMostCandidates)
                candidates.push_back(candidate(child, eye, focalOverTau));
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) {
                         return a.tile.level != b.tile.level ? a.tile.level > b.tile.level
                                                             : a.alignment > b.alignment;
                     });
    std::vector<TileId> tiles;
    for (const Candidate& one : candidates) tiles.push_back(one.tile);
    return tiles;
}

}  // namespace eyrie::draw
