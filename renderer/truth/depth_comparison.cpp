// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/depth_comparison.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "fabric/frustum.h"
#include "renderer/truth/surroundings.h"

namespace eyrie::truth {
namespace {

constexpr double kSnapPixels = 1.0 / 256;
constexpr int kFineRays = 16;       ///< a pixel's side
constexpr int kMostFinePixels = 9;  ///< to each side; what lies farther off is seen at centres
/// To explain a picture's pixels, of those that a window has; some ten seconds. More are no
/// exceptions.
constexpr std::size_t kMostRaysAround = 4'000'000;
/// Beside a pixel's centre a seam between triangles may open. More than what corners are rounded
/// by, for a surface may be seen at an angle; and what is promised, but no slit that shows.
constexpr double kSeamPixels = 1.0 / 64;
constexpr double kMostSlitPixels = 1.0 / 16;
constexpr std::size_t kMostSeams = 64;  ///< of so many pixels
constexpr std::size_t kMostEnds = 256;  ///< the same
constexpr std::size_t kWindowPixels = 1280 * 720;

template <typename Function>
void forEachRow(int rows, Function function) {
    tbb::parallel_for(tbb::blocked_range<int>(0, rows), [&](const auto& some) {
        for (int y = some.begin(); y != some.end(); ++y) function(y);
    });
}

/// Where a ray first hits of what the near plane leaves.
ReferenceSurface::HitRange seenAlong(const Ray& ray, const ReferenceSurface& surface) {
    constexpr double kNear = fabric::kNearMetres;
    const ReferenceSurface::HitRange hit = surface.hitRange(ray);
    if (hit.first >= kNear)
        return hit;
    if (hit.last >= kNear)
        return {kNear, hit.last};
    const ReferenceSurface::HitRange beyond = surface.hitRange({ray.at(kNear), ray.direction});
    return {kNear + beyond.first, kNear + beyond.last};
}

class Comparison {
public:
    Comparison(const ReferenceView& view, std::span<const float> depth, int edgePixels,
               const Suspects& suspects)
        : camera_(view.camera),
          depth_(depth),
          surface_(*view.surface),
          edge_(edgePixels),
          suspects_(suspects),
          reference_(view.hits),
          around_(surroundings(view.hits, camera_.width(), edgePixels)),
          displacement_(truth::displacements(camera_, depth, surface_)),
          windows_((depth.size() + kWindowPixels - 1) / kWindowPixels) {}

    DepthComparison run(LookAround lookAround) {
        const double above = lookAround == LookAround::All ? kSnapPixels : farthestOnly();
        forEachRow(camera_.height(), [&](int y) { lookAroundRow(y, above); });
        judgeSuspects();
        for (int y = 0; y < camera_.height(); ++y)
            for (int x = 0; x < camera_.width(); ++x) classify(x, y);
        finishDisplacements();
        return result_;
    }

    /// Each pixel's, in pixels; NaN for none.
    const std::vector<double>& displacements() const { return displacement_; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) +
               static_cast<std::size_t>(x);
    }

    void lookAroundRow(int y, double above) {
        for (int x = 0; x < camera_.width(); ++x)
            if (double& pixels = displacement_[index(x, y)]; pixels > above)
                pixels = leastAround(x + 0.5, y + 0.5, depth_[index(x, y)]);
    }

    /// The displacement above which LookAround::Farthest looks: of two in a hundred, or of one.
    double farthestOnly() const {
        std::vector<double> known = knownDisplacements();
        if (known.empty())
            return 0;
        const auto at = known.begin() + static_cast<std::ptrdiff_t>((known.size() - 1) * 98 / 100);
        std::nth_element(known.begin(), at, known.end());
        return std::min(*at, suspects_.abovePixels);
    }

    std::vector<double> knownDisplacements() const {
        std::vector<double> known;
        std::copy_if(displacement_.begin(), displacement_.end(), std::back_inserter(known),
                     [](double pixels) { return !std::isnan(pixels); });
        return known;
    }

