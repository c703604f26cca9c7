// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>
#include <glm/vec3.hpp>

#include "fabric/box.h"
#include "fabric/lights.h"
#include "renderer/mesh/codec/exact_codec.h"
#include "renderer/mesh/lattice.h"
#include "renderer/mesh/material.h"
#include "renderer/mesh/node_block.h"
#include "renderer/page/page_source.h"

/// The .eym file, version 7: a mesh as a kd-tree of LOD nodes, each with pages of its own.
///
/// Little-endian:
///   EymHeader                       256 bytes
///   Node        [nodeCount]         depth first
///   Lid         [lidCount]
///   Material    [materialCount]     ... where something is textured, see-through or two-sided
///   ImageRecord [imageCount]
///   MaterialRange [rangeCount]      of the nodes that have triangles, in their order
///   PointRange  [pointRangeCount]   of the nodes that are drawn as points, in their order
///   Light       [lightCount]
///   Cone        [lightCount]        where one of them is a spot
///   pages                           of the nodes that have geometry, in their order: that of what
///                                   is drawn, and then, where kept, that of source positions
///   images                          (material.h)
/// A node's page, uncoded, is the block of node_block.h, as it is drawn; it then begins on a
/// multiple of 8 bytes. Coded (kIsCoded) it is that of codec/page_codec.h, and gives the same block
/// to the bit. Source positions are always coded (codec/exact_codec.h); only leaves have them.
/// A node's geometry is self-contained: 16-bit indices count from its own first vertex. Leaves have
/// geometry; inner nodes may: a simplification of their subtree, or points on it
/// (lod/point_sample.h), which are vertices without indices, with colours where the mesh has
/// colours or textures.
namespace eyrie::mesh {

static_assert(std::endian::native == std::endian::little, ".eym files are read as they are");

inline constexpr std::array<char, 8> kEymMagic = {'E', 'Y', 'M', 'E', 'S', 'H', '\0', '\x01'};
inline constexpr std::uint32_t kEymVersion = 7;

/// In EymHeader::flags.
inline constexpr std::uint32_t kHasColours = 1;
inline constexpr std::uint32_t kIsCoded = 2;         ///< pages are
inline constexpr std::uint32_t kHasExact = 4;        ///< leaves have source positions ...
inline constexpr std::uint32_t kExactIsFloat64 = 8;  ///< ... in double precision
inline constexpr std::uint32_t kHasTextures = 16;    ///< vertices have texture coordinates
inline constexpr std::uint32_t kHasCones = 32;       ///< there is one for each light

/// Levels a tree may have, so that a walk may recurse: the median split of 2^30 triangles makes 31.
inline constexpr int kMaxTreeDepth = 64;

struct EymHeader {
    std::array<char, 8> magic = kEymMagic;
    std::uint32_t version = kEymVersion;
    std::uint32_t headerBytes = 256;
    std::uint64_t fileBytes = 0;
    std::uint64_t checksum = 0;       ///< xxh64 of the header, this field being 0
    std::uint64_t nodesChecksum = 0;  ///< xxh64 of the node table
    std::uint64_t sourceHash = 0;     ///< xxh64 of the source file's bytes
    std::uint64_t triangleCount = 0;
    std::uint64_t sourceVertexCount = 0;  ///< vertices of the mesh, each counted once
    std::uint32_t nodeCount = 0;
    std::uint32_t flags = 0;
    std::array<double, 3> originMetres{};  ///< of the lattice
    double stepMetres = 1;
    double coarsestErrorMetres = 0;  ///< of the root
    double finestErrorMetres = 0;    ///< of the leaves
    /// Triangles a leaf may have, where a measurement chose that; otherwise 0.
    std::uint64_t tunedLeafTriangles = 0;
    std::uint64_t lidsChecksum = 0;  ///< xxh64 of the lids
    std::uint64_t lidCount = 0;
    std::uint64_t materialsChecksum = 0;  ///< xxh64 of the tables from materials to ranges
    std::uint32_t materialCount = 0;
    std::uint32_t imageCount = 0;
    std::uint32_t rangeCount = 0;
    std::uint32_t pointRangeCount = 0;
    std::uint64_t pointRangesChecksum = 0;  ///< xxh64 of the point ranges
    std::uint64_t lightsChecksum = 0;       ///< xxh64 of the lights and their cones, if any
    std::uint64_t lightCount = 0;           ///< at most fabric::kMaxLights
    /// Of the source, that the import wound the other way round; 0 in files of before it was told.
    std::uint64_t turnedTriangles = 0;
    std::array<std::uint64_t, 7> reserved{};
};
static_assert(sizeof(EymHeader) == 256);

/// One LOD node, as stored.
struct Node {
    glm::uvec3 boxMin{0U};   ///< lattice, closed; covers the source vertices of its triangles,
    glm::uvec3 boxMax{0U};   ///< lies inside its parent's
    std::int32_t left = -1;  ///< its own index plus one; -1 in a leaf
    std::int32_t right = -1;
    /// The full-resolution triangles it stands for, in depth-first order: the order in which pieces
    /// are drawn, and in which ranges share them out.
    std::uint64_t triangleBegin = 0;
    std::uint64_t triangleEnd = 0;
    std::uint64_t pageOffset = 0;    ///< from the file's start; of what is drawn
    std::uint64_t pageChecksum = 0;  ///< xxh64 of its bytes
    /// xxh64 of the uncoded page: whatever decodes one gets what the encoder meant.
    std::uint64_t blockChecksum = 0;
    std::uint64_t exactOffset = 0;  ///< of the page of source positions
    std::uint64_t exactChecksum = 0;
    std::uint32_t pageBytes = 0;
    std::uint32_t exactBytes = 0;
    std::uint16_t vertexCount = 0;
    std::uint16_t colourReach = 0;  ///< the upper half of colourReachMetres()
    std::uint32_t indexCount = 0;   ///< three a triangle; 0 of points, and without geometry
    /// Upper bound on the distance between the source surface and what is drawn for this node: its
    /// own geometry or, where it has none, its children. Never below its children's.
    float errorMetres = 0;
    /// The first indices, three a triangle, of triangles of which an eye outside the mesh's bounds
    /// sees no backs (back_faces.h) but through a lid: these need not be drawn. 0 where the mesh
    /// has materials: their ranges say it.
    std::uint32_t frontIndexCount = 0;
    /// Upper bound on the angle between the normal at any point of the node's own geometry, as
    /// blended from its vertices', and that of a point of the source within errorMetres, as blended
    /// from the leaves'. 0 of leaves and without geometry, 180 where nothing is known.
    float normalErrorDegrees = 0;
    /// Upper bound on the mean of that angle over the area of the node's geometry or, of points, of
    /// the surface that they are samples of.
    float normalErrorMeanDegrees = 0;

