// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/byte_colours.h"
#include "renderer/import/ply_textures.h"
#include "renderer/import/ply_values.h"

namespace eyrie::import {
namespace {

constexpr std::array<std::string_view, 3> kAxisNames = {"x", "y", "z"};

}  // namespace

template <typename Values>
absl::Status PlyVertices<Values>::store(const VertexLayout& layout, const VertexRow& row,
                                        std::uint64_t index) {
    TriangleMesh& mesh = body_.mesh;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!std::isfinite(row[axis]))
            return body_.wrong(kAxisNames[axis], index, fmt::format("{}", row[axis]),
                               "a finite coordinate", "remove or repair the vertex");
    mesh.positions.emplace_back(row[0], row[1], row[2]);
    if (layout.hasThree(kNormalX))
        mesh.normals.emplace_back(static_cast<float>(row[3]), static_cast<float>(row[4]),
                                  static_cast<float>(row[5]));
    if (layout.hasThree(kRed)) {
        const auto byteOf = [&](std::size_t slot) {
            return colourByte(row[slot], layout.types[slot], bytes_);
        };
        const std::uint8_t opacity = layout.isFilled[kAlpha]
                                         ? opacityByte(row[kAlpha], layout.types[kAlpha], bytes_)
                                         : std::uint8_t{255};
        mesh.colours.push_back({byteOf(kRed), byteOf(kRed + 1), byteOf(kRed + 2), opacity});
        notOpaque_ += opacity < 255 ? 1 : 0;
    }
    if (layout.hasPlaces())
        mesh.textureCoordinates.push_back(placeFrom(row[kU], row[kV]));
    return absl::OkStatus();
}

/// Reads ahead, as far as it takes to know how far colours reach. What cannot be read is told by
/// read().
template <typename Values>
absl::Status PlyVertices<Values>::measureColours(const VertexLayout& layout, double& mostReal,
                                                 double& mostWide) {
    const PlyElement& element = body_.element();
    bool hasReals = false, hasWide = false;
    for (std::size_t slot = kRed; slot <= kAlpha; ++slot) {
        hasReals = hasReals || (slot < kAlpha && layout.isReal(slot));
        hasWide = hasWide || layout.isWide(slot);
    }
    const auto isOpen = [&] {
        return (hasReals && mostReal <= kMostOfFractions) || (hasWide && mostWide <= kMostOfBytes);
    };
    bool canBeRead = true;
    for (std::uint64_t i = 0; i < element.count && canBeRead && isOpen(); ++i) {
        if (i % PlyBody<Values>::kPiece == 0) {
            RETURN_IF_ERROR(body_.handOver());
            RETURN_IF_ERROR(body_.control().check());
        }
        for (std::size_t p = 0; p < layout.slots.size() && canBeRead; ++p) {
            const PlyProperty& property = element.properties[p];
            const std::size_t slot = layout.slots[p];
            const bool isReal = slot >= kRed && slot < kAlpha && layout.isReal(slot);
            const bool isWide = slot >= kRed && slot <= kAlpha && layout.isWide(slot);
            double value = 0;
            canBeRead = isReal || isWide ? body_.values.number(property.type, value)
                                         : body_.skip(property, i).ok();
            double& most = isReal ? mostReal : mostWide;
            most = std::max(most, value);
        }
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyVertices<Values>::lookForBytes(const VertexLayout& layout) {
    const Values start = body_.values;
    double mostReal = 0, mostWide = 0;
    RETURN_IF_ERROR(measureColours(layout, mostReal, mostWide));
    body_.values = start;
    bytes_ = {mostReal > kMostOfFractions, mostWide <= kMostOfBytes};
    isOddlyOfBytes_ = bytes_.areReals || (bytes_.areWide && mostWide > 0);
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyVertices<Values>::read() {
    const PlyElement& element = body_.element();
    const VertexLayout layout(element, withPlaces_);
    const std::uint64_t room = body_.roomFor(element.count);
    body_.mesh.positions.reserve(room);
    body_.mesh.normals.reserve(layout.hasThree(kNormalX) ? room : 0);
    body_.mesh.colours.reserve(layout.hasThree(kRed) ? room : 0);
    body_.mesh.textureCoordinates.reserve(layout.hasPlaces() ? room : 0);
    if (layout.hasThree(kRed))
        RETURN_IF_ERROR(lookForBytes(layout));
    VertexRow row{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
        RETURN_IF_ERROR(body_.begin(i));
        for (std::size_t p = 0; p < layout.slots.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            const std::size_t slot = layout.slots[p];
            if (slot == kIgnored)
                RETURN_IF_ERROR(body_.skip(property, i));
            else if (!body_.values.number(property.type, row[slot]))
                return body_.unreadable(property.name, i);
        }
        RETURN_IF_ERROR(store(layout, row, i));
    }
    return absl::OkStatus();
}

template <typename Values>
void PlyVertices<Values>::addNotes(bool isTextured) const {
    if (isOddlyOfBytes_)
        body_.mesh.notes.emplace_back(kColoursAreBytes);
    if (notOpaque_ > 0)
        body_.mesh.notes.push_back(fmt::format(
            "{} vertices are not opaque, which is left out{}: for see-through surfaces export it "
            "as glTF",
            notOpaque_, isTextured ? " where no texture is see-through" : ""));
}

template class PlyVertices<AsciiValues>;
template class PlyVertices<BinaryValues<false>>;
template class PlyVertices<BinaryValues<true>>;

}  // namespace eyrie::import