    Displacement displacementAt(double x, double y, double depth) const {
        return surface_.displacement(camera_, camera_.rayThrough(x, y).at(depth));
    }

    void judgeSuspects() {
        std::vector<std::size_t> suspects;
        for (std::size_t i = 0; i < displacement_.size(); ++i)
            if (displacement_[i] > suspects_.abovePixels)
                suspects.push_back(i);
        result_.suspects = suspects.size();
        tbb::parallel_for(std::size_t{0}, suspects.size(),
                          [&](std::size_t i) { judgeShown(suspects[i]); });
    }

    void judgeShown(std::size_t pixel) {
        const auto width = static_cast<std::size_t>(camera_.width());
        const int x = static_cast<int>(pixel % width);
        const int y = static_cast<int>(pixel / width);
        if (!suspects_.shown) {
            if (mayBeOfAnother(x, y, depth_[pixel]))
                displacement_[pixel] = std::nan("");
            return;
        }
        const auto drawn = suspects_.shown(x + 0.5, y + 0.5, depth_[pixel]);
        if (drawn && drawn->mayHaveDepth)
            displacement_[pixel] =
                surface_.displacementFrom(drawn->source, camera_, drawn->point).pixels;
    }

    /// Whether it may be drawn over the end of another source than it was held against.
    bool mayBeOfAnother(int x, int y, double depth) const {
        const fabric::Vec3 point = camera_.rayThrough(x + 0.5, y + 0.5).at(depth);
        const double reach = reachOfEnds(depth);
        return surface_.isBesideEndOfOne(point, reach, [&](const fabric::Vec3& end) {
            return glm::distance(end, point) <= reach && isBeside(x, y, end);
        });
    }

