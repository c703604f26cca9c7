// SPDX-License-Identifier: Apache-2.0
// Damaged PLY files end in a mesh that keeps TriangleMesh's invariant, or in a message.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/import/pack_mesh.h"
#include "renderer/import/ply_reader.h"
#include "tests/renderer/import/ply_text.h"

namespace eyrie::import {
namespace {

/// A body of two triangles that meet in a seam, and a quad, in two images.
std::string textured(test::Encoding encoding) {
    test::PlyBody body(encoding);
    for (const auto& [x, y] : {std::pair(0.0F, 0.0F), {1.0F, 0.0F}, {0.0F, 1.0F}, {1.0F, 1.0F}})
        body.add(x).add(y).add(0.0F).endLine();
    std::uint8_t number = 0;
    for (const std::vector<std::int32_t>& face :
         std::vector<std::vector<std::int32_t>>{{0, 1, 2}, {2, 1, 3}, {0, 1, 3, 2}}) {
        body.add(static_cast<std::uint8_t>(face.size()));
        for (const std::int32_t corner : face) body.add(corner);
        body.add(static_cast<std::uint8_t>(2 * face.size()));
        for (std::size_t i = 0; i < 2 * face.size(); ++i)
            body.add(0.25F * static_cast<float>(i + number));
        body.add(static_cast<std::uint8_t>(number++ % 2)).endLine();
    }
    return test::formatLine(encoding) +
           "comment TextureFile a.png\ncomment TextureFile <this>.png\nelement vertex 4\n"
           "property float x\nproperty float y\nproperty float z\nelement face 3\n"
           "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
           "property uchar texnumber\nend_header\n" +
           body.bytes();
}

class PlyDamage : public testing::TestWithParam<test::Encoding> {};

/// Small, yet with everything: normals, colours, a quad and a concave pentagon.
std::string sample(test::Encoding encoding) {
    TriangleMesh mesh = test::tetrahedron();
    mesh.positions.emplace_back(0.25, 0.25, 0);
    mesh.normals.assign(5, {0, 0, 1});
    mesh.colours.assign(5, {1, 2, 3, 4});
    std::string text = test::plyOf(mesh, encoding);
    text.replace(text.find("element face 4"), 14, "element face 6");
    test::PlyBody polygons(encoding);
    polygons.add(std::uint8_t{4});
    for (const std::int32_t corner : {0, 1, 2, 3}) polygons.add(corner);
    polygons.endLine().add(std::uint8_t{5});
    for (const std::int32_t corner : {0, 1, 4, 2, 3}) polygons.add(corner);
    return text + polygons.endLine().bytes();
}

void expectSound(const std::string& text, std::size_t at) {
    auto mesh = parsePly(text, "damaged.ply");
    if (!mesh.ok()) {
        EXPECT_GT(mesh.status().message().size(), 20U) << at;
        return;
    }
    for (const fabric::Vec3& position : mesh->positions)
        EXPECT_TRUE(std::isfinite(position.x + position.y + position.z)) << at;
    for (const auto& triangle : mesh->triangles)
        for (const std::uint32_t corner : triangle) EXPECT_LT(corner, mesh->positions.size()) << at;
    EXPECT_TRUE(mesh->materialOf.empty() || mesh->materialOf.size() == mesh->positions.size());
    for (const auto& triangle : mesh->triangles)
        for (const std::uint32_t corner : triangle)
            if (!mesh->materialOf.empty()) {
                EXPECT_LT(mesh->materialOf[corner], mesh->materials.size()) << at;
                EXPECT_EQ(mesh->materialOf[corner], mesh->materialOf[triangle[0]]) << at;
            }
    EXPECT_EQ(mesh->textureCoordinates.size(), mesh->materialOf.size()) << at;
    mesh->images.resize(mesh->textures.size());  // as if they had been loaded
    PackCounts counts;
    const auto packed = packMesh(*std::move(mesh), counts);
    EXPECT_TRUE(packed.ok() || !packed.status().message().empty()) << at;
}

TEST_P(PlyDamage, OfTheLengthGivesAMessage) {
    for (const std::string& text : {sample(GetParam()), textured(GetParam())}) {
        ASSERT_TRUE(parsePly(text, "whole.ply").ok()) << parsePly(text, "whole.ply").status();
        // In text the last line end may go, and of the last number all but a digit.
        for (std::size_t length = 0; length + 3 < text.size(); ++length)
            EXPECT_FALSE(parsePly(text.substr(0, length), "cut.ply").ok()) << length;
    }
}

TEST_P(PlyDamage, OfAnyBitNeverBreaksTheReader) {
    for (const std::string& text : {sample(GetParam()), textured(GetParam())})
        for (std::size_t bit = 0; bit < text.size() * 8; ++bit) {
            std::string flipped = text;
            flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
            expectSound(flipped, bit);
        }
}

TEST_P(PlyDamage, OfAnyByteNeverBreaksTheReader) {
    for (const std::string& text : {sample(GetParam()), textured(GetParam())})
        for (std::size_t i = 0; i < text.size(); ++i) {
            for (const char c : {'\0', '\xFF', '9', '-', 'e', '\n'}) {
                std::string damaged = text;
                damaged[i] = c;
                expectSound(damaged, i);
            }
        }
}

INSTANTIATE_TEST_SUITE_P(Encodings, PlyDamage,
                         testing::Values(test::Encoding::Ascii, test::Encoding::LittleEndian,
                                         test::Encoding::BigEndian));

}  // namespace
}  // namespace eyrie::import
