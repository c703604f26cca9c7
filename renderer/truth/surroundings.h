// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {

/// What rays meet in some part of a picture.
struct Surroundings {
    double nearest = kNoHit;
    double farthest = 0;
    bool anyHit = false;
    bool anyMiss = false;

    void add(const ReferenceSurface::HitRange& hit);
    void add(const Surroundings& other);
};

/// Of each pixel's ray, `hits`, with those of the pixels up to `reach` columns and rows away; rows
/// of `width`. Takes as long for any reach (van Herk, "A fast algorithm for local minimum and
/// maximum filters on rectangular and octagonal kernels", 1992).
std::vector<Surroundings> surroundings(std::span<const ReferenceSurface::HitRange> hits, int width,
                                       int reach);

}  // namespace eyrie::truth
