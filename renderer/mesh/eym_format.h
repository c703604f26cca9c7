// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <absl/status/statusor.h>
#include <glm/vec3.hpp>

#include "fabric/box.h"
#include "renderer/mesh/lattice.h"
#include "renderer/mesh/mapped_file.h"
#include "renderer/page/page_source.h"

/// The .eym file, version 1: a mesh as a kd-tree of LOD nodes, read in place through a mapping.
///
/// Little-endian, every section on a multiple of 8 bytes, in this order:
///   EymHeader                       256 bytes
///   Node        [nodeCount]         depth first
///   uint64      [vertexCount]       positions (vertex_packing.h), node after node
///   uint32      [vertexCount]       normals
///   uint32      [vertexCount]       colours, only with kHasColours
///   uint16      [indexCount]        each node's from a multiple of four on, zeros between
/// A node's geometry is self-contained: 16-bit indices count from its own first vertex. Leaves have
/// geometry; inner nodes may: a simplification of their subtree (their share of the arrays is empty
/// where they have none).
namespace eyrie::mesh {

static_assert(std::endian::native == std::endian::little, ".eym files are mapped as they are");

inline constexpr std::array<char, 8> kEymMagic = {'E', 'Y', 'M', 'E', 'S', 'H', '\0', '\x01'};
inline constexpr std::uint32_t kEymVersion = 1;
inline constexpr std::uint32_t kHasColours = 1;  ///< in EymHeader::flags

/// Levels a tree may have, so that a walk may recurse: the median split of 2^30 triangles makes 31.
inline constexpr int kMaxTreeDepth = 64;

struct EymHeader {
    std::array<char, 8> magic = kEymMagic;
    std::uint32_t version = kEymVersion;
    std::uint32_t headerBytes = 256;
    std::uint64_t fileBytes = 0;
    std::uint64_t checksum = 0;    ///< xxh64 of header and node table, this field being 0
    std::uint64_t sourceHash = 0;  ///< xxh64 of the source file's bytes
    std::uint64_t triangleCount = 0;
    std::uint64_t sourceVertexCount = 0;  ///< vertices of the mesh, each counted once
    std::uint64_t vertexCount = 0;        ///< stored vertices: one on a border is in several nodes
    std::uint64_t indexCount = 0;         ///< stored indices, those between nodes included
    std::uint32_t nodeCount = 0;
    std::uint32_t flags = 0;
    std::array<double, 3> originMetres{};  ///< of the lattice
    double stepMetres = 1;
    double coarsestErrorMetres = 0;  ///< of the root
    double finestErrorMetres = 0;    ///< of the leaves
    std::uint64_t nodesOffset = 0;   ///< offsets count from the file's start
    std::uint64_t positionsOffset = 0;
    std::uint64_t normalsOffset = 0;
    std::uint64_t coloursOffset = 0;  ///< 0 without colours
    std::uint64_t indicesOffset = 0;
    std::array<std::uint64_t, 11> reserved{};
};
static_assert(sizeof(EymHeader) == 256);

/// One LOD node, as stored.
struct Node {
    glm::uvec3 boxMin{0U};   ///< lattice, closed; covers the source vertices of its triangles,
    glm::uvec3 boxMax{0U};   ///< lies inside its parent's
    std::int32_t left = -1;  ///< its own index plus one; -1 in a leaf
    std::int32_t right = -1;
    /// The full-resolution triangles it stands for, in depth-first order. triangleBegin over the
    /// file's triangleCount is its position in the range [0, 1).
    std::uint64_t triangleBegin = 0;
    std::uint64_t triangleEnd = 0;
    std::uint64_t firstVertex = 0;
    std::uint64_t firstIndex = 0;
    std::uint32_t vertexCount = 0;  ///< at most 65,535
    std::uint32_t indexCount = 0;   ///< three a triangle; 0 without geometry
    /// Upper bound on the distance between the source surface and what is drawn for this node: its
    /// own geometry or, where it has none, its children. Never below its children's.
    float errorMetres = 0;
    /// The first indices, three a triangle, of triangles of which an eye outside the mesh's bounds
    /// sees no backs (back_faces.h): these need not be drawn.
    std::uint32_t frontIndexCount = 0;
    std::uint64_t checksum = 0;  ///< xxh64 of its positions, normals, colours, indices in turn

