// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/simplify.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "renderer/mesh/lod/linked_faces.h"
#include "renderer/mesh/lod/patch_colours.h"
#include "renderer/mesh/lod/patch_normals.h"
#include "renderer/mesh/lod/star.h"
#include "renderer/mesh/lod/star_colours.h"
#include "renderer/mesh/lod/star_field.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;
/// Of an edge's length, added to what is compared: of equally good collapses the shortest is best.
constexpr double kLengthWeight = 1e-3;
/// A way that can at best cost more than this of the best so far is not looked at: a tenth of the
/// ways, and the levels' errors stay as they are.
constexpr double kWorthALook = 0.9;

/// A neighbour that a vertex may be moved onto, and what comes of it.
struct Collapse {
    std::uint32_t target = kNone;  ///< a point
    double cost = std::numeric_limits<double>::infinity();
};

class Simplifier {
public:
    Simplifier(const PackedMesh& mesh, const Patch& patch, const Staying& staying);

    Simplified run(std::size_t target);

private:
    using Corner = LinkedFaces::Corner;
    using Face = LinkedFaces::Face;
    using Neighbour = LinkedFaces::Neighbour;
    /// A point in the order of its cost, as a number that is compared at once: positive floats
    /// order as their bits do. Ties go by the point: the result is the same everywhere.
    using Candidate = std::uint64_t;
    static Candidate candidate(double cost, std::uint32_t point) {
        return Candidate{std::bit_cast<std::uint32_t>(static_cast<float>(cost))} << 32 | point;
    }
    static std::uint32_t pointOf(Candidate candidate) {
        return static_cast<std::uint32_t>(candidate);
    }

    std::span<const Neighbour> ring() const { return surface_.ring(); }
    bool lookAt(std::uint32_t point);
    std::pair<std::size_t, double> cheapest(std::uint32_t point, const Star& star,
                                            const std::optional<StarField>& colours,
                                            std::uint32_t excluded) const;
    Collapse bestCollapse(std::uint32_t point, bool mustBeSimple);
    void count(std::uint32_t point);
    Star star(std::uint32_t point) const;
    Shifts shiftsOf(const Star& star, const Star::Replaced& replaced) const;
    template <typename ValueAt>
    StarField fieldAround(std::uint32_t point, std::span<const FieldChanges> changes,
                          const ValueAt& valueAt) const;
    std::optional<StarField> coloursAround(std::uint32_t point) const;
    FieldValue normalAt(const Corner& corner) const;
    StarField normalsAround(std::uint32_t point) const;
    bool collapse(std::uint32_t point, std::uint32_t target);

    const PackedMesh& mesh_;
    LinkedFaces surface_;
    std::vector<Shifts> shifts_;            ///< of a face
    std::vector<FieldChanges> tints_;       ///< of a face; none where there is but one colour
    std::vector<FieldChanges> normals_;     ///< of a face
    std::vector<FieldValue> firstNormals_;  ///< of a point's first vertex
    std::vector<Collapse> best_;            ///< of a point
    std::vector<bool> isStale_;             ///< whether something changed around it since
    std::vector<bool> isStaying_;           ///< of a point, in every patch
    std::vector<bool> isShared_;            ///< of a point, with other nodes: it stays, too
    std::vector<bool> isInner_;             ///< whether it had a closed ring at first, and may go
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
    std::size_t left_;
    PointCounts counts_;
};

Simplifier::Simplifier(const PackedMesh& mesh, const Patch& patch, const Staying& staying)
    : mesh_(mesh),
      surface_(mesh, patch.triangles),
      shifts_(patch.shifts),
      normals_(patch.normals),
      best_(surface_.points()),
      isStale_(surface_.points(), false),
      isStaying_(surface_.points(), false),
      isShared_(surface_.points(), false),
      left_(patch.triangles.size()) {
    if (!hasOneColour(mesh, patch))
        tints_ = tintsOf(mesh, patch);
    firstNormals_.reserve(surface_.points());
    for (std::uint32_t point = 0; point < surface_.points(); ++point)
        firstNormals_.push_back(normalOf(mesh, surface_.firstVertexOf(point)));
    normals_.reserve(left_);
    if (normals_.empty())
        for (const auto& [corners, isThere] : surface_.faces())
            normals_.emplace_back(
                rangeOf({normalAt(corners[0]), normalAt(corners[1]), normalAt(corners[2])}));
    for (const Face& face : surface_.faces())
        for (const Corner& corner : face.corners) {
            if (staying.everywhere[corner.vertex] != 0)
                isStaying_[corner.point] = true;
            if (staying.sharedFrom[corner.vertex] <= staying.depth)
                isShared_[corner.point] = true;
        }
}

/// Whether it may go, as far as its faces and normals tell.
bool Simplifier::lookAt(std::uint32_t point) {
    const bool mayGo = surface_.gatherRing(point);
    for (const Neighbour& neighbour : ring()) __builtin_prefetch(&shifts_[neighbour.face]);
    return mayGo;
}