    /// At any point of what is drawn for this node the colour of its vertices, channel by channel
    /// and as displayed, is within 8/255 of those that the source has within this distance, or
    /// within errorMetres where that is more. 0 of leaves and without colours, never below its
    /// children's.
    float colourReachMetres() const {
        return std::bit_cast<float>(std::uint32_t{colourReach} << 16);
    }
    /// Bound on how far what is drawn for this node, or its colour, is from where the source has
    /// it: what is to be small on the screen.
    float farthestMetres() const { return std::max(errorMetres, colourReachMetres()); }
    bool isLeaf() const { return left < 0; }
    bool hasGeometry() const { return vertexCount > 0; }
    bool isOfPoints() const { return vertexCount > 0 && indexCount == 0; }
    bool operator==(const Node&) const = default;
};
static_assert(sizeof(Node) == 120);

/// The first points of a node, and what Node::errorMetres is of these alone. Ranges of a node have
/// more points and less error one after the other; the last has all of both.
struct PointRange {
    std::uint32_t node = 0;
    std::uint32_t points = 0;
    float errorMetres = 0;
    std::uint32_t reserved = 0;

    bool operator==(const PointRange&) const = default;
};
static_assert(sizeof(PointRange) == 16);

/// What the geometry of a node is of, in a file with these EymHeader::flags.
inline NodeShape shapeOf(const Node& node, std::uint32_t flags) {
    const bool hasColours = (flags & kHasColours) != 0;
    const bool hasTextures = (flags & kHasTextures) != 0;
    return {node.vertexCount, node.indexCount, hasColours || (node.isOfPoints() && hasTextures),
            hasTextures && !node.isOfPoints()};
}

/// Holds what closes a hole of the source's surface in thought (lids.h). Lattice, closed.
struct Lid {
    glm::uvec3 boxMin{0U};
    glm::uvec3 boxMax{0U};

