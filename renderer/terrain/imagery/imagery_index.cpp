// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/imagery_index.h"

#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>

namespace eyrie::terrain {
namespace {

struct ImageryHeader {
    std::array<char, 8> magic = {'I', 'M', 'A', 'G', 'E', 'R', 'Y', '1'};
    std::int32_t texelShift = 0;
    std::uint32_t tileCount = 0;
    double psnrDb = 0;
    std::uint64_t coveredTexels = 0;
};
static_assert(sizeof(ImageryHeader) == 32 && std::is_trivially_copyable_v<ImageryHeader>);

constexpr std::uint64_t kMaxPageBytes = 1 << 20;  ///< about six times what no codec could shrink

absl::Status corrupt(const std::string& name, const std::string& what) {
    return absl::DataLossError(
        fmt::format("{}: imagery: {}; import the terrain again", name, what));
}

}  // namespace

ImagerySummary summaryOf(const ImageryIndex& imagery) {
    ImagerySummary summary{.columns = static_cast<std::uint64_t>(imagery.pyramid.width(0)),
                           .rows = static_cast<std::uint64_t>(imagery.pyramid.height(0)),
                           .coveredTexels = imagery.coveredTexels,
                           .bytes = 0,
                           .psnrDb = imagery.psnrDb};
    for (const PageRecord& tile : imagery.tiles) summary.bytes += tile.bytes;
    return summary;
}

std::vector<std::byte> bytesOf(const ImageryIndex& imagery) {
    const ImageryHeader header{.texelShift = imagery.pyramid.texelShift(),
                               .tileCount = imagery.pyramid.tileCount(),
                               .psnrDb = imagery.psnrDb,
                               .coveredTexels = imagery.coveredTexels};
    std::vector<std::byte> bytes(sizeof header + imagery.tiles.size() * sizeof(PageRecord));
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(bytes.data() + sizeof header, imagery.tiles.data(),
                imagery.tiles.size() * sizeof(PageRecord));
    return bytes;
}

std::uint64_t recordBytes(std::uint64_t imageryBytes) {
    return imageryBytes < sizeof(ImageryHeader) ? 0 : imageryBytes - sizeof(ImageryHeader);
}

absl::StatusOr<ImageryIndex> imageryFrom(std::span<const std::byte> bytes, const Quadtree& quadtree,
                                         std::uint64_t pagesEnd, const std::string& name) {
    ImageryHeader header;
    if (bytes.size() < sizeof header)
        return corrupt(name, fmt::format("{} bytes are too few for its header", bytes.size()));
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.magic != ImageryHeader().magic)
        return corrupt(name, "its header does not begin with 'IMAGERY1'");
    if (!TexturePyramid::isPossible(quadtree.columns(), quadtree.rows(), header.texelShift))
        return corrupt(name, fmt::format("texelShift is {}, which no import makes of {} x {} posts",
                                         header.texelShift, quadtree.columns(), quadtree.rows()));
    ImageryIndex imagery;
    imagery.pyramid = TexturePyramid(quadtree.columns(), quadtree.rows(), header.texelShift);
    const std::uint64_t expected =
        sizeof header + std::uint64_t{imagery.pyramid.tileCount()} * sizeof(PageRecord);
    if (header.tileCount != imagery.pyramid.tileCount() || bytes.size() != expected)
        return corrupt(
            name, fmt::format("it has {} tiles in {} bytes, expected {} in {}", header.tileCount,
                              bytes.size(), imagery.pyramid.tileCount(), expected));
    if (std::isnan(header.psnrDb) || header.coveredTexels > imagery.finestTexels())
        return corrupt(name, fmt::format("psnrDb {} or coveredTexels {} are impossible",
                                         header.psnrDb, header.coveredTexels));
    imagery.psnrDb = header.psnrDb;
    imagery.coveredTexels = header.coveredTexels;
    imagery.tiles.resize(imagery.pyramid.tileCount());
    std::memcpy(imagery.tiles.data(), bytes.data() + sizeof header, bytes.size() - sizeof header);
    for (std::size_t k = 0; k < imagery.tiles.size(); ++k) {
        const PageRecord& tile = imagery.tiles[k];
        if (tile.offset > pagesEnd || tile.bytes > pagesEnd - tile.offset ||
            tile.bytes > kMaxPageBytes)
            return corrupt(name, fmt::format("tile {}: {} bytes at {} do not lie among the pages",
                                             k, tile.bytes, tile.offset));
    }
    return imagery;
}

}  // namespace eyrie::terrain
