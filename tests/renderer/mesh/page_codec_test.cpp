// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/codec/page_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/mesh/codec/exact_codec.h"
#include "renderer/mesh/codec/normal_forecast.h"
#include "renderer/mesh/codec/page_model.h"
#include "renderer/mesh/node_geometry.h"
#include "tests/renderer/mesh/sample_meshes.h"

namespace eyrie::mesh {
namespace {

PackedNode gathered(const PackedMesh& mesh) {
    const std::array<std::span<const Triangle>, 1> whole{mesh.triangles};
    return gatherNode(mesh, whole);
}

/// Any triangles at all: repeated, without area, flipped, with corners in common.
PackedNode anyTriangles() {
    if (*rc::gen::arbitrary<bool>())
        return gathered(test::texturedSoup(*rc::gen::inRange<std::uint32_t>(1, 300),
                                           *rc::gen::arbitrary<std::uint32_t>()));
    const auto seed = *rc::gen::arbitrary<std::uint32_t>();
    const auto triangles = *rc::gen::inRange<std::uint32_t>(1, 400);
    const auto vertices = *rc::gen::inRange<std::uint32_t>(1, 300);
    const auto extent = *rc::gen::element(1U, 5U, 3000U, 1U << kLatticeBits);
    const PackedMesh soup =
        test::randomSoup(triangles, vertices, extent, seed, *rc::gen::arbitrary<bool>());
    return gathered(soup);
}

/// These, or points alone.
PackedNode anyNode() {
    PackedNode node = anyTriangles();
    if (*rc::gen::arbitrary<bool>())
        node.indices.clear();
    return node;
}

/// A hilly square of `side` * `side` vertices.
PackedNode hills(std::uint32_t side) {
    PackedMesh mesh;
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
            const double height = 500 + 400 * std::sin(i * 0.3) * std::cos(j * 0.2);
            mesh.positions.push_back(
                packPosition({i * 64, j * 64, static_cast<std::uint32_t>(height)}));
            mesh.normals.push_back(0);
        }
    for (std::uint32_t j = 0; j + 1 < side; ++j)
        for (std::uint32_t i = 0; i + 1 < side; ++i) {
            const std::uint32_t a = j * side + i;
            mesh.triangles.push_back({a, a + 1, a + side});
            mesh.triangles.push_back({a + 1, a + side + 1, a + side});
        }
    return gathered(mesh);
}

NodeGeometry geometryOf(const PackedNode& node) {
    return {node.positions, node.normals, node.colours, node.textureCoordinates,
            node.indices,   {},           nullptr};
}

struct Decoded {
    absl::Status status;
    std::vector<std::uint64_t> block;
    NodeGeometry geometry;
};

Decoded decode(std::span<const std::byte> page, const NodeShape& shape) {
    Decoded decoded;
    decoded.block.resize(blockBytes(shape) / 8);
    decoded.status = decodePage(page, NodeArrays(shape, decoded.block));
    decoded.geometry = geometryIn(std::as_bytes(std::span(decoded.block)), shape, nullptr);
    return decoded;
}

NodeShape shapeOf(const PackedNode& node) {
    return {static_cast<std::uint32_t>(node.positions.size()),
            static_cast<std::uint32_t>(node.indices.size()), !node.colours.empty(),
            !node.textureCoordinates.empty()};
}

RC_GTEST_PROP(MeshPage, GivesBackWhatItWasMadeOf, ()) {
    const PackedNode node = anyNode();
    const std::vector<std::byte> page = encodePage(geometryOf(node));
    RC_ASSERT(page.size() <= mostPageBytes(shapeOf(node)));
    const Decoded decoded = decode(page, shapeOf(node));
    RC_ASSERT(decoded.status.ok());
    RC_ASSERT(std::ranges::equal(decoded.geometry.positions, node.positions));
    RC_ASSERT(std::ranges::equal(decoded.geometry.normals, node.normals));
    RC_ASSERT(std::ranges::equal(decoded.geometry.colours, node.colours));
    RC_ASSERT(std::ranges::equal(decoded.geometry.textureCoordinates, node.textureCoordinates));
    RC_ASSERT(std::ranges::equal(decoded.geometry.indices, node.indices));
}

RC_GTEST_PROP(MeshPage, ThatIsDamagedEndsInAStatusOrInAnotherMesh, ()) {
    const PackedNode node = anyNode();
    std::vector<std::byte> page = encodePage(geometryOf(node));
    for (int i = *rc::gen::inRange(1, 5); i > 0; --i)
        page[*rc::gen::inRange<std::size_t>(0, page.size())] =
            static_cast<std::byte>(*rc::gen::arbitrary<std::uint8_t>());
    page.resize(*rc::gen::inRange<std::size_t>(0, page.size() + 9));
    const Decoded decoded = decode(page, shapeOf(node));
    RC_CLASSIFY(decoded.status.ok());
    RC_ASSERT(decoded.status.ok() || absl::IsDataLoss(decoded.status));
    if (decoded.status.ok())
        for (const std::uint16_t index : decoded.geometry.indices)
            RC_ASSERT(index < node.positions.size());
}

/// Numbers that nothing foresees, of every size.
TEST(MeshPage, IsNeverLongerThanItIsSaidToBe) {
    PackedNode node = gathered(test::randomSoup(20000, 60000, 1U << kLatticeBits, 1, true));
    std::mt19937 random(1);
    for (std::size_t v = 0; v < node.positions.size(); ++v)
        node.textureCoordinates.emplace_back(static_cast<int>(random()),
                                             static_cast<int>(random()));
    const std::size_t bytes = encodePage(geometryOf(node)).size();
    EXPECT_LE(bytes, mostPageBytes(shapeOf(node)));
    EXPECT_GT(bytes, mostPageBytes(shapeOf(node)) / 4);
}

TEST(MeshPage, OfARegularSurfaceTakesFewBitsATriangle) {
    PackedNode node = hills(60);
    forecastNormals(node.positions, node.indices, node.normals);
    const std::vector<std::byte> page = encodePage(geometryOf(node));
    const double bits =
        8.0 * static_cast<double>(page.size()) * 3 / static_cast<double>(node.indices.size());
    EXPECT_LT(bits, 18);  // a seventh of what it has uncoded
}

TEST(MeshPage, RefusesAnotherShape) {
    const PackedNode node = hills(10);
    const std::vector<std::byte> page = encodePage(geometryOf(node));
    NodeShape shape = shapeOf(node);
    shape.indexCount -= 3;
    EXPECT_TRUE(absl::IsDataLoss(decode(page, shape).status));
    shape = shapeOf(node);
    ++shape.vertexCount;
    EXPECT_TRUE(absl::IsDataLoss(decode(page, shape).status));
    shape = shapeOf(node);
    shape.hasColours = true;
    EXPECT_TRUE(absl::IsDataLoss(decode(page, shape).status));
}

TEST(MeshPage, NumbersOfAnySizeHaveACode) {
    for (const std::uint32_t number : {0U, 1U, 3U, 4U, 7U, 8U, 100U, 65535U, 1U << 31, ~0U}) {
        const NumberCode code = codeOf(number);
        const std::uint32_t rest =
            static_cast<std::uint32_t>(number & ((std::uint64_t{1} << code.restBits) - 1));
        EXPECT_LT(code.symbol, kNumberSymbols);
        EXPECT_EQ(restBitsOf(code.symbol), code.restBits);
        EXPECT_EQ(numberOf(code.symbol, rest), number);
    }
}

TEST(NormalForecast, IsTheNormalOfAPlaneAndOfACubesCorner) {
    std::vector<std::uint32_t> normals(3);
    const std::vector<std::uint64_t> plane = {packPosition({0, 0, 7}), packPosition({900, 0, 7}),
                                              packPosition({0, 5, 7})};
    forecastNormals(plane, std::vector<std::uint16_t>{0, 1, 2}, normals);
    EXPECT_EQ(normals, std::vector<std::uint32_t>(3, packNormal({0, 0, 1})));
    normals.resize(4);
    const std::vector<std::uint64_t> corner = {packPosition({0, 0, 0}), packPosition({9, 0, 0}),
                                               packPosition({0, 9, 0}), packPosition({0, 0, 9})};
    forecastNormals(corner, std::vector<std::uint16_t>{0, 2, 1, 0, 3, 2, 0, 1, 3}, normals);
    EXPECT_EQ(normals[0], packNormal({-1, -1, -1}));
}

RC_GTEST_PROP(ExactPositions, ComeBackToTheBit, ()) {
    const bool isFloat = *rc::gen::arbitrary<bool>();
    const Lattice lattice{{-3, 5, 0}, 0.0078125};
    const double scale = *rc::gen::element(0.0, 1e-30, 1e-3, 1.0, 1e9);
    std::vector<fabric::Vec3> exact;
    std::vector<std::uint64_t> onLattice;
    const auto count = *rc::gen::inRange(0, 40);
    for (int v = 0; v < count; ++v) {
        fabric::Vec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const double value = scale * *rc::gen::inRange(-1000000, 1000000) / 7;
            p[axis] = isFloat ? static_cast<double>(static_cast<float>(value)) : value;
            if (*rc::gen::inRange(0, 8) == 0)
                p[axis] = -0.0;
        }
        exact.push_back(p);
        onLattice.push_back(*rc::gen::arbitrary<std::uint64_t>() >> 1);
    }
    const ExactForm form = exactFormOf(exact);
    RC_ASSERT(!isFloat || form == ExactForm::Float32);
    std::vector<std::byte> page = encodeExact(exact, onLattice, lattice, form);
    RC_ASSERT(page.size() <= mostExactBytes(static_cast<std::uint32_t>(exact.size())));
    const auto back = decodeExact(page, onLattice, lattice, form);
    RC_ASSERT(back.ok() && back->size() == exact.size());
    for (std::size_t v = 0; v < exact.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            RC_ASSERT(std::bit_cast<std::uint64_t>((*back)[v][axis]) ==
                      std::bit_cast<std::uint64_t>(exact[v][axis]));
    page[*rc::gen::inRange<std::size_t>(0, page.size())] =
        static_cast<std::byte>(*rc::gen::arbitrary<std::uint8_t>());
    const absl::Status status = decodeExact(page, onLattice, lattice, form).status();
    RC_ASSERT(status.ok() || absl::IsDataLoss(status));
}

}  // namespace
}  // namespace eyrie::mesh
