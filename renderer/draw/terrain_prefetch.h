// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "fabric/vec.h"
#include "renderer/lod/view.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

/// Which tiles the coming frames may need: for each level those within the radius at which it would
/// be drawn, whatever the direction of view, around where the camera will be when they have been
/// loaded. The radius of a tile of error e is e * focal / tau.
class TerrainPrefetch {
public:
    explicit TerrainPrefetch(const terrain::EytIndex& index) : index_(index) {}

    /// The camera of this frame and how the terrain is drawn in it; with the one before it tells
    /// the motion.
    void follow(const lod::View& view, const fabric::Mat4& worldFromObject);

    /// The most likely first: coarse levels, then those nearest the direction of view. `latency` is
    /// how far ahead to look.
    std::vector<terrain::TileId> tiles(double tauPixels,
                                       std::chrono::duration<double> latency) const;

private:
    using Clock = std::chrono::steady_clock;

    struct Candidate {
        terrain::TileId tile;
        double alignment;  ///< cosine between direction of view and direction to the tile
        bool isNear;       ///< within the radius of the next level
    };
    Candidate candidate(const terrain::TileId& tile, const fabric::Vec3& eye,
                        double focalOverTau) const;

    const terrain::EytIndex& index_;
    fabric::Vec3 eye_{0};            ///< object space
    fabric::Vec3 metresASecond_{0};  ///< object space
    fabric::Vec3 forward_{0, 0, -1};
    double focalPixels_ = 1;
    Clock::time_point time_;
};

}  // namespace eyrie::draw
