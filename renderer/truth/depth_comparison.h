// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {

/// How a tested depth picture differs from a reference. Displacements are in pixels on the screen.
struct DepthComparison {
    double maxPixels = 0;  ///< the largest displacement of a drawn pixel's surface point
    double p99Pixels = 0;  ///< not exceeded by 99 of 100 drawn pixels
    double p50Pixels = 0;
    int worstX = 0;  ///< where maxPixels is
    int worstY = 0;
    std::size_t compared = 0;   ///< pixels drawn that have a counterpart on the reference
    std::size_t holes = 0;      ///< nothing drawn where the reference is hit (edges excepted)
    std::size_t falseHits = 0;  ///< drawn where the reference is not hit (edges excepted)
    /// Drawn at a depth that no reference pixel nearby has: something in front is missing, or
    /// something that should be hidden is in front (edges excepted).
    std::size_t misplaced = 0;
    std::size_t suspects = 0;  ///< beyond what is promised by their depths
};

/// A point of the drawn surface.
struct DrawnPoint {
    fabric::Vec3 point{0};
    std::size_t source = 0;     ///< which of the reference's it was made of (ReferenceSurface)
    bool mayHaveDepth = false;  ///< drawing it rightly may give the depth that was asked for
    bool isAtEnd = false;       ///< what is drawn ends at it: what is behind may be seen
};

/// That which a picture point of some depth shows, where known: what may have the depth, or comes
/// nearest to it. Any thread may ask.
using ShownPoint = std::function<std::optional<DrawnPoint>(double x, double y, double depthMetres)>;

struct Suspects {
    double abovePixels = kNoHit;
    ShownPoint shown;  ///< empty: nothing is known of what pixels show
};

/// What a camera sees of a reference: where the ray through each pixel's centre hits beyond the
/// near plane, in rows from the bottom up. Refers to the reference.
struct ReferenceView {
    Pinhole camera;
    const ReferenceSurface* surface;
    std::vector<ReferenceSurface::HitRange> hits;
};

/// Casts the rays, on all cores.
ReferenceView castView(const Pinhole& camera, const ReferenceSurface& reference);

/// Around which pixels' centres the least displacement is looked for.
enum class LookAround {
    All,
    /// Those displaced by more than what is promised (`suspects.abovePixels`), or farthest of all:
    /// two in a hundred. The others count as they are at their centres, which is not less.
    Farthest,
};

/// How much farther than on the screen a surface may be off in depth: steeply from above one hardly
/// sees it.
inline constexpr double kDepthSlack = 4;

/// Compares a picture with a reference, pixel by pixel.
///
/// A pixel's displacement: its centre is taken back to the world at the tested depth, and the
/// distance on the screen to the reference's counterpart of that point (ReferenceSurface) is
/// measured. Window coordinates being rounded to 1/256 pixel, the depth may be that of a point so
/// far beside the centre: the least displacement around it counts.
///
/// Pixels within `edgePixels` of a place where the reference begins or ends are excepted from
/// holes and falseHits, and depths are compared with the range of those within that distance, and
/// kDepthSlack times that many pixels' size more: a surface moved by up to that much is no mistake.
/// What the reference shows there is told by a ray per pixel, and where that does not explain a
/// pixel by 256, of the nearest 9 pixels, which miss no more of a spire or gap than a width of 1/16
/// pixel. What is drawn before all of that is thin, and no mistake, if the source has it there;
/// what is seen behind it is none where all that is before it has a seam there
/// (ReferenceSurface::throughSeams), or where beside all that the source ends within `edgePixels`,
/// hidden or not (ReferenceSurface::endsWithin): what a picture has left out beside a hole behind a
/// crest may be the crest.
///
/// `depth`: view-space metres, infinity for nothing; rows from the bottom up, width * height of
/// `camera`. Uses all cores.
///
/// A pixel displaced by more than `suspects.abovePixels`, or misplaced, is judged by the drawn
/// point that `suspects.shown` names for it instead of by its depth, and held against that point's
/// own source, but only if that point may have the pixel's depth: what it shows is what was drawn
/// there. What is seen behind all of the source, be it nothing, is no mistake where what is drawn
/// before it ends at the pixel's centre. Without `suspects.shown`, a suspect that may be of
/// another of several sources, beside that one's end, is held against none
/// (ReferenceSurface::isBesideEndOfOne).
DepthComparison compareDepth(const Pinhole& camera, std::span<const float> depth,
                             const ReferenceSurface& reference, int edgePixels,
                             const Suspects& suspects = {});

/// The same of a view that is cast already. `displacements`, if given, receives each pixel's, in
/// pixels; NaN where nothing is compared.
DepthComparison compareDepth(const ReferenceView& view, std::span<const float> depth,
                             int edgePixels, const Suspects& suspects, LookAround lookAround,
                             std::vector<float>* displacements = nullptr);

/// Displacements alone, of exact depths at pixels' centres: each pixel's, in pixels; NaN where
/// nothing is compared. Uses all cores.
std::vector<double> displacements(const Pinhole& camera, std::span<const float> depth,
                                  const ReferenceSurface& reference);

/// Of `values`, which are shuffled, the one that so many hundredths of them do not exceed.
/// Precondition: there is one, and no NaN.
double percentile(std::vector<double>& values, std::size_t hundredths);

}  // namespace eyrie::truth
