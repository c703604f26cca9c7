// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderer/mesh/lod/star.h"
#include "renderer/mesh/lod/tints.h"

namespace eyrie::mesh {

/// Colours on the triangles of a star, and what becomes of them when its vertex is moved onto a
/// neighbour. Between partners they change as places do: the change is linear in the pieces that
/// old and new edges cut the polygon into, so it is extreme at the vertex, or where they cross.
class StarColours {
public:
    explicit StarColours(const Light3& centre)
        : centre_(centre), colours_(LightRange::of(centre)) {}

    /// The next triangle: its colours at ring[i] and ring[i + 1]. All of the star's are added
    /// before anything is asked.
    void add(const Light3& from, const Light3& to, const Tints& tints);

    /// What the triangle in which the centre lands does to the colour there, in a channel as
    /// displayed, of 1; and how far colours come to it if that is too much.
    struct AtCentre {
        float tint = 0;
        double reach = 0;
    };
    AtCentre landing(const Star& star, std::size_t target, const Star::Landing& landing) const;

    /// How far colours come to any triangle that is left. `replaced`: what star.moveTo() says.
    double reach(const Star& star, std::size_t target, const Star::Landing& landing,
                 const Star::Outcome& replaced) const;
    /// By triangle, of those that are left.
    using Outcome = std::array<Tints, kMaxStar>;
    void moveTo(const Star& star, std::size_t target, const Star::Landing& landing,
                const Star::Outcome& replaced, Outcome& outcome) const;

private:
    using Changes = std::array<LightRange, kMaxStar>;

    bool isSmooth() const;
    LightRange shownBy(std::size_t triangle, std::size_t target) const;
    LightRange changeAtCentre(const Star& star, std::size_t target,
                              const Star::Landing& landing) const;
    void changes(const Star& star, std::size_t target, const Star::Landing& landing,
                 Changes& changes) const;
    Tints tintsOf(std::uint32_t triangles) const;
    template <typename Visit>
    void forLeft(const Star& star, std::size_t target, const Star::Landing& landing,
                 const Star::Outcome& replaced, const Visit& visit) const;

    Light3 centre_;
    std::array<Light3, kMaxStar> from_;
    std::array<Light3, kMaxStar> to_;
    std::array<Tints, kMaxStar> tints_;
    std::size_t count_ = 0;
    Tints allTints_;  ///< of all triangles
    LightRange colours_;
    bool isSmooth_ = true;  ///< at the spokes between those that were added
};

}  // namespace eyrie::mesh