    bool isLeaf() const { return left < 0; }
    bool operator==(const Node&) const = default;
};
static_assert(sizeof(Node) == 88);

/// A node's arrays, inside the mapped file: valid while the EymFile lives.
struct NodeGeometry {
    std::span<const std::uint64_t> positions;
    std::span<const std::uint32_t> normals;
    std::span<const std::uint32_t> colours;  ///< empty in a mesh without colours
    std::span<const std::uint16_t> indices;  ///< each below positions.size()
};

/// An open .eym file. Immutable: any thread may call any function.
///
/// open() checks the header and every node, geometry() the node's arrays when they are first asked
/// for, so no file, however damaged, makes a reader leave its mapping.
class EymFile {
public:
    /// `path` may be an address (page/remote_name.h): the file is then copied whole, into the
    /// cache of `options`, before it is mapped. Errors: NotFound, PermissionDenied, InvalidArgument
    /// (not an .eym file, another version), DataLoss (truncated, or its tables are damaged); of an
    /// address those of page::PageSource::wholeFile, too.
    static absl::StatusOr<EymFile> open(const std::string& path,
                                        const page::SourceOptions& options = {},
                                        const page::PageSource::Progress& progress = {});

    const Lattice& lattice() const { return lattice_; }
    std::span<const Node> nodes() const { return nodes_; }  ///< never empty; [0] is the root
    bool hasColours() const { return (header().flags & kHasColours) != 0; }
    std::uint64_t triangleCount() const { return header().triangleCount; }
    std::uint64_t vertexCount() const { return header().sourceVertexCount; }
    std::uint64_t sourceHash() const { return header().sourceHash; }
    std::uint64_t fileBytes() const { return header().fileBytes; }
    double coarsestErrorMetres() const { return header().coarsestErrorMetres; }
    double finestErrorMetres() const { return header().finestErrorMetres; }
    int levels() const { return levels_; }  ///< nodes on the longest way from root to leaf

    fabric::Box bounds() const { return bounds(0); }  ///< object space, metres
    fabric::Box bounds(std::uint32_t node) const;

    /// Precondition: node < nodes().size(). DataLoss, naming file and node, when the node's bytes
    /// are damaged.
    absl::StatusOr<NodeGeometry> geometry(std::uint32_t node) const;

private:
    static absl::StatusOr<EymFile> openCopied(const std::string& url,
                                              const page::SourceOptions& options,
                                              const page::PageSource::Progress& progress);
    static absl::StatusOr<EymFile> openMapped(const std::string& name, MappedFile mapped);
    EymFile(std::string path, MappedFile file) : path_(std::move(path)), file_(std::move(file)) {}

    const EymHeader& header() const {
        return *reinterpret_cast<const EymHeader*>(file_.bytes().data());
    }
    template <typename T>
    std::span<const T> section(std::uint64_t offset, std::uint64_t first,
                               std::uint64_t count) const;

    std::string path_;
    MappedFile file_;
    Lattice lattice_;
    std::span<const Node> nodes_;
    int levels_ = 0;
    /// Per node, whether its geometry was found sound.
    std::unique_ptr<std::atomic<bool>[]> verified_;
};

/// Checksum of a header and its node table. `header.checksum` does not enter.
std::uint64_t tableChecksum(const EymHeader& header, std::span<const Node> nodes);

/// Checksum of a node's arrays.
std::uint64_t geometryChecksum(const NodeGeometry& geometry);

/// xxh64 of a file's bytes: what `EymFile::sourceHash` is compared with to see whether an import is
/// up to date. Errors: those of MappedFile::open.
absl::StatusOr<std::uint64_t> contentHash(const std::string& path);

/// The same of bytes in memory.
std::uint64_t contentHash(std::span<const std::byte> bytes);

}  // namespace eyrie::mesh
