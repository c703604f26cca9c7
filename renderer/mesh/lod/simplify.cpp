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
    Simplifier(const PackedMesh& mesh, const Patch& patch, std::span<const std::uint8_t> staying);

    Simplified run(std::size_t target);

private:
    struct Corner {
        std::uint32_t vertex;  ///< the mesh's own
        std::uint32_t point;
    };
    struct Face {
        std::array<Corner, 3> corners;
        bool isThere = true;
    };
    /// A face and which of its corners, as one number.
    struct CornerId {
        std::uint32_t id;
        CornerId(std::uint32_t face, std::uint32_t corner) : id(face << 2 | corner) {}
        std::uint32_t face() const { return id >> 2; }
        std::uint32_t corner() const { return id & 3; }
    };
    /// Where the corners at a point are in `corners_`. Side by side, not linked: so that their
    /// faces are fetched from memory at the same time, which is where the time goes.
    struct Corners {
        std::size_t begin = 0;
        std::uint32_t count = 0;
    };
    struct Neighbour {
        std::uint32_t point;
        std::uint32_t next;    ///< the neighbour after it
        std::uint32_t face;    ///< between it and the next neighbour
        std::uint32_t vertex;  ///< its own in that face
    };
    /// A point in the order of its cost, as a number that is compared at once: positive floats
    /// order as their bits do. Ties go by the point: the result is the same everywhere.
    using Candidate = std::uint64_t;
    static Candidate candidate(double cost, std::uint32_t point) {
        return Candidate{std::bit_cast<std::uint32_t>(static_cast<float>(cost))} << 32 | point;
    }
    static std::uint32_t pointOf(Candidate candidate) {
        return static_cast<std::uint32_t>(candidate);
    }

    void link(const PackedMesh& mesh);
    bool gatherRing(std::uint32_t point);
    bool sortRing();
    bool isOpen() const;
    bool isSimple(std::size_t target);
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
    void moveCorners(std::uint32_t from, std::uint32_t onto, std::uint32_t vertex);
    template <typename Visit>
    void forCorners(std::uint32_t point, const Visit& visit);

    const PackedMesh& mesh_;
    std::vector<Face> faces_;
    std::vector<Shifts> shifts_;         ///< of a face
    std::vector<FieldChanges> tints_;    ///< of a face; none where there is but one colour
    std::vector<FieldChanges> normals_;  ///< of a face
    std::vector<glm::dvec3> points_;
    std::vector<std::uint32_t> firstVertices_;  ///< of a point: that which was met first ...
    std::vector<FieldValue> firstNormals_;      ///< ... and its normal
    std::vector<CornerId> corners_;             ///< of all points; what was replaced is left behind
    std::vector<Corners> around_;               ///< of a point; some may be of faces that are gone
    std::vector<Collapse> best_;                ///< of a point
    std::vector<bool> isStale_;                 ///< whether something changed around it since
    std::vector<bool> isStaying_;               ///< of a point
    std::vector<bool> isInner_;  ///< whether it had a closed ring at first, and may go
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
    std::vector<std::uint32_t> mark_;
    std::uint32_t marking_ = 0;
    std::vector<Neighbour> ring_;  ///< of the point looked at
    bool isRing_ = false;          ///< whether they are a closed one
    std::size_t left_;
    PointCounts counts_;
};

Simplifier::Simplifier(const PackedMesh& mesh, const Patch& patch,
                       std::span<const std::uint8_t> staying)
    : mesh_(mesh), shifts_(patch.shifts), normals_(patch.normals), left_(patch.triangles.size()) {
    if (!hasOneColour(mesh, patch))
        tints_ = tintsOf(mesh, patch);
    faces_.reserve(left_);
    for (std::size_t i = 0; i < left_; ++i) {
        Face face;
        for (std::size_t corner = 0; corner < 3; ++corner)
            face.corners[corner] = {patch.triangles[i][corner], kNone};
        faces_.push_back(face);
    }
    link(mesh);
    normals_.reserve(faces_.size());
    if (normals_.empty())
        for (const auto& [corners, isThere] : faces_)
            normals_.emplace_back(
                rangeOf({normalAt(corners[0]), normalAt(corners[1]), normalAt(corners[2])}));
    isStaying_.resize(points_.size(), false);
    if (!staying.empty())
        for (const Face& face : faces_)
            for (const Corner& corner : face.corners)
                if (staying[corner.vertex] != 0)
                    isStaying_[corner.point] = true;
}

