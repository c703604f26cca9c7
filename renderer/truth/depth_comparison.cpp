// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/depth_comparison.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace eyrie::truth {
namespace {

using fabric::Vec3;

constexpr double kSnapPixels = 1.0 / 256;
constexpr int kFineRays = 16;  ///< a pixel's side

class Comparison {
public:
    Comparison(const Pinhole& camera, std::span<const float> depth,
               const ReferenceSurface& reference, int edgePixels, const Suspects& suspects)
        : camera_(camera),
          depth_(depth),
          surface_(reference),
          edge_(edgePixels),
          suspects_(suspects),
          reference_(depth.size()),
          displacement_(depth.size()) {}

    DepthComparison run() {
        forEachRow([this](int y) { castRow(y); });
        for (int y = 0; y < camera_.height(); ++y)
            for (int x = 0; x < camera_.width(); ++x) {
                classify(x, y);
                if (displacement_[index(x, y)] > suspects_.abovePixels &&
                    result_.suspects < Suspects::kMost)
                    judgeShown(x, y);
            }
        finishDisplacements();
        return result_;
    }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) +
               static_cast<std::size_t>(x);
    }

    template <typename Function>
    void forEachRow(Function function) {
        tbb::parallel_for(tbb::blocked_range<int>(0, camera_.height()), [&](const auto& rows) {
            for (int y = rows.begin(); y != rows.end(); ++y) function(y);
        });
    }

    void castRow(int y) {
        for (int x = 0; x < camera_.width(); ++x) {
            reference_[index(x, y)] = surface_.hitRange(camera_.rayThrough(x + 0.5, y + 0.5));
            displacement_[index(x, y)] = displacement(x + 0.5, y + 0.5, depth_[index(x, y)]);
        }
    }

    /// The displacement of a picture point at a depth.
    struct Displacement {
        double pixels = std::nan("");  ///< NaN without a counterpart
        bool isInColumn = false;       ///< the counterpart is right above or below
        bool isBelow = false;          ///< the point lies below it
    };

    Displacement displacementOf(const Vec3& point) const {
        const auto other = surface_.counterpart(point);
        const auto p = camera_.project(point);
        const auto q = other ? camera_.project(*other) : std::nullopt;
        if (!p || !q)
            return {};
        return {glm::distance(*p, *q), fabric::Vec2(point) == fabric::Vec2(*other),
                point.z < other->z};
    }

    Displacement displacementAt(double x, double y, double depth) const {
        return displacementOf(camera_.rayThrough(x, y).at(depth));
    }

    void judgeShown(int x, int y) {
        const auto point = suspects_.shown(x + 0.5, y + 0.5, depth_[index(x, y)]);
        ++result_.suspects;
        if (!point)
            return;
        displacement_[index(x, y)] = displacementOf(*point).pixels;
    }

    /// The least around (x, y); none where the surface lies on both sides. NaN without a
    /// counterpart.
    double displacement(double x, double y, double depth) const {
        if (!std::isfinite(depth))
            return std::nan("");
        const Displacement centre = displacementAt(x, y, depth);
        double least = centre.pixels;
        for (const double dy : {-kSnapPixels, 0.0, kSnapPixels})
            for (const double dx : {-kSnapPixels, 0.0, kSnapPixels}) {
                if (!(least > kSnapPixels))
                    return least;
                const Displacement beside = displacementAt(x + dx, y + dy, depth);
                const bool isAcross =
                    centre.isInColumn && beside.isInColumn && beside.isBelow != centre.isBelow;
                least = isAcross ? 0 : std::fmin(least, beside.pixels);
            }
        return least;
    }

    /// What the reference shows around a pixel.
    struct Surroundings {
        double nearest = kNoHit;
        double farthest = 0;
        bool anyHit = false;
        bool anyMiss = false;

        void add(const ReferenceSurface::HitRange& hit) {
            anyHit = anyHit || hit.first != kNoHit;
            anyMiss = anyMiss || hit.last == kNoHit;
            nearest = std::min(nearest, hit.first);
            farthest = std::max(farthest, hit.last);
        }
    };

    Surroundings atCentresAround(int x, int y) const {
        Surroundings around;
        for (int dy = -edge_; dy <= edge_; ++dy)
            for (int dx = -edge_; dx <= edge_; ++dx)
                around.add(reference_[index(std::clamp(x + dx, 0, camera_.width() - 1),
                                            std::clamp(y + dy, 0, camera_.height() - 1))]);
        return around;
    }

    /// The same by rays through the whole area, for what is too thin for pixels' centres.
    Surroundings everywhereAround(int x, int y) const {
        Surroundings around;
        const int reach = (2 * edge_ + 1) * kFineRays;
        for (int dy = 0; dy <= reach; ++dy)
            for (int dx = 0; dx <= reach; ++dx)
                around.add(surface_.hitRange(
                    camera_.rayThrough(x - edge_ + static_cast<double>(dx) / kFineRays,
                                       y - edge_ + static_cast<double>(dy) / kFineRays)));
        return around;
    }

    std::size_t DepthComparison::*faultOf(double tested, const Surroundings& around) const {
        if (!std::isfinite(tested))
            return around.anyMiss ? nullptr : &DepthComparison::holes;
        if (!around.anyHit)
            return &DepthComparison::falseHits;
        const double slack = kDepthSlack * edge_ * tested / camera_.focalPixels();
        return tested < around.nearest - slack || tested > around.farthest + slack
                   ? &DepthComparison::misplaced
                   : nullptr;
    }

    void classify(int x, int y) {
        const double tested = depth_[index(x, y)];
        auto fault = faultOf(tested, atCentresAround(x, y));
        if (fault == nullptr)
            return;
        if (lookedInto_ < Suspects::kMost) {
            ++lookedInto_;
            fault = faultOf(tested, everywhereAround(x, y));
        }
        if (fault != nullptr)
            ++(result_.*fault);
    }

    void finishDisplacements() {
        std::vector<double> known;
        for (int y = 0; y < camera_.height(); ++y)
            for (int x = 0; x < camera_.width(); ++x) {
                const double pixels = displacement_[index(x, y)];
                if (std::isnan(pixels))
                    continue;
                known.push_back(pixels);
                if (pixels > result_.maxPixels) {
                    result_.maxPixels = pixels;
                    result_.worstX = x;
                    result_.worstY = y;
                }
            }
        result_.compared = known.size();
        if (known.empty())
            return;
        const auto p99 = known.begin() + static_cast<std::ptrdiff_t>((known.size() - 1) * 99 / 100);
        std::nth_element(known.begin(), p99, known.end());
        result_.p99Pixels = *p99;
    }

    const Pinhole& camera_;
    std::span<const float> depth_;
    const ReferenceSurface& surface_;
    int edge_;
    const Suspects& suspects_;
    std::vector<ReferenceSurface::HitRange> reference_;
    std::vector<double> displacement_;  ///< NaN for none
    std::size_t lookedInto_ = 0;        ///< pixels around which rays were cast everywhere
    DepthComparison result_;
};

}  // namespace

DepthComparison compareDepth(const Pinhole& camera, std::span<const float> depth,
                             const ReferenceSurface& reference, int edgePixels,
                             const Suspects& suspects) {
    return Comparison(camera, depth, reference, edgePixels, suspects).run();
}

}  // namespace eyrie::truth
