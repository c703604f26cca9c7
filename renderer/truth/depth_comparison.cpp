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

class Comparison {
public:
    Comparison(const Pinhole& camera, std::span<const float> depth,
               const ReferenceSurface& reference, int edgePixels)
        : camera_(camera),
          depth_(depth),
          surface_(reference),
          edge_(edgePixels),
          reference_(depth.size()),
          displacement_(depth.size()) {}

    DepthComparison run() {
        forEachRow([this](int y) { castRow(y); });
        for (int y = 0; y < camera_.height(); ++y)
            for (int x = 0; x < camera_.width(); ++x) classify(x, y);
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
            const Ray ray = camera_.rayThrough(x + 0.5, y + 0.5);
            const double tested = depth_[index(x, y)];
            reference_[index(x, y)] = surface_.firstHit(ray, tested);
            displacement_[index(x, y)] = displacement(ray, tested, reference_[index(x, y)]);
        }
    }

    /// NaN without a counterpart.
    double displacement(const Ray& ray, double tested, double hit) const {
        if (!std::isfinite(tested))
            return std::nan("");
        const Vec3 point = ray.at(tested);
        double pixels = std::nan("");
        if (const auto other = surface_.counterpart(point)) {
            const auto a = camera_.project(point);
            const auto b = camera_.project(*other);
            if (a && b)
                pixels = glm::distance(*a, *b);
        }
        if (hit == kNoHit)
            return pixels;
        const double aside = std::abs(hit - tested) * glm::length(ray.direction) *
                             camera_.focalPixels() / std::min(hit, tested);
        return std::fmin(pixels, aside);
    }

    void classify(int x, int y) {
        const double tested = depth_[index(x, y)];
        double nearest = kNoHit;
        double farthest = 0;
        bool anyHit = false;
        bool anyMiss = false;
        for (int dy = -edge_; dy <= edge_; ++dy)
            for (int dx = -edge_; dx <= edge_; ++dx) {
                const int px = std::clamp(x + dx, 0, camera_.width() - 1);
                const int py = std::clamp(y + dy, 0, camera_.height() - 1);
                const double reference = reference_[index(px, py)];
                anyHit = anyHit || reference != kNoHit;
                anyMiss = anyMiss || reference == kNoHit;
                nearest = std::min(nearest, reference);
                farthest = std::max(farthest, reference);
            }
        if (!std::isfinite(tested)) {
            result_.holes += anyMiss ? 0 : 1;
            return;
        }
        if (!anyHit)
            ++result_.falseHits;
        // Seen from above, a displacement of edge_ pixels is along the depth itself.
        const double slack = edge_ * tested / camera_.focalPixels();
        if (anyHit && (tested < nearest - slack || tested > farthest + slack))
            ++result_.misplaced;
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
    std::vector<double> reference_;     ///< depth, kNoHit for none
    std::vector<double> displacement_;  ///< NaN for none
    DepthComparison result_;
};

}  // namespace

DepthComparison compareDepth(const Pinhole& camera, std::span<const float> depth,
                             const ReferenceSurface& reference, int edgePixels) {
    return Comparison(camera, depth, reference, edgePixels).run();
}

}  // namespace eyrie::truth