/// Vertices at one position are one point of the surface: numbered as they come, with an open hash
/// table.
void Simplifier::link(const PackedMesh& mesh) {
    std::vector<std::uint32_t> slots(std::bit_ceil(faces_.size() * 3 + 2), kNone);
    std::vector<std::uint64_t> positions;
    const auto pointAt = [&](std::uint32_t vertex) {
        const std::uint64_t position = mesh.positions[vertex];
        std::size_t slot = (position * 0x9E3779B97F4A7C15ULL >> 32) & (slots.size() - 1);
        while (slots[slot] != kNone && positions[slots[slot]] != position)
            slot = (slot + 1) & (slots.size() - 1);
        if (slots[slot] == kNone) {
            slots[slot] = static_cast<std::uint32_t>(points_.size());
            positions.push_back(position);
            points_.emplace_back(unpackPosition(position));
            firstVertices_.push_back(vertex);
            firstNormals_.push_back(normalOf(mesh, vertex));
            around_.emplace_back();
        }
        return slots[slot];
    };
    for (Face& face : faces_)
        for (Corner& corner : face.corners) {
            corner.point = pointAt(corner.vertex);
            ++around_[corner.point].count;
        }
    std::size_t end = 0;
    for (Corners& corners : around_) corners.begin = end += std::exchange(corners.count, 0);
    corners_.resize(end, CornerId(0, 0));
    for (std::uint32_t face = 0; face < faces_.size(); ++face)
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            Corners& corners = around_[faces_[face].corners[corner].point];
            corners_[--corners.begin] = {face, corner};
            ++corners.count;
        }
    best_.resize(points_.size());
    isStale_.resize(points_.size(), false);
    mark_.resize(points_.size(), 0);
}

template <typename Visit>
void Simplifier::forCorners(std::uint32_t point, const Visit& visit) {
    Corners& corners = around_[point];
    const std::span all(corners_.data() + corners.begin, corners.count);
    corners.count = 0;
    for (const CornerId at : all)
        if (faces_[at.face()].isThere) {
            all[corners.count++] = at;  // those that are gone are forgotten now
            visit(at.face(), at.corner());
        }
}

/// Fills ring_; false when the point has to stay.
bool Simplifier::gatherRing(std::uint32_t point) {
    ring_.clear();
    std::uint32_t only = kNone;
    bool isWhole = true;
    forCorners(point, [&](std::uint32_t index, std::uint32_t corner) {
        const Face& face = faces_[index];
        const std::uint32_t own = face.corners[corner].vertex;
        isWhole = isWhole && (only == kNone || only == own);
        only = own;
        const Corner& first = face.corners[(corner + 1) % 3];
        ring_.push_back({first.point, face.corners[(corner + 2) % 3].point, index, first.vertex});
        __builtin_prefetch(&shifts_[index]);
    });
    isRing_ = ring_.size() >= 3 && ring_.size() <= kMaxStar && sortRing();
    return isRing_ && isWhole;
}

/// Brings the neighbours in turn; false when they are no closed ring.
bool Simplifier::sortRing() {
    for (std::size_t i = 0; i + 1 < ring_.size(); ++i) {
        const auto found = std::find_if(
            ring_.begin() + static_cast<std::ptrdiff_t>(i) + 1, ring_.end(),
            [&](const Neighbour& neighbour) { return neighbour.point == ring_[i].next; });
        if (found == ring_.end())
            return false;
        std::swap(ring_[i + 1], *found);
    }
    if (ring_.back().next != ring_.front().point)
        return false;
    ++marking_;
    for (const Neighbour& neighbour : ring_)
        if (std::exchange(mark_[neighbour.point], marking_) == marking_)
            return false;  // the ring meets itself
    return true;
}

