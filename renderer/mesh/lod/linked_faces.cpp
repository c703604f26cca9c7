// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/linked_faces.h"

#include <bit>
#include <utility>

#include "renderer/mesh/lod/star.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

}  // namespace

LinkedFaces::LinkedFaces(const PackedMesh& mesh, std::span<const Triangle> triangles) {
    faces_.reserve(triangles.size());
    for (const Triangle& triangle : triangles) {
        Face face;
        for (std::size_t corner = 0; corner < 3; ++corner)
            face.corners[corner] = {triangle[corner], kNone};
        faces_.push_back(face);
    }
    numberPoints(mesh);
    gatherCorners();
    mark_.resize(points(), 0);
}

/// As they come, with an open hash table.
void LinkedFaces::numberPoints(const PackedMesh& mesh) {
    std::vector<std::uint32_t> slots(std::bit_ceil(faces_.size() * 3 + 2), kNone);
    std::vector<std::uint64_t> positions;
    const auto pointAt = [&](std::uint32_t vertex) {
        const std::uint64_t position = mesh.positions[vertex];
        std::size_t slot = (position * 0x9E3779B97F4A7C15ULL >> 32) & (slots.size() - 1);
        while (slots[slot] != kNone && positions[slots[slot]] != position)
            slot = (slot + 1) & (slots.size() - 1);
        if (slots[slot] == kNone) {
            slots[slot] = static_cast<std::uint32_t>(places_.size());
            positions.push_back(position);
            places_.emplace_back(unpackPosition(position));
            firstVertices_.push_back(vertex);
            around_.emplace_back();
        }
        return slots[slot];
    };
    for (Face& face : faces_)
        for (Corner& corner : face.corners) {
            corner.point = pointAt(corner.vertex);
            ++around_[corner.point].count;
        }
}

/// around_ has their numbers.
void LinkedFaces::gatherCorners() {
    std::size_t end = 0;
    for (Corners& corners : around_) corners.begin = end += std::exchange(corners.count, 0);
    corners_.resize(end, CornerId(0, 0));
    for (std::uint32_t face = 0; face < faces_.size(); ++face)
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            Corners& corners = around_[faces_[face].corners[corner].point];
            corners_[--corners.begin] = {face, corner};
            ++corners.count;
        }
}

template <typename Visit>
void LinkedFaces::forCorners(std::uint32_t point, const Visit& visit) {
    Corners& corners = around_[point];
    const std::span all(corners_.data() + corners.begin, corners.count);
    corners.count = 0;
    for (const CornerId at : all)
        if (faces_[at.face()].isThere) {
            all[corners.count++] = at;  // those that are gone are forgotten now
            visit(at.face(), at.corner());
        }
}

bool LinkedFaces::gatherRing(std::uint32_t point) {
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
    });
    isRing_ = ring_.size() >= 3 && ring_.size() <= kMaxStar && sortRing();
    return isRing_ && isWhole;
}

/// Brings the neighbours in turn; false when they are no closed ring.
bool LinkedFaces::sortRing() {
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

bool LinkedFaces::isOpen() const {
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

bool LinkedFaces::isSimple(std::size_t target) {
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

void LinkedFaces::moveCorners(std::uint32_t from, std::uint32_t onto, std::uint32_t vertex) {
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

}  // namespace eyrie::mesh