    bool operator==(const Lid&) const = default;
};
static_assert(sizeof(Lid) == 24);

/// What the source has as a light (fabric/scene.h), object space.
struct Light {
    /// Metres; where it is or, without a reach, from the light into the scene.
    std::array<double, 3> place{};
    std::array<float, 3> colour{};  ///< linear
    float reachMetres = 0;          ///< 0: it is a distant one

    bool isDistant() const { return reachMetres == 0; }
    bool operator==(const Light&) const = default;
};
static_assert(sizeof(Light) == 40);

/// What a light at a place shines into (fabric::LightCone), object space.
struct Cone {
    std::array<double, 3> axis{};
    float innerDegrees = 0;
    float outerDegrees = 0;  ///< 0: it is no spot

    bool isSpot() const { return outerDegrees != 0; }
    bool operator==(const Cone&) const = default;
};
static_assert(sizeof(Cone) == 32);

/// An open .eym file. Any thread may call any function.
///
/// open() checks the header and every node; geometry() and exactPositions() check what they read.
/// So no file, however damaged, makes a reader take more memory than its tables, which open() may
/// limit, and a node have.
class EymFile {
public:
    /// `path` may be an address (page/remote_name.h): pages are then read one by one, through the
    /// cache of `options`. Errors: NotFound, PermissionDenied, InvalidArgument (not an .eym file,
    /// another version), DataLoss (truncated, or its tables are damaged); ResourceExhausted, before
    /// the tables are read, where they would take more than `mostMemoryBytes` or than can be had;
    /// of an address those of page::PageSource, too.
    static absl::StatusOr<EymFile> open(
        const std::string& path, const page::SourceOptions& options = {},
        std::uint64_t mostMemoryBytes = std::numeric_limits<std::uint64_t>::max());

    const std::string& path() const { return source_->name(); }
    /// What its tables take in memory.
    std::uint64_t tableMemoryBytes() const;
    const Lattice& lattice() const { return lattice_; }
    std::span<const Node> nodes() const { return nodes_; }  ///< never empty; [0] is the root
    bool hasColours() const { return (header_.flags & kHasColours) != 0; }
    bool isCoded() const { return (header_.flags & kIsCoded) != 0; }
    bool hasExactPositions() const { return (header_.flags & kHasExact) != 0; }
    std::uint64_t triangleCount() const { return header_.triangleCount; }
    std::uint64_t vertexCount() const { return header_.sourceVertexCount; }
    std::uint64_t sourceHash() const { return header_.sourceHash; }
    std::uint64_t fileBytes() const { return header_.fileBytes; }
    /// Of the header, which holds the tables', which hold the pages': of all of the file.
    std::uint64_t checksum() const { return header_.checksum; }
    double coarsestErrorMetres() const { return header_.coarsestErrorMetres; }
    double finestErrorMetres() const { return header_.finestErrorMetres; }
    /// Of a leaf, where measuring frames chose that number; otherwise 0.
    std::uint64_t tunedLeafTriangles() const { return header_.tunedLeafTriangles; }
    /// Of the source, that were wound the other way round in it.
    std::uint64_t turnedTriangles() const { return header_.turnedTriangles; }
    int levels() const { return levels_; }  ///< nodes on the longest way from root to leaf

    fabric::Box bounds() const { return bounds(0); }  ///< object space, metres
    fabric::Box bounds(std::uint32_t node) const;
    /// Through these only an eye outside sees backs of what need not be drawn from behind. Object
    /// space, metres.
    std::vector<fabric::Box> lids() const;
    NodeShape shape(std::uint32_t node) const { return shapeOf(nodes_[node], header_.flags); }