/// The star of the point whose ring this is.
Star Simplifier::star(std::uint32_t point) const {
    std::array<glm::dvec3, kMaxStar> places;
    for (std::size_t i = 0; i < ring().size(); ++i) places[i] = surface_.placeOf(ring()[i].point);
    return {surface_.placeOf(point), std::span(places).first(ring().size())};
}

Shifts moved(const Shifts& before, const Star& star, const Star::Shift& shift) {
    const auto least = static_cast<float>(shift.least);
    const auto most = static_cast<float>(shift.most);
    return star.isGraph() ? before.andThen(glm::vec3(star.normal()), least, most)
                          : before.andThen(most);
}

/// Of a triangle that is left: those of the triangles it replaces, and the way from there.
Shifts Simplifier::shiftsOf(const Star& star, const Star::Replaced& replaced) const {
    Shifts before;
    for (std::uint32_t left = replaced.triangles; left != 0; left &= left - 1)
        before.hold(shifts_[ring()[static_cast<std::size_t>(std::countr_zero(left))].face]);
    return moved(before, star, replaced.shift);
}

/// `valueAt`, of a corner, on the star of the point whose ring this is, with what `changes` has of
/// its faces.
template <typename ValueAt>
StarField Simplifier::fieldAround(std::uint32_t point, std::span<const FieldChanges> changes,
                                  const ValueAt& valueAt) const {
    const auto at = [&](std::uint32_t face, std::uint32_t of) {
        return valueAt(*std::ranges::find(surface_.faces()[face].corners, of, &Corner::point));
    };
    StarField field(at(ring()[0].face, point));
    for (const Neighbour& neighbour : ring())
        field.add(valueAt(Corner{neighbour.vertex, neighbour.point}),
                  at(neighbour.face, neighbour.next), changes[neighbour.face]);
    return field;
}

/// Nothing where there is but one.
std::optional<StarField> Simplifier::coloursAround(std::uint32_t point) const {
    if (tints_.empty())
        return std::nullopt;
    return fieldAround(point, tints_, [&](const Corner& corner) {
        return lightOf(unpackColour(mesh_.colours[corner.vertex]));
    });
}

/// Most points have one vertex, whose normal is unpacked once.
FieldValue Simplifier::normalAt(const Corner& corner) const {
    return surface_.firstVertexOf(corner.point) == corner.vertex ? firstNormals_[corner.point]
                                                                 : normalOf(mesh_, corner.vertex);
}

StarField Simplifier::normalsAround(std::uint32_t point) const {
    return fieldAround(point, normals_, [&](const Corner& corner) { return normalAt(corner); });
}

/// The ring's place with the least cost that is not in `excluded`; the ring's size if there is
/// none. The cost is the greatest bound, on how far points or colours are off, that it makes.
std::pair<std::size_t, double> Simplifier::cheapest(std::uint32_t point, const Star& star,
                                                    const std::optional<StarField>& colours,
                                                    std::uint32_t excluded) const {
    struct Way {
        std::size_t target;
        double length;  ///< what is compared beside bounds
        double least;   ///< that the cost can be
        Star::Landing landing;
    };
    std::array<Way, kMaxStar> ways;
    std::size_t count = 0;
    Shifts before;
    for (const Neighbour& neighbour : ring()) before.hold(shifts_[neighbour.face]);
    for (std::size_t target = 0; target < ring().size(); ++target) {
        if ((excluded >> target & 1) != 0)
            continue;
        const auto landing = star.landing(target);
        if (!landing)
            continue;
        double length = kLengthWeight * glm::length(surface_.placeOf(ring()[target].point) -
                                                    surface_.placeOf(point));
        // The triangle that the centre lands in takes the points of all.
        double least = moved(before, star, landing->shift).longest();
        if (colours) {
            const auto [tint, reach] = colourAtCentre(*colours, star, target, *landing);
            length *= 1 + double{tint / kColourTolerance};
            least = std::max(least, reach);
        }
        ways[count++] = {target, length, least + length, *landing};
    }
    std::pair best(ring().size(), std::numeric_limits<double>::infinity());
    Star::Outcome outcome;
    const auto isLess = [](const Way& a, const Way& b) { return a.least < b.least; };
    for (std::size_t done = 0; done < count; ++done) {
        Way& way = *std::min_element(&ways[done], &ways[count], isLess);
        if (way.least >= kWorthALook * best.second)
            break;
        std::swap(way, ways[done]);
        const auto& [target, length, least, landing] = ways[done];
        star.moveTo(target, landing, outcome);
        const std::size_t centre = (target + landing.triangle) % ring().size();
        const Star::Shift there = outcome[centre].shift;
        double cost = moved(before, star, there).longest() + length;
        // Others hold points that it holds, too: only one that goes farther can cost more.
        for (std::size_t i = 0; i < ring().size() && cost < best.second; ++i)
            if (outcome[i].triangles != 0 &&
                (outcome[i].shift.least < there.least || outcome[i].shift.most > there.most))
                cost = std::max(cost, shiftsOf(star, outcome[i]).longest() + length);
        if (colours && cost < best.second)
            cost = std::max(cost, colourReach(*colours, star, target, landing, outcome) + length);
        if (cost < best.second)
            best = {target, cost};
    }
    return best;
}

