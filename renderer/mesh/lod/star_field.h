// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderer/mesh/lod/field.h"
#include "renderer/mesh/lod/star.h"

namespace eyrie::mesh {

/// What is linear on the triangles of a star, and what becomes of it when its vertex is moved onto
/// a neighbour. Between partners it changes as places do: the change is linear in the pieces that
/// old and new edges cut the polygon into, so it is extreme at the vertex, or where they cross.
class StarField {
public:
    explicit StarField(const FieldValue& centre)
        : centre_(centre), values_(FieldRange::of(centre)) {}

    /// The next triangle: what is at ring[i] and ring[i + 1]. All of the star's are added before
    /// anything is asked.
    void add(const FieldValue& from, const FieldValue& to, const FieldChanges& changes);

    const FieldChanges& all() const { return all_; }  ///< of all triangles
    FieldRange shownBy(std::size_t triangle, std::size_t target) const;
    /// From 0 to that at the centre's partner.
    FieldRange changeAtCentre(const Star& star, std::size_t target,
                              const Star::Landing& landing) const;

    /// Visits the triangles that are left, with their changes and what they show. `replaced`: what
    /// star.moveTo() says.
    template <typename Visit>
    void forLeft(const Star& star, std::size_t target, const Star::Landing& landing,
                 const Star::Outcome& replaced, const Visit& visit) const;

private:
    using Steps = std::array<FieldRange, kMaxStar>;

    bool isSmooth() const;
    void steps(const Star& star, std::size_t target, const Star::Landing& landing,
               Steps& steps) const;
    FieldChanges changesOf(std::uint32_t triangles) const;

    FieldValue centre_;
    std::array<FieldValue, kMaxStar> from_;
    std::array<FieldValue, kMaxStar> to_;
    std::array<FieldChanges, kMaxStar> changes_;
    std::size_t count_ = 0;
    FieldChanges all_;
    FieldRange values_;
    bool isSmooth_ = true;  ///< at the spokes between those that were added
};

template <typename Visit>
void StarField::forLeft(const Star& star, std::size_t target, const Star::Landing& landing,
                        const Star::Outcome& replaced, const Visit& visit) const {
    Steps steps;
    this->steps(star, target, landing, steps);
    for (std::size_t i = 0; i < count_; ++i) {
        if (replaced[i].triangles == 0)
            continue;
        const FieldRange shown = shownBy(i, target);
        visit(i, changesOf(replaced[i].triangles).andThen(steps[i], shown), shown);
    }
}

}  // namespace eyrie::mesh