    /// The least displacement around a point that has one; none where the surface lies on both
    /// sides.
    double leastAround(double x, double y, double depth) const {
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

    double slack(double tested) const {
        return kDepthSlack * edge_ * tested / camera_.focalPixels();
    }

    std::size_t DepthComparison::*faultOf(double tested, const Surroundings& around) const {
        if (!std::isfinite(tested))
            return around.anyMiss ? nullptr : &DepthComparison::holes;
        if (!around.anyHit)
            return &DepthComparison::falseHits;
        return tested < around.nearest - slack(tested) || tested > around.farthest + slack(tested)
                   ? &DepthComparison::misplaced
                   : nullptr;
    }

    void classify(int x, int y) {
        const double tested = depth_[index(x, y)];
        const Surroundings& around = around_[index(x, y)];
        auto fault = faultOf(tested, around);
        if (fault == nullptr)
            return;
        if (isShownRightly(x, y, tested, around) || isThin(x, y, tested, around))
            return;
        if (raysAround_ < kMostRaysAround * windows_)
            fault = faultEverywhereAround(x, y, tested);
        else if (isExplained(x, y, tested, around))
            fault = nullptr;
        if (fault != nullptr)
            ++(result_.*fault);
    }

    /// Whether the source has what is drawn before everything that rays hit: something too thin for
    /// them.
    bool isThin(int x, int y, double tested, const Surroundings& around) const {
        if (!(tested < around.nearest))
            return false;
        if (!(displacement_[index(x, y)] <= std::min<double>(edge_, suspects_.abovePixels)))
            return false;
        const auto source = surface_.counterpart(camera_.rayThrough(x + 0.5, y + 0.5).at(tested));
        if (!source)
            return false;
        const double depth = camera_.depth(*source);
        return depth < around.nearest - slack(tested) && tested >= depth - slack(tested);
    }

    /// Whether what is drawn, or nothing, is what is seen through seams.
    bool isThroughSeams(int x, int y, double tested) {
        if (++seams_ > kMostSeams * windows_)
            return false;
        const double reach = kSeamPixels + std::min(suspects_.abovePixels, kMostSlitPixels);
        const auto seen = surface_.throughSeams(camera_.rayThrough(x + 0.5, y + 0.5),
                                                reach / camera_.focalPixels());
        return std::isfinite(tested) ? tested <= seen.last + slack(tested) : seen.last == kNoHit;
    }

    /// Whether the source ends beside the point at this depth, be it where something hides that.
    bool endsBeside(int x, int y, double depth) {
        if (++ends_ > kMostEnds * windows_)
            return false;
        return surface_.endsWithin(camera_.rayThrough(x + 0.5, y + 0.5).at(depth),
                                   reachOfEnds(depth),
                                   [&](const fabric::Vec3& end) { return isBeside(x, y, end); });
    }

    /// How far from a point of this depth the source may end beside it, in metres.
    double reachOfEnds(double depth) const {
        constexpr double kSlant = 8;  // as far across ground seen at 7 degrees
        return kSlant * (edge_ + 0.5) * depth / camera_.focalPixels();
    }

    bool isBeside(int x, int y, const fabric::Vec3& point) const {
        const auto at = camera_.project(point);
        return at && std::abs(at->x - x - 0.5) <= edge_ + 0.5 &&
               std::abs(at->y - y - 0.5) <= edge_ + 0.5;
    }

    /// Whether it ends beside all that it has before what is drawn here, or before nothing: what a
    /// picture leaves out there may lie before what hides the end.
    bool isBesideEnds(int x, int y, double tested) {
        constexpr double kBehind = 1 + 1e-9;
        const Ray ray = camera_.rayThrough(x + 0.5, y + 0.5);
        ReferenceSurface::HitRange hit = reference_[index(x, y)];
        const bool isAny = hit.first != kNoHit;
        const double behind = std::isfinite(tested) ? tested - slack(tested) : kNoHit;
        while (hit.first < behind) {
            if (!endsBeside(x, y, hit.first))
                return false;
            if (hit.last == kNoHit)  // where the surface is not sure of an end, nothing is behind
                break;
            const double from = hit.last * kBehind;
            hit = surface_.hitRange({ray.at(from), ray.direction});
            hit = {from + hit.first, from + hit.last};
        }
        return isAny;
    }

    std::optional<DrawnPoint> shownAt(int x, int y, double depth) const {
        return suspects_.shown ? suspects_.shown(x + 0.5, y + 0.5, depth) : std::nullopt;
    }

    bool isRight(const DrawnPoint& drawn, const Surroundings& around) const {
        return faultOf(camera_.depth(drawn.point), around) == nullptr;
    }

    /// Whether what has the pixel's depth is itself where the source is.
    bool isShownRightly(int x, int y, double tested, const Surroundings& around) const {
        const auto drawn = shownAt(x, y, tested);
        return drawn && drawn->mayHaveDepth && isRight(*drawn, around);
    }

    /// Whether what is drawn where the source is ends there and leaves the pixel to what is behind.
    bool isBesideAnEnd(int x, int y, const Surroundings& around) const {
        const auto drawn = shownAt(x, y, around.farthest);
        return drawn && drawn->isAtEnd && isRight(*drawn, around);
    }

    /// The same by rays through the whole area, for what is too thin for pixels' centres; until
    /// they explain the pixel.
    std::size_t DepthComparison::*faultEverywhereAround(int x, int y, double tested) {
        Surroundings around = around_[index(x, y)];
        std::size_t DepthComparison::*fault = nullptr;
        const int pixels = std::min(edge_, kMostFinePixels);
        const int reach = (2 * pixels + 1) * kFineRays;
        for (int dy = 0; dy <= reach; ++dy) {
            for (int dx = 0; dx <= reach; ++dx)
                around.add(
                    seenAlong(camera_.rayThrough(x - pixels + static_cast<double>(dx) / kFineRays,
                                                 y - pixels + static_cast<double>(dy) / kFineRays),
                              surface_));
            raysAround_ += static_cast<std::size_t>(reach) + 1;
            fault = faultOf(tested, around);
            if (fault == nullptr)
                return nullptr;
        }
        return isExplained(x, y, tested, around) ? nullptr : fault;
    }

    /// By other than where the pixel's depth is. A triangle seen edge-on gives a pixel beside it
    /// any depth of its plane; and where what is drawn ends next to a pixel's centre, that is left
    /// to what is behind, where the source has a slit that something hid.
    bool isExplained(int x, int y, double tested, const Surroundings& around) {
        if (isShownRightly(x, y, tested, around) || isThin(x, y, tested, around))
            return true;
        return tested >= around.nearest &&
               (isThroughSeams(x, y, tested) || isBesideAnEnd(x, y, around) ||
                isBesideEnds(x, y, tested));
    }

    void finishDisplacements() {
        for (int y = 0; y < camera_.height(); ++y)
            for (int x = 0; x < camera_.width(); ++x)
                if (const double pixels = displacement_[index(x, y)]; pixels > result_.maxPixels) {
                    result_.maxPixels = pixels;
                    result_.worstX = x;
                    result_.worstY = y;
                }
        std::vector<double> known = knownDisplacements();
        result_.compared = known.size();
        if (known.empty())
            return;
        result_.p99Pixels = percentile(known, 99);
        result_.p50Pixels = percentile(known, 50);
    }

    const Pinhole& camera_;
    std::span<const float> depth_;
    const ReferenceSurface& surface_;
    int edge_;
    const Suspects& suspects_;
    const std::vector<ReferenceSurface::HitRange>& reference_;
    std::vector<Surroundings> around_;  ///< of pixels' centres within `edge_` pixels
    std::vector<double> displacement_;  ///< NaN for none
    std::size_t raysAround_ = 0;        ///< cast by faultEverywhereAround
    std::size_t seams_ = 0;             ///< looked through
    std::size_t ends_ = 0;              ///< looked for
    const std::size_t windows_;         ///< that have as many pixels as the picture, rounded up
    DepthComparison result_;
};

}  // namespace

double percentile(std::vector<double>& values, std::size_t hundredths) {
    const std::size_t rank = std::max<std::size_t>(1, (values.size() * hundredths + 99) / 100);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

std::vector<double> displacements(const Pinhole& camera, std::span<const float> depth,
                                  const ReferenceSurface& reference) {
    std::vector<double> pixels(depth.size(), std::nan(""));
    forEachRow(camera.height(), [&](int y) {
        for (int x = 0; x < camera.width(); ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width()) +
                static_cast<std::size_t>(x);
            if (std::isfinite(depth[i]))
                pixels[i] =
                    reference
                        .displacement(
                            camera,
                            camera.rayThrough(x + 0.5, y + 0.5).at(static_cast<double>(depth[i])))
                        .pixels;
        }
    });
    return pixels;
}

ReferenceView castView(const Pinhole& camera, const ReferenceSurface& reference) {
    const auto width = static_cast<std::size_t>(camera.width());
    ReferenceView view{camera, &reference, {}};
    view.hits.resize(width * static_cast<std::size_t>(camera.height()));
    forEachRow(camera.height(), [&](int y) {
        auto hit = view.hits.begin() + static_cast<std::ptrdiff_t>(width) * y;
        for (int x = 0; x < camera.width(); ++x)
            *hit++ = seenAlong(camera.rayThrough(x + 0.5, y + 0.5), reference);
    });
    return view;
}

DepthComparison compareDepth(const Pinhole& camera, std::span<const float> depth,
                             const ReferenceSurface& reference, int edgePixels,
                             const Suspects& suspects) {
    return compareDepth(castView(camera, reference), depth, edgePixels, suspects, LookAround::All);
}

DepthComparison compareDepth(const ReferenceView& view, std::span<const float> depth,
                             int edgePixels, const Suspects& suspects, LookAround lookAround,
                             std::vector<float>* displacements) {
    Comparison comparison(view, depth, edgePixels, suspects);
    const DepthComparison result = comparison.run(lookAround);
    if (displacements != nullptr)
        displacements->assign(comparison.displacements().begin(), comparison.displacements().end());
    return result;
}

}  // namespace eyrie::truth
