// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/eym_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <oneapi/tbb/parallel_for.h>

#include "fabric/status.h"
#include "renderer/mesh/codec/page_codec.h"
#include "renderer/mesh/eym_check.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/node_geometry.h"

namespace eyrie::mesh {
namespace {

constexpr std::uint64_t kAlignment = 8;  ///< of uncoded pages

/// The least float that is not below `value`: an upper bound stays one.
float roundedUp(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest >= value ? nearest
                            : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

/// The same of floats whose lower half is 0: the upper one.
std::uint16_t upperHalf(double value) {
    const auto bits = std::bit_cast<std::uint32_t>(roundedUp(value));
    return static_cast<std::uint16_t>((bits + 0xFFFF) >> 16);
}

std::vector<Triangle> trianglesOf(const PackedMesh& mesh, const KdTree& tree, const KdNode& leaf) {
    std::vector<Triangle> triangles;
    triangles.reserve(leaf.triangleEnd - leaf.triangleBegin);
    for (std::uint64_t i = leaf.triangleBegin; i < leaf.triangleEnd; ++i)
        triangles.push_back(mesh.triangles[tree.order[i]]);
    return triangles;
}

/// What a node has in the file.
struct Pages {
    NodeShape shape;
    std::vector<std::byte> page;
    std::vector<std::byte> exact;
    std::uint64_t blockChecksum = 0;
    std::uint32_t frontIndexCount = 0;
    std::vector<MaterialRange> ranges;  ///< where the mesh has materials
};

NodeShape shapeOf(const PackedNode& node) {
    return {static_cast<std::uint32_t>(node.positions.size()),
            static_cast<std::uint32_t>(node.indices.size()), !node.colours.empty(),
            !node.textureCoordinates.empty()};
}

/// A node's triangles in the order in which they are drawn, in parts.
struct Parts {
    std::vector<Triangle> triangles;
    std::vector<MaterialRange> ranges;             ///< one, where the mesh has no materials
    std::vector<std::span<const Triangle>> parts;  ///< two a range
};

/// By material, those that are blended last, and of each those that show their backs to nobody
/// first.
Parts inDrawingOrder(const PackedMesh& mesh, std::vector<Triangle> triangles,
                     const Pockets& pockets, double errorSteps) {
    Parts result{std::move(triangles), {}, {}};
    const auto materialOf = [&mesh](const Triangle& triangle) -> std::uint32_t {
        return mesh.materials.empty() ? 0 : mesh.materialOf[triangle[0]];
    };
    const auto isBefore = [&](const Triangle& a, const Triangle& b) {
        const std::uint32_t ofA = materialOf(a);
        const std::uint32_t ofB = materialOf(b);
        return std::pair(mesh.materials[ofA].isBlended(), ofA) <
               std::pair(mesh.materials[ofB].isBlended(), ofB);
    };
    if (!mesh.materials.empty())
        std::stable_sort(result.triangles.begin(), result.triangles.end(), isBefore);
    for (auto at = result.triangles.begin(); at != result.triangles.end();) {
        const auto end = std::find_if(at, result.triangles.end(), [&](const Triangle& triangle) {
            return materialOf(triangle) != materialOf(*at);
        });
        const auto others = std::stable_partition(at, end, [&](const Triangle& triangle) {
            return !pockets.reach(boxOf(mesh, triangle), errorSteps);
        });
        result.ranges.push_back({0, materialOf(*at), static_cast<std::uint32_t>(3 * (end - at)),
                                 static_cast<std::uint32_t>(3 * (others - at))});
        result.parts.emplace_back(at, others);
        result.parts.emplace_back(others, end);
        at = end;
    }
    return result;
}

/// As node_block.h has it.
std::vector<std::byte> blockOf(const PackedNode& node) {
    std::vector<std::uint64_t> block(blockBytes(shapeOf(node)) / 8);
    const NodeArrays arrays(shapeOf(node), block);
    std::copy(node.positions.begin(), node.positions.end(), arrays.positions.begin());
    std::copy(node.normals.begin(), node.normals.end(), arrays.normals.begin());
    std::copy(node.colours.begin(), node.colours.end(), arrays.colours.begin());
    std::copy(node.textureCoordinates.begin(), node.textureCoordinates.end(),
              arrays.textureCoordinates.begin());
    std::copy(node.indices.begin(), node.indices.end(), arrays.indices.begin());
    const auto bytes = std::as_bytes(std::span(block));
    return {bytes.begin(), bytes.end()};
}

/// Null where a node is not drawn as points.
const PointSample* pointsOf(const LodTree& lod, std::size_t node) {
    return node < lod.points.size() && lod.points[node] ? &*lod.points[node] : nullptr;
}

class PageMaker {
public:
    PageMaker(const PackedMesh& mesh, const KdTree& tree, const LodTree& lod,
              std::span<const Pockets> pockets, const EymOptions& options)
        : mesh_(mesh),
          tree_(tree),
          lod_(lod),
          isCoded_(options.isCoded),
          pockets_(pockets),
          exactForm_(options.exactForm.value_or(exactFormOf(mesh.exact))) {}

    ExactForm exactForm() const { return exactForm_; }

    Pages make(std::size_t index) const {
        if (const PointSample* points = pointsOf(lod_, index))
            return withPage({points->positions, points->normals, points->colours, {}, {}, {}});
        const KdNode& node = tree_.nodes[index];
        Parts parts = inDrawingOrder(
            mesh_, node.isLeaf() ? trianglesOf(mesh_, tree_, node) : lod_.geometry[index],
            pockets_[index], lod_.errorMetres[index] / mesh_.lattice.stepMetres);
        const PackedNode packed = gatherNode(mesh_, parts.parts);
        if (packed.indices.empty())
            return {};
        Pages pages = withPage(packed);
        if (mesh_.materials.empty())
            pages.frontIndexCount = parts.ranges.front().frontIndexCount;
        else
            pages.ranges = std::move(parts.ranges);
        if (node.isLeaf() && !packed.exact.empty())
            pages.exact = encodeExact(packed.exact, packed.positions, mesh_.lattice, exactForm_);
        return pages;
    }

private:
    Pages withPage(const PackedNode& packed) const {
        Pages pages;
        pages.shape = shapeOf(packed);
        pages.page = blockOf(packed);
        pages.blockChecksum = contentHash(pages.page);
        if (isCoded_)
            pages.page = encodePage({packed.positions,
                                     packed.normals,
                                     packed.colours,
                                     packed.textureCoordinates,
                                     packed.indices,
                                     {},
                                     nullptr});
        return pages;
    }

    const PackedMesh& mesh_;
    const KdTree& tree_;
    const LodTree& lod_;
    bool isCoded_;
    std::span<const Pockets> pockets_;
    ExactForm exactForm_;
};

std::vector<Lid> stored(const std::vector<fabric::Box>& boxes) {
    std::vector<Lid> lids;
    for (const fabric::Box& box : boxes) lids.push_back({glm::uvec3(box.min), glm::uvec3(box.max)});
    return lids;
}

std::vector<Pages> makePages(const KdTree& tree, const PageMaker& maker,
                             const std::stop_token& stop) {
    std::vector<Pages> pages(tree.nodes.size());
    oneapi::tbb::parallel_for(std::size_t{0}, pages.size(), [&](std::size_t i) {
        if (!stop.stop_requested())
            pages[i] = maker.make(i);
    });
    return pages;
}

std::uint64_t aligned(std::uint64_t value) {
    return (value + kAlignment - 1) / kAlignment * kAlignment;
}

/// `end`, where pages begin, becomes where they end.
std::vector<Node> layOutNodes(const KdTree& tree, const LodTree& lod,
                              const std::vector<Pages>& pages, std::uint64_t& end) {
    std::vector<Node> nodes(tree.nodes.size());
    const auto place = [&end](const std::vector<std::byte>& page, std::uint64_t& offset,
                              std::uint32_t& bytes, std::uint64_t& checksum) {
        offset = end;
        bytes = static_cast<std::uint32_t>(page.size());
        checksum = contentHash(page);
        end = aligned(end + bytes);
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const KdNode& from = tree.nodes[i];
        Node& node = nodes[i];
        node.boxMin = from.boxMin;
        node.boxMax = from.boxMax;
        node.left = from.left;
        node.right = from.right;
        node.triangleBegin = from.triangleBegin;
        node.triangleEnd = from.triangleEnd;
        node.vertexCount = static_cast<std::uint16_t>(pages[i].shape.vertexCount);
        node.indexCount = pages[i].shape.indexCount;
        node.errorMetres = roundedUp(lod.errorMetres[i]);
        node.colourReach = upperHalf(lod.colourReachMetres[i]);
        node.frontIndexCount = pages[i].frontIndexCount;
        if (!node.hasGeometry())
            continue;
        node.normalErrorDegrees = roundedUp(lod.normalErrors[i].most);
        node.normalErrorMeanDegrees = roundedUp(lod.normalErrors[i].mean);
        place(pages[i].page, node.pageOffset, node.pageBytes, node.pageChecksum);
        node.blockChecksum = pages[i].blockChecksum;
        if (!pages[i].exact.empty())
            place(pages[i].exact, node.exactOffset, node.exactBytes, node.exactChecksum);
    }
    return nodes;
}

std::vector<MaterialRange> rangesOf(const std::vector<Pages>& pages) {
    std::vector<MaterialRange> ranges;
    for (std::size_t node = 0; node < pages.size(); ++node)
        for (MaterialRange range : pages[node].ranges) {
            range.node = static_cast<std::uint32_t>(node);
            ranges.push_back(range);
        }
    return ranges;
}

std::vector<PointRange> pointRangesOf(const PackedMesh& mesh, const LodTree& lod) {
    std::vector<PointRange> ranges;
    for (std::uint32_t node = 0; node < lod.geometry.size(); ++node)
        if (const PointSample* sample = pointsOf(lod, node))
            for (const PointPrefix& prefix : sample->prefixes)
                ranges.push_back(
                    {node, prefix.points,
                     roundedUp(std::max(
                         lod.errorMetres[node],
                         mesh.errorMetres() + prefix.errorSteps * mesh.lattice.stepMetres))});
    return ranges;
}

/// `end` becomes that of the images.
std::vector<ImageRecord> layOutImages(const std::vector<Image>& images, std::uint64_t& end) {
    std::vector<ImageRecord> records;
    for (const Image& image : images) {
        records.push_back({end, contentHash(image.blocks),
                           static_cast<std::uint32_t>(image.blocks.size()), image.shape});
        end = aligned(end + image.blocks.size());
    }
    return records;
}

/// The tables of materials, images and ranges as they lie in the file.
std::vector<std::byte> tableBytes(const std::vector<Material>& materials,
                                  const std::vector<ImageRecord>& images,
                                  const std::vector<MaterialRange>& ranges) {
    std::vector<std::byte> bytes;
    for (const auto table : {std::as_bytes(std::span(materials)), std::as_bytes(std::span(images)),
                             std::as_bytes(std::span(ranges))})
        bytes.insert(bytes.end(), table.begin(), table.end());
    return bytes;
}

std::vector<Light> stored(const fabric::FileLights& lights) {
    std::vector<Light> records;
    const auto add = [&](const fabric::Vec3& place, const fabric::Vec3& colour, double reach) {
        records.push_back({{place.x, place.y, place.z},
                           {static_cast<float>(colour.x), static_cast<float>(colour.y),
                            static_cast<float>(colour.z)},
                           static_cast<float>(reach)});
    };
    for (const fabric::DirectionalLight& light : lights.distant)
        add(light.direction, light.colour, 0);
    for (const fabric::PointLight& light : lights.points)
        add(light.positionMetres, light.colour, light.reachMetres);
    return records;
}

/// One for each stored light, or none where none is a spot.
std::vector<Cone> storedCones(const fabric::FileLights& lights) {
    std::vector<Cone> records(lights.distant.size());
    for (const fabric::PointLight& light : lights.points) {
        Cone record;
        if (const auto& cone = light.cone)
            record = {{cone->axis.x, cone->axis.y, cone->axis.z},
                      static_cast<float>(cone->innerDegrees),
                      static_cast<float>(cone->outerDegrees)};
        records.push_back(record);
    }
    return std::ranges::any_of(records, &Cone::isSpot) ? records : std::vector<Cone>();
}

std::uint64_t countUsedVertices(const PackedMesh& mesh) {
    std::vector<bool> used(mesh.positions.size());
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) used[corner] = true;
    return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
}

std::vector<std::byte> bytesOf(const std::vector<Light>& lights, const std::vector<Cone>& cones) {
    std::vector<std::byte> bytes;
    for (const auto table : {std::as_bytes(std::span(lights)), std::as_bytes(std::span(cones))})
        bytes.insert(bytes.end(), table.begin(), table.end());
    return bytes;
}

std::uint32_t flagsOf(const PackedMesh& mesh, const EymOptions& options, ExactForm exactForm) {
    return (storedCones(mesh.lights).empty() ? 0 : kHasCones) |
           (mesh.colours.empty() ? 0 : kHasColours) | (options.isCoded ? kIsCoded : 0) |
           (mesh.exact.empty() ? 0 : kHasExact) |
           (mesh.textureCoordinates.empty() ? 0 : kHasTextures) |
           (exactForm == ExactForm::Float64 ? kExactIsFloat64 : 0);
}

/// Of `tables`, which has their sizes.
EymHeader makeHeader(const PackedMesh& mesh, const std::vector<Node>& nodes,
                     const std::vector<Lid>& lids, const EymHeader& tables) {
    EymHeader header = tables;
    header.nodesChecksum = contentHash(std::as_bytes(std::span(nodes)));
    header.lidsChecksum = contentHash(std::as_bytes(std::span(lids)));
    header.triangleCount = mesh.triangles.size();
    header.sourceVertexCount = countUsedVertices(mesh);
    header.nodeCount = static_cast<std::uint32_t>(nodes.size());
    header.originMetres = {mesh.lattice.originMetres.x, mesh.lattice.originMetres.y,
                           mesh.lattice.originMetres.z};
    header.stepMetres = mesh.lattice.stepMetres;
    header.coarsestErrorMetres = nodes.front().errorMetres;
    header.finestErrorMetres = nodes.back().errorMetres;
    return header;
}

absl::Status writePages(const std::vector<Pages>& pages, const std::vector<Image>& images,
                        OutputFile& out, const std::stop_token& stop) {
    for (const Pages& node : pages) {
        if (stop.stop_requested())
            return absl::CancelledError("writing was cancelled");
        for (const auto* page : {&node.page, &node.exact}) {
            RETURN_IF_ERROR(out.write(*page));
            RETURN_IF_ERROR(out.padTo(kAlignment));
        }
    }
    for (const Image& image : images) {
        RETURN_IF_ERROR(out.write(image.blocks));
        RETURN_IF_ERROR(out.padTo(kAlignment));
    }
    return absl::OkStatus();
}

}  // namespace

absl::Status writeEym(const PackedMesh& mesh, const KdTree& tree, const LodTree& lod,
                      const Backs& backs, const EymOptions& options, OutputFile& out,
                      const std::stop_token& stop) {
    const PageMaker maker(mesh, tree, lod, backs.pockets, options);
    const std::vector<Pages> pages = makePages(tree, maker, stop);
    const std::vector<MaterialRange> ranges = rangesOf(pages);
    const std::vector<PointRange> pointRanges = pointRangesOf(mesh, lod);
    const std::vector<Lid> lids = stored(backs.lids);
    const std::vector<Light> lights = stored(mesh.lights);
    const std::vector<Cone> cones = storedCones(mesh.lights);
    EymHeader sizes;
    sizes.nodeCount = static_cast<std::uint32_t>(tree.nodes.size());
    sizes.lidCount = lids.size();
    sizes.materialCount = static_cast<std::uint32_t>(mesh.materials.size());
    sizes.imageCount = static_cast<std::uint32_t>(mesh.images.size());
    sizes.rangeCount = static_cast<std::uint32_t>(ranges.size());
    sizes.pointRangeCount = static_cast<std::uint32_t>(pointRanges.size());
    sizes.lightCount = lights.size();
    sizes.flags = flagsOf(mesh, options, maker.exactForm());
    std::uint64_t end = endOfTables(sizes);
    const std::vector<Node> nodes = layOutNodes(tree, lod, pages, end);
    const std::vector<std::byte> tables =
        tableBytes(mesh.materials, layOutImages(mesh.images, end), ranges);
    EymHeader header = makeHeader(mesh, nodes, lids, sizes);
    header.materialsChecksum = contentHash(tables);
    header.pointRangesChecksum = contentHash(std::as_bytes(std::span(pointRanges)));
    if (!lights.empty())
        header.lightsChecksum = contentHash(bytesOf(lights, cones));
    header.sourceHash = options.sourceHash;
    header.turnedTriangles = options.turnedTriangles;
    header.fileBytes = end;
    header.checksum = headerChecksum(header);
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(&header, 1))));
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(nodes))));
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(lids))));
    RETURN_IF_ERROR(out.write(tables));
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(pointRanges))));
    RETURN_IF_ERROR(out.write(bytesOf(lights, cones)));
    return writePages(pages, mesh.images, out, stop);
}

}  // namespace eyrie::mesh
