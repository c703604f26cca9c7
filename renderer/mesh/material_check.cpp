// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/mesh/damaged.h"
#include "renderer/mesh/eym_check.h"

namespace eyrie::mesh {
namespace {

absl::Status checkMaterial(const EymHeader& header, std::size_t index, const Material& material) {
    if (material.image < -1 ||
        (material.hasImage() && (static_cast<std::uint32_t>(material.image) >= header.imageCount ||
                                 (header.flags & kHasTextures) == 0)))
        return damaged(
            fmt::format("material {}: image", index), material.image,
            fmt::format("-1, or, with texture coordinates, less than {}", header.imageCount));
    constexpr std::uint32_t kKnown = kIsBlended | kIsTwoSided | kIsOneSided;
    if ((material.flags & ~kKnown) != 0 || (material.isOneSided() && material.isTwoSided()))
        return damaged(fmt::format("material {}: flags", index), material.flags,
                       fmt::format("bits of {}, not of both one and two sides", kKnown));
    if (!(material.alphaCutoff >= 0 && material.alphaCutoff <= 1))
        return damaged(fmt::format("material {}: alphaCutoff", index), material.alphaCutoff,
                       "0 to 1");
    return absl::OkStatus();
}

absl::Status checkImage(const EymHeader& header, std::size_t index, const ImageRecord& record) {
    const ImageShape& shape = record.shape;
    const auto inLimits = [](std::uint32_t side) { return side >= 1 && side <= kMaxImageSide; };
    if (!inLimits(shape.width) || !inLimits(shape.height))
        return damaged(fmt::format("image {}: size", index),
                       fmt::format("{} x {}", shape.width, shape.height),
                       fmt::format("1 to {} texels a side", kMaxImageSide));
    constexpr std::uint32_t kKnown = kHasAlpha | kClampsU | kClampsV;
    if ((shape.flags & ~kKnown) != 0 || !(shape.rmsError >= 0 && shape.rmsError <= 255))
        return damaged(fmt::format("image {}: flags and rmsError", index),
                       fmt::format("{} and {}", shape.flags, shape.rmsError),
                       fmt::format("bits of {}, and 0 to 255", kKnown));
    if (record.bytes != shape.bytesFrom(0) || record.offset < endOfTables(header) ||
        record.offset > header.fileBytes || record.bytes > header.fileBytes - record.offset)
        return damaged(fmt::format("image {}: blocks", index),
                       fmt::format("{} bytes at {}", record.bytes, record.offset),
                       fmt::format("{} bytes from {} to {}", shape.bytesFrom(0),
                                   endOfTables(header), header.fileBytes));
    return absl::OkStatus();
}

absl::Status checkRange(std::size_t index, std::size_t materials, const MaterialRange& range) {
    if (range.material >= materials)
        return damaged(fmt::format("range {}: material", index), range.material,
                       fmt::format("less than {}", materials));
    if (range.indexCount == 0 || range.indexCount % 3 != 0 || range.frontIndexCount % 3 != 0 ||
        range.frontIndexCount > range.indexCount)
        return damaged(fmt::format("range {}: indexCount and frontIndexCount", index),
                       fmt::format("{} and {}", range.indexCount, range.frontIndexCount),
                       "multiples of 3, the first above 0 and not below the second");
    return absl::OkStatus();
}

}  // namespace

absl::Status checkMaterials(const EymHeader& header, std::span<const Node> nodes,
                            const MaterialTables& tables) {
    for (std::size_t i = 0; i < tables.materials.size(); ++i)
        RETURN_IF_ERROR(checkMaterial(header, i, tables.materials[i]));
    for (std::size_t i = 0; i < tables.images.size(); ++i)
        RETURN_IF_ERROR(checkImage(header, i, tables.images[i]));
    std::size_t at = 0;
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
        std::uint64_t covered = 0;
        for (; at < tables.ranges.size() && tables.ranges[at].node == node; ++at) {
            RETURN_IF_ERROR(checkRange(at, tables.materials.size(), tables.ranges[at]));
            covered += tables.ranges[at].indexCount;
        }
        if (covered != nodes[node].indexCount || nodes[node].frontIndexCount != 0)
            return damaged(
                fmt::format("node {}: ranges", node),
                fmt::format("{} indices, {} of them fronts", covered, nodes[node].frontIndexCount),
                fmt::format("{} and 0", nodes[node].indexCount));
    }
    if (at != tables.ranges.size())
        return damaged(fmt::format("range {}: node", at), tables.ranges[at].node,
                       fmt::format("ascending, less than {}", nodes.size()));
    return absl::OkStatus();
}

}  // namespace eyrie::mesh
