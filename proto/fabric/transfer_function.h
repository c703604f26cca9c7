// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <absl/status/status.h>

#include "fabric/vec.h"

namespace eyrie::fabric {

/// Opacity by distance from the centre, both in shares: 1 at the centre, 0 from the width on.
enum class PrimitiveShape {
    /// 1 to half the width, then (1 - d) / d: two of them, one width apart, blend evenly from one's
    /// centre to the other's, and are opaque together on all of the way.
    Blend,
    Box,     ///< 1 throughout
    Tent,    ///< 1 - d
    Smooth,  ///< (1 - d²)²
};

/// Some colour at some elevations; what a person edits.
struct TransferPrimitive {
    PrimitiveShape shape = PrimitiveShape::Blend;
    double centre = 0;
    double width = 1;    ///< from the centre to where it ends; more than 0
    Vec3 colour{0.5};    ///< as displayed, 0 to 1
    double opacity = 1;  ///< at the centre, 0 to 1

    bool operator==(const TransferPrimitive&) const = default;
};

/// What heights are given in: 0 at the lowest and 1 at the highest of each terrain, or metres.
enum class HeightUnit { Relative, Metres };

/// Colour and opacity by elevation, the sum of primitives. After Dick, Krüger and Westermann 2009,
/// "GPU Ray-Casting for Scalable Terrain Rendering", and the terrain engine around it.
struct TransferFunction {
    HeightUnit unit = HeightUnit::Relative;
    std::vector<TransferPrimitive> primitives = {};  ///< at most kMaxTransferPrimitives

    bool operator==(const TransferFunction&) const = default;
};

inline constexpr std::size_t kMaxTransferPrimitives = 32;
inline constexpr double kMaxTransferHeight = 1e6;  ///< of centres and widths, either sign, any unit

/// InvalidArgument, naming the primitive and field, for what lies outside the ranges above.
absl::Status validate(const TransferFunction& function);

/// What a primitive of opacity 1 has at `distance`, in widths, from its centre; 0 to 1.
double shapeAt(PrimitiveShape shape, double distance);

/// What covers the ground at one height.
struct Tint {
    Vec3 colour{0};      ///< linear
    double opacity = 0;  ///< 0: there is no colour

    bool operator==(const Tint&) const = default;
};

/// <sum(c a) / sum(a), max a> over colours c (linear: the squares of those displayed) and opacities
/// a at `height`, which is in the function's unit. The order of the primitives matters in
/// rounding only.
Tint evaluate(const TransferFunction& function, double height);

/// The built-in tints as primitives: meadow, forest, scrub, rock, scree and snow.
TransferFunction hypsometricTints();

}  // namespace eyrie::fabric