/// Whether one of the neighbours, in no particular order, shares but one triangle with the point.
bool Simplifier::isOpen() const {
    std::vector<std::uint32_t> ends;
    for (const Neighbour& neighbour : ring_)
        ends.insert(ends.end(), {neighbour.point, neighbour.next});
    std::ranges::sort(ends);
    for (std::size_t i = 0; i < ends.size();) {
        const std::size_t first = i;
        while (i < ends.size() && ends[i] == ends[first]) ++i;
        if (i == first + 1)
            return true;
    }
    return false;
}

/// Whether the point and ring_[target] have but two neighbours in common, so that no two faces fall
/// onto each other, and the target looks the same from both sides of the edge between them.
bool Simplifier::isSimple(std::size_t target) {
    const Neighbour& neighbour = ring_[target];
    const Neighbour& previous = target > 0 ? ring_[target - 1] : ring_.back();
    const Face& before = faces_[previous.face];
    for (const Corner& corner : before.corners)
        if (corner.point == neighbour.point && corner.vertex != neighbour.vertex)
            return false;
    const std::uint32_t left = previous.point;
    const std::uint32_t right = neighbour.next;
    bool isSimple = true;
    forCorners(neighbour.point, [&](std::uint32_t index, std::uint32_t) {
        for (const Corner& corner : faces_[index].corners)
            if (mark_[corner.point] == marking_ && corner.point != neighbour.point &&
                corner.point != left && corner.point != right)
                isSimple = false;
    });
    return isSimple;
}

/// The star of the point whose ring_ this is.
Star Simplifier::star(std::uint32_t point) const {
    std::array<glm::dvec3, kMaxStar> ring;
    for (std::size_t i = 0; i < ring_.size(); ++i) ring[i] = points_[ring_[i].point];
    return {points_[point], std::span(ring).first(ring_.size())};
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
        before.hold(shifts_[ring_[static_cast<std::size_t>(std::countr_zero(left))].face]);
    return moved(before, star, replaced.shift);
}

