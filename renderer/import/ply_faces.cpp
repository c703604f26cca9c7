// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_faces.h"

#include <algorithm>
#include <span>
#include <tuple>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/ply_values.h"
#include "renderer/import/polygon.h"

namespace eyrie::import {
namespace {

using Corners = std::array<std::uint32_t, 3>;

}  // namespace

template <typename Values>
absl::Status PlyFaces<Values>::addPolygon(std::uint64_t face, std::uint64_t corners) {
    // A corner's index, the triangle that it makes, and as much again while arrays grow.
    constexpr std::uint64_t kCornerBytes = 2 * (sizeof(std::uint32_t) + sizeof(Corners));
    if (memoryBytes_ != 0 && polygonCorners_.size() + corners > memoryBytes_ / kCornerBytes)
        return absl::ResourceExhaustedError(fmt::format(
            "face {}: with it the polygons take more than the {} MiB of memory that the import may "
            "use; triangulate it before export, so that it is imported part by part, or allow more "
            "memory",
            face, memoryBytes_ >> 20));
    polygons_.push_back({face, polygonCorners_.size(), corners});
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyFaces<Values>::readFace(const PlyProperty& property, std::uint64_t index,
                                        std::uint64_t count) {
    if (count < 3) {
        ++body_.mesh.droppedFaces;
        return body_.values.skip(property.type, count) ? absl::OkStatus()
                                                       : body_.unreadable(property.name, index);
    }
    Corners triangle{};
    if (count > 3 && body_.isPiecewise())
        return body_.wrong(fmt::format("count of {}", property.name), index,
                           fmt::format("{}", count),
                           "triangles of a mesh that does not fit the memory it may have",
                           "triangulate it before export, or allow more memory");
    if (count > 3)
        RETURN_IF_ERROR(addPolygon(index, count));
    for (std::uint64_t i = 0; i < count; ++i) {
        std::int64_t corner = 0;
        if (!body_.values.integer(property.type, corner))
            return body_.unreadable(property.name, index);
        if (static_cast<std::uint64_t>(corner) >= body_.vertexCount())
            return body_.wrongCorner(index, i, corner);
        if (count == 3)
            triangle[i] = static_cast<std::uint32_t>(corner);
        else
            polygonCorners_.push_back(static_cast<std::uint32_t>(corner));
    }
    if (count == 3)
        body_.mesh.triangles.push_back(triangle);
    return absl::OkStatus();
}

template <typename Values>
void PlyFaces<Values>::extend(Strip& strip, std::uint32_t corner) {
    if (strip.corners >= 2) {
        const bool isTurned = strip.corners % 2 != 0;
        body_.mesh.triangles.push_back(
            {strip.last[isTurned ? 1 : 0], strip.last[isTurned ? 0 : 1], corner});
    }
    strip.last = {strip.last[1], corner};
    ++strip.corners;
}

template <typename Values>
absl::Status PlyFaces<Values>::readStrip(const PlyProperty& property, std::uint64_t index,
                                         std::uint64_t count) {
    Strip strip;
    for (std::uint64_t i = 0; i < count; ++i) {
        RETURN_IF_ERROR(body_.poll(i));
        std::int64_t corner = 0;
        if (!body_.values.integer(property.type, corner))
            return body_.unreadable(property.name, index);
        if (corner == -1)
            strip = {};
        else if (static_cast<std::uint64_t>(corner) >= body_.vertexCount())
            return body_.wrongCorner(index, i, corner);
        else
            extend(strip, static_cast<std::uint32_t>(corner));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyFaces<Values>::readList(const PlyProperty& property, std::uint64_t index) {
    std::uint64_t count = 0;
    RETURN_IF_ERROR(body_.readCount(property, index, count));
    return body_.element().name == "face" ? readFace(property, index, count)
                                          : readStrip(property, index, count);
}

template <typename Values>
absl::Status PlyFaces<Values>::readPlaces(std::uint64_t index) {
    const PlyProperty& property = *layout_.ofFaces;
    std::uint64_t count = 0;
    RETURN_IF_ERROR(body_.readCount(property, index, count));
    places_.resize(count);
    for (double& place : places_)
        if (!body_.values.number(property.type, place))
            return body_.unreadable(property.name, index);
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyFaces<Values>::readTexturedFace(const PlyProperty* corners, std::uint64_t index) {
    const std::size_t triangles = body_.mesh.triangles.size();
    const std::size_t cornersBefore = polygonCorners_.size();
    double number = 0;
    places_.clear();
    for (const PlyProperty& property : body_.element().properties) {
        if (&property == corners)
            RETURN_IF_ERROR(readList(property, index));
        else if (&property == layout_.ofFaces)
            RETURN_IF_ERROR(readPlaces(index));
        else if (&property != layout_.number)
            RETURN_IF_ERROR(body_.skip(property, index));
        else if (!body_.values.number(property.type, number))
            return body_.unreadable(property.name, index);
    }
    const std::size_t count = body_.mesh.triangles.size() > triangles
                                  ? std::tuple_size_v<Corners>
                                  : polygonCorners_.size() - cornersBefore;
    textures_.addFace(index, count, places_, number, triangles);
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyFaces<Values>::readTexturedFaces() {
    const PlyProperty* const corners = findCorners(body_.element());
    for (std::uint64_t i = 0; i < body_.element().count; ++i) {
        RETURN_IF_ERROR(body_.begin(i));
        RETURN_IF_ERROR(readTexturedFace(corners, i));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyFaces<Values>::triangulatePolygons() {
    for (const Polygon& polygon : polygons_) {
        RETURN_IF_ERROR(body_.control().check());
        const std::span<const std::uint32_t> corners =
            std::span(polygonCorners_).subspan(polygon.firstCorner, polygon.cornerCount);
        if (!triangulatePolygon(body_.mesh.positions, corners, body_.mesh.triangles))
            return absl::InvalidArgumentError(fmt::format(
                "face {}: found a concave polygon of {} corners, expected at most {}; triangulate "
                "it before export",
                polygon.face, corners.size(), kMaxConcaveCorners));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyFaces<Values>::read() {
    const PlyElement& element = body_.element();
    const bool areFaces = element.name == "face";
    if (areFaces)
        body_.mesh.triangles.reserve(
            body_.roomFor(std::min(element.count, body_.values.bytesLeft() / 4)));
    if (areFaces && isTextured_ && layout_.isByFace())
        return readTexturedFaces();
    const PlyProperty* const corners = findCorners(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
        RETURN_IF_ERROR(body_.begin(i));
        for (const PlyProperty& property : element.properties)
            RETURN_IF_ERROR(&property == corners ? readList(property, i) : body_.skip(property, i));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyFaces<Values>::finish(const std::string& path) {
    if (isTextured_)
        RETURN_IF_ERROR(
            textures_.applyTo(body_.mesh, polygonCorners_, textureNames(body_.header(), path)));
    return triangulatePolygons();
}

template class PlyFaces<AsciiValues>;
template class PlyFaces<BinaryValues<false>>;
template class PlyFaces<BinaryValues<true>>;

}  // namespace eyrie::import
