// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "renderer/mesh/packed_mesh.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::test {

/// `triangles` triangles between `vertices` random lattice points below `extent`, seeded.
inline mesh::PackedMesh randomSoup(std::uint32_t triangles, std::uint32_t vertices,
                                   std::uint32_t extent, std::uint32_t seed,
                                   bool withColours = false) {
    std::mt19937 engine(seed);
    const auto random = [&engine] { return static_cast<std::uint32_t>(engine()); };
    mesh::PackedMesh soup;
    soup.lattice = {{-2, 0, 16}, 0.125};
    for (std::uint32_t i = 0; i < vertices; ++i) {
        const std::uint32_t x = random() % extent;
        const std::uint32_t y = random() % extent;
        const std::uint32_t z = random() % extent;
        soup.positions.push_back(mesh::packPosition({x, y, z}));
        soup.normals.push_back(random());
        if (withColours)
            soup.colours.push_back(random());
    }
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const auto corner = [&] { return random() % vertices; };
        const std::uint32_t a = corner();
        const std::uint32_t b = corner();
        soup.triangles.push_back({a, b, corner()});
    }
    return soup;
}

/// Triangles of three materials, each between random vertices of its own, in random order: with a
/// texture, plain, and blended. Two images, of random blocks.
inline mesh::PackedMesh texturedSoup(std::uint32_t triangles, std::uint32_t seed) {
    mesh::PackedMesh soup = randomSoup(triangles, 90, 1000, seed, true);
    std::mt19937 engine(seed + 1);
    const auto random = [&engine] { return static_cast<std::uint32_t>(engine()); };
    soup.materials = {{.image = 1, .flags = mesh::kIsTwoSided, .alphaCutoff = 0.5F},
                      {},
                      {.image = 0, .flags = mesh::kIsBlended}};
    for (std::uint32_t v = 0; v < soup.positions.size(); ++v) {
        soup.materialOf.push_back(static_cast<std::uint16_t>(v % 3));
        soup.textureCoordinates.emplace_back(static_cast<int>(random()),
                                             static_cast<int>(random() % 65536));
    }
    for (mesh::Triangle& triangle : soup.triangles)
        for (std::uint32_t& corner : triangle) corner = corner / 3 * 3 + triangle[0] % 3;
    for (const mesh::ImageShape& shape :
         {mesh::ImageShape{5, 8, mesh::kHasAlpha, random(), 1}, {16, 1, mesh::kClampsU, 7, 0}}) {
        soup.images.push_back({shape, {}});
        for (std::uint64_t i = 0; i < shape.bytesFrom(0); ++i)
            soup.images.back().blocks.push_back(static_cast<std::byte>(random()));
    }
    return soup;
}

/// `triangles` triangles that share no vertex, along the x axis.
inline mesh::PackedMesh separateTriangles(std::uint32_t triangles) {
    mesh::PackedMesh result;
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const std::uint32_t first = 3 * i;
        for (const glm::uvec3 point : {glm::uvec3(i, 0, 0), {i + 1, 0, 0}, {i, 1, 0}}) {
            result.positions.push_back(mesh::packPosition(point));
            result.normals.push_back(mesh::packNormal({0, 0, 1}));
        }
        result.triangles.push_back({first, first + 1, first + 2});
    }
    return result;
}

}  // namespace eyrie::test