/// Few collapses are not simple, so most are asked only once it is their turn.
Collapse Simplifier::bestCollapse(std::uint32_t point, bool mustBeSimple) {
    if (!lookAt(point) || isStaying_[point] || isShared_[point])
        return {};
    const Star star = this->star(point);
    if (!star.isFlat())
        return {};
    const std::optional<StarField> colours = coloursAround(point);
    for (std::uint32_t excluded = 0;;) {
        const auto [target, cost] = cheapest(point, star, colours, excluded);
        if (target == ring().size())
            return {};
        if (!mustBeSimple || surface_.isSimple(target))
            return {ring()[target].point, cost};
        excluded |= 1U << target;
    }
}

/// Of a point around which nothing has changed. False, with nothing done, when faces would fall
/// onto each other.
bool Simplifier::collapse(std::uint32_t point, std::uint32_t target) {
    lookAt(point);
    const auto to =
        std::find_if(ring().begin(), ring().end(),
                     [target](const Neighbour& neighbour) { return neighbour.point == target; });
    const auto place = static_cast<std::size_t>(to - ring().begin());
    if (!surface_.isSimple(place))
        return false;
    for (const Neighbour& neighbour : ring()) __builtin_prefetch(&normals_[neighbour.face]);
    Star::Outcome outcome;
    const Star star = this->star(point);
    const Star::Landing landing = *star.landing(place);
    star.moveTo(place, landing, outcome);
    std::array<Shifts, kMaxStar> shifts;
    for (std::size_t i = 0; i < ring().size(); ++i) shifts[i] = shiftsOf(star, outcome[i]);
    const auto follow = [&](const StarField& field, std::vector<FieldChanges>& changes) {
        field.forLeft(star, place, landing, outcome,
                      [&](std::size_t i, const FieldChanges& now, const FieldRange&) {
                          changes[ring()[i].face] = now;
                      });
    };
    if (const auto colours = coloursAround(point))
        follow(*colours, tints_);
    follow(normalsAround(point), normals_);
    for (std::size_t i = 0; i < ring().size(); ++i) {
        shifts_[ring()[i].face] = shifts[i];
        if (outcome[i].triangles == 0)
            surface_.remove(ring()[i].face);
        isStale_[ring()[i].point] = true;
        if (best_[ring()[i].point].target == kNone && isInner_[ring()[i].point])
            queue_.push(candidate(0, ring()[i].point));  // to be looked at again
    }
    surface_.moveCorners(point, to->point, to->vertex);
    left_ -= 2;
    return true;
}

/// The point that was just looked at, before anything changed.
void Simplifier::count(std::uint32_t point) {
    ++counts_.all;
    if (isStaying_[point])
        ++counts_.staying;
    else if (!surface_.isRing())
        ++(surface_.isOpen() ? counts_.onBorder : counts_.staying);
    else if (isShared_[point])
        ++counts_.onBorder;
}

Simplified Simplifier::run(std::size_t target) {
    const auto look = [&](std::uint32_t point, bool mustBeSimple = false) {
        best_[point] = bestCollapse(point, mustBeSimple);
        isStale_[point] = false;
        if (best_[point].target != kNone)
            queue_.push(candidate(best_[point].cost, point));
    };
    for (std::uint32_t point = 0; point < surface_.points(); ++point) {
        look(point);
        isInner_.push_back(surface_.isRing() && !isStaying_[point] && !isShared_[point]);
        count(point);
    }
    const auto border = static_cast<std::size_t>(std::ranges::count(isInner_, false));
    Simplified result;
    result.points = counts_;
    result.target = target + std::min(border, surface_.points() - border) / 2;
    while (left_ > result.target && !queue_.empty()) {
        const std::uint32_t point = pointOf(queue_.top());
        queue_.pop();
        if (isStale_[point])
            look(point);
        else if (!collapse(point, best_[point].target))
            look(point, true);
    }
    result.patch.triangles.reserve(left_);
    result.patch.shifts.reserve(left_);
    result.patch.normals.reserve(left_);
    for (std::size_t i = 0; i < surface_.faces().size(); ++i) {
        const auto& corners = surface_.faces()[i].corners;
        if (!surface_.faces()[i].isThere)
            continue;
        result.patch.triangles.push_back({corners[0].vertex, corners[1].vertex, corners[2].vertex});
        result.patch.shifts.push_back(shifts_[i]);
        if (!tints_.empty())
            result.patch.tints.push_back(tints_[i]);
        result.patch.normals.push_back(normals_[i]);
    }
    return result;
}

}  // namespace

PointCounts& PointCounts::operator+=(const PointCounts& more) {
    all += more.all;
    onBorder += more.onBorder;
    staying += more.staying;
    return *this;
}

Simplified simplify(const PackedMesh& mesh, const Patch& patch, std::size_t target,
                    const Staying& staying) {
    return Simplifier(mesh, patch, staying).run(target);
}

}  // namespace eyrie::mesh