/// `valueAt`, of a corner, on the star of the point whose ring_ this is, with what `changes` has of
/// its faces.
template <typename ValueAt>
StarField Simplifier::fieldAround(std::uint32_t point, std::span<const FieldChanges> changes,
                                  const ValueAt& valueAt) const {
    const auto at = [&](std::uint32_t face, std::uint32_t of) {
        return valueAt(*std::ranges::find(faces_[face].corners, of, &Corner::point));
    };
    StarField field(at(ring_[0].face, point));
    for (const Neighbour& neighbour : ring_)
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
    return firstVertices_[corner.point] == corner.vertex ? firstNormals_[corner.point]
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
    for (const Neighbour& neighbour : ring_) before.hold(shifts_[neighbour.face]);
    for (std::size_t target = 0; target < ring_.size(); ++target) {
        if ((excluded >> target & 1) != 0)
            continue;
        const auto landing = star.landing(target);
        if (!landing)
            continue;
        double length = kLengthWeight * glm::length(points_[ring_[target].point] - points_[point]);
        // The triangle that the centre lands in takes the points of all.
        double least = moved(before, star, landing->shift).longest();
        if (colours) {
            const auto [tint, reach] = colourAtCentre(*colours, star, target, *landing);
            length *= 1 + double{tint / kColourTolerance};
            least = std::max(least, reach);
        }
        ways[count++] = {target, length, least + length, *landing};
    }
    std::pair best(ring_.size(), std::numeric_limits<double>::infinity());
    Star::Outcome outcome;
    const auto isLess = [](const Way& a, const Way& b) { return a.least < b.least; };
    for (std::size_t done = 0; done < count; ++done) {
        Way& way = *std::min_element(&ways[done], &ways[count], isLess);
        if (way.least >= kWorthALook * best.second)
            break;
        std::swap(way, ways[done]);
        const auto& [target, length, least, landing] = ways[done];
        star.moveTo(target, landing, outcome);
        const std::size_t centre = (target + landing.triangle) % ring_.size();
        const Star::Shift there = outcome[centre].shift;
        double cost = moved(before, star, there).longest() + length;
        // Others hold points that it holds, too: only one that goes farther can cost more.
        for (std::size_t i = 0; i < ring_.size() && cost < best.second; ++i)
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
    if (!gatherRing(point) || isStaying_[point])
        return {};
    const Star star = this->star(point);
    if (!star.isFlat())
        return {};
    const std::optional<StarField> colours = coloursAround(point);
    for (std::uint32_t excluded = 0;;) {
        const auto [target, cost] = cheapest(point, star, colours, excluded);
        if (target == ring_.size())
            return {};
        if (!mustBeSimple || isSimple(target))
            return {ring_[target].point, cost};
        excluded |= 1U << target;
    }
}

/// Of a point around which nothing has changed. False, with nothing done, when faces would fall
/// onto each other.
bool Simplifier::collapse(std::uint32_t point, std::uint32_t target) {
    gatherRing(point);
    const auto to = std::find_if(ring_.begin(), ring_.end(), [target](const Neighbour& neighbour) {
        return neighbour.point == target;
    });
    const auto place = static_cast<std::size_t>(to - ring_.begin());
    if (!isSimple(place))
        return false;
    for (const Neighbour& neighbour : ring_) __builtin_prefetch(&normals_[neighbour.face]);
    Star::Outcome outcome;
    const Star star = this->star(point);
    const Star::Landing landing = *star.landing(place);
    star.moveTo(place, landing, outcome);
    std::array<Shifts, kMaxStar> shifts;
    for (std::size_t i = 0; i < ring_.size(); ++i) shifts[i] = shiftsOf(star, outcome[i]);
    const auto follow = [&](const StarField& field, std::vector<FieldChanges>& changes) {
        field.forLeft(star, place, landing, outcome,
                      [&](std::size_t i, const FieldChanges& now, const FieldRange&) {
                          changes[ring_[i].face] = now;
                      });
    };
    if (const auto colours = coloursAround(point))
        follow(*colours, tints_);
    follow(normalsAround(point), normals_);
    for (std::size_t i = 0; i < ring_.size(); ++i) {
        Face& face = faces_[ring_[i].face];
        shifts_[ring_[i].face] = shifts[i];
        face.isThere = outcome[i].triangles != 0;
        isStale_[ring_[i].point] = true;
        if (best_[ring_[i].point].target == kNone && isInner_[ring_[i].point])
            queue_.push(candidate(0, ring_[i].point));  // to be looked at again
    }
    moveCorners(point, to->point, to->vertex);
    left_ -= 2;
    return true;
}

/// Those at `from` become corners at `onto`, before those that are there.
void Simplifier::moveCorners(std::uint32_t from, std::uint32_t onto, std::uint32_t vertex) {
    const Corners moving = std::exchange(around_[from], {});
    const Corners there = around_[onto];
    const std::size_t begin = corners_.size();
    for (std::size_t i = moving.count; i-- > 0;) {
        const CornerId at = corners_[moving.begin + i];
        faces_[at.face()].corners[at.corner()] = {vertex, onto};
        corners_.push_back(at);
    }
    for (std::size_t i = 0; i < there.count; ++i) {
        const CornerId at = corners_[there.begin + i];
        corners_.push_back(at);
    }
    around_[onto] = {begin, moving.count + there.count};
}

/// The point that was just looked at, before anything changed.
void Simplifier::count(std::uint32_t point) {
    ++counts_.all;
    if (isStaying_[point])
        ++counts_.staying;
    else if (!isRing_)
        ++(isOpen() ? counts_.onBorder : counts_.staying);
}

Simplified Simplifier::run(std::size_t target) {
    const auto look = [&](std::uint32_t point, bool mustBeSimple = false) {
        best_[point] = bestCollapse(point, mustBeSimple);
        isStale_[point] = false;
        if (best_[point].target != kNone)
            queue_.push(candidate(best_[point].cost, point));
    };
    for (std::uint32_t point = 0; point < points_.size(); ++point) {
        look(point);
        isInner_.push_back(isRing_ && !isStaying_[point]);
        count(point);
    }
    const auto border = static_cast<std::size_t>(std::ranges::count(isInner_, false));
    Simplified result;
    result.points = counts_;
    result.target = target + std::min(border, points_.size() - border) / 2;
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
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        const auto& corners = faces_[i].corners;
        if (!faces_[i].isThere)
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
                    std::span<const std::uint8_t> staying) {
    return Simplifier(mesh, patch, staying).run(target);
}

}  // namespace eyrie::mesh