    bool hasTextures() const { return (header_.flags & kHasTextures) != 0; }
    std::span<const Material> materials() const { return materials_; }
    std::span<const ImageRecord> images() const { return images_; }
    /// That a node's indices make up; none where the mesh has no materials.
    std::span<const MaterialRange> ranges(std::uint32_t node) const {
        if (ranges_.empty())
            return {};
        return std::span(ranges_).subspan(firstRange_[node],
                                          firstRange_[node + 1] - firstRange_[node]);
    }
    /// Of a node that is drawn as points, and otherwise none.
    std::span<const PointRange> pointRanges(std::uint32_t node) const;
    /// Object space.
    const fabric::FileLights& lights() const { return lights_; }
    /// Image::blocks of an image. Precondition: image < images().size(). Errors: as of geometry().
    absl::StatusOr<std::vector<std::byte>> imageBlocks(std::uint32_t image) const;

    /// Reads and decodes a node's page. Precondition: node < nodes().size(). Errors: DataLoss,
    /// naming file and node, when it is damaged; those of page::PageSource::read.
    absl::StatusOr<NodeGeometry> geometry(std::uint32_t node) const;

    /// The source's own position of each vertex of a leaf, as geometry() numbers them.
    /// Preconditions: hasExactPositions(), nodes()[node].isLeaf(). Errors: those of geometry().
    absl::StatusOr<std::vector<fabric::Vec3>> exactPositions(std::uint32_t node) const;

private:
    explicit EymFile(std::unique_ptr<page::PageSource> source) : source_(std::move(source)) {}

    absl::Status readTables(std::uint64_t mostMemoryBytes);
    absl::Status readLids();
    absl::Status readMaterials();
    absl::Status readPointRanges();
    absl::Status readLights();
    absl::StatusOr<NodeGeometry> readBlock(std::uint32_t node) const;
    absl::Status inNode(std::uint32_t node, const absl::Status& status) const;

    std::unique_ptr<page::PageSource> source_;
    EymHeader header_;
    Lattice lattice_;
    std::vector<Node> nodes_;
    std::vector<Lid> lids_;
    std::vector<Material> materials_;
    std::vector<ImageRecord> images_;
    std::vector<MaterialRange> ranges_;
    std::vector<std::uint32_t> firstRange_;  ///< of each node, and the end
    std::vector<PointRange> pointRanges_;
    fabric::FileLights lights_;
    int levels_ = 0;
};

/// Bytes of the tables of materials, images and ranges.
constexpr std::uint64_t materialTableBytes(const EymHeader& header) {
    return std::uint64_t{header.materialCount} * sizeof(Material) +
           std::uint64_t{header.imageCount} * sizeof(ImageRecord) +
           std::uint64_t{header.rangeCount} * sizeof(MaterialRange);
}

/// Checksum of a header. `header.checksum` does not enter.
std::uint64_t headerChecksum(const EymHeader& header);

/// Where the nodes end and the lids begin.
inline std::uint64_t endOfNodes(const EymHeader& header) {
    return sizeof(EymHeader) + std::uint64_t{header.nodeCount} * sizeof(Node);
}

/// Where the lids end and the tables of materials begin.
inline std::uint64_t endOfLids(const EymHeader& header) {
    return endOfNodes(header) + header.lidCount * sizeof(Lid);
}

/// Where the tables of materials end and the point ranges begin.
inline std::uint64_t endOfMaterials(const EymHeader& header) {
    return endOfLids(header) + materialTableBytes(header);
}

/// How many cones there are.
constexpr std::uint64_t coneCount(const EymHeader& header) {
    return (header.flags & kHasCones) != 0 ? header.lightCount : 0;
}

/// Where the point ranges end and the lights begin.
inline std::uint64_t endOfPointRanges(const EymHeader& header) {
    return endOfMaterials(header) + std::uint64_t{header.pointRangeCount} * sizeof(PointRange);
}

/// xxh64 of bytes, as all checksums of the file are.
std::uint64_t contentHash(std::span<const std::byte> bytes);

/// xxh64 of a file's bytes: what `EymFile::sourceHash` is compared with to see whether an import is
/// up to date. Errors: those of MappedFile::open.
absl::StatusOr<std::uint64_t> contentHash(const std::string& path);

}  // namespace eyrie::mesh
