// SPDX-License-Identifier: Apache-2.0
// gltfpack, meshoptimizer's own program, packs; what it says it may lose is what may be lost.
#include "renderer/import/gltf_unpacking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <absl/strings/escaping.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "renderer/import/assimp_reader.h"
#include "renderer/import/mesh_reader.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::HasSubstr;

constexpr int kSide = 24;  // vertices

/// A bumpy sheet with texture coordinates, 1000 long, and a material with a texture.
void writeSheet(const test::TemporaryFolder& folder) {
    std::string text = "mtllib m.mtl\nusemtl tiles\n";
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i)
            text += fmt::format("v {} {} {}\nvt {} {}\n", i * 1000.0 / (kSide - 1), j * 37.0,
                                200 * std::sin(i * 0.7) * std::cos(j * 0.9), i / 23.0, j / 23.0);
    for (int j = 0; j + 1 < kSide; ++j)
        for (int i = 0; i + 1 < kSide; ++i) {
            const int a = j * kSide + i + 1;
            const int b = a + kSide;
            text += fmt::format("f {0}/{0} {1}/{1} {2}/{2}\nf {0}/{0} {2}/{2} {3}/{3}\n", a, a + 1,
                                b + 1, b);
        }
    test::writeFile(folder.file("m.obj"), text);
    test::writeFile(folder.file("m.mtl"), "newmtl tiles\nKd 1 1 1\nmap_Kd tiles.png\n");
    std::string png;  // a white texel
    ASSERT_TRUE(
        absl::Base64Unescape("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAs"
                             "Tj2FAAAAABJRU5ErkJggg==",
                             &png));
    test::writeFile(folder.file("tiles.png"), png);
}

struct Corner {
    fabric::Vec3 position;
    glm::vec2 texture;
};

std::vector<Corner> cornersOf(const TriangleMesh& mesh) {
    std::vector<Corner> corners;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            corners.push_back({mesh.positions[vertex], mesh.textureCoordinates.at(vertex)});
    return corners;
}

std::string readFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text));
}

absl::StatusOr<std::optional<std::string>> unpacked(const std::string& file) {
    std::vector<std::string> notes;
    return unpackGltf(bytesOf(file), "m.gltf", notes);
}

struct Packing {
    const char* name;
    const char* file;
    const char* options;
    double step;  ///< of positions
};

void PrintTo(const Packing& packing, std::ostream* out) { *out << packing.name; }

class GltfOfGltfpack : public testing::TestWithParam<Packing> {};

TEST_P(GltfOfGltfpack, IsTheMeshThatWasPacked) {
    const test::TemporaryFolder folder;
    writeSheet(folder);
    const std::string command =
        fmt::format("cd '{}' && gltfpack -i m.obj -o {} {}",
                    std::filesystem::path(folder.file("m.obj")).parent_path().string(),
                    GetParam().file, GetParam().options);
    ASSERT_EQ(std::system(command.c_str()), 0) << "gltfpack is missing: run `./dev deps`";
    const auto source = readMesh(folder.file("m.obj"));
    const auto packed = readMesh(folder.file(GetParam().file));
    ASSERT_TRUE(source.ok() && packed.ok()) << source.status() << packed.status();
    ASSERT_EQ(packed->triangles.size(), source->triangles.size());
    std::vector<Corner> corners = cornersOf(*source);
    for (Corner& corner : corners)  // y is up in glTF
        corner.position = {corner.position.x, -corner.position.z, corner.position.y};
    for (const Corner& corner : cornersOf(*packed)) {
        const auto nearest = std::ranges::min_element(corners, {}, [&](const Corner& other) {
            return glm::distance(other.position, corner.position);
        });
        ASSERT_LE(glm::distance(nearest->position, corner.position),
                  GetParam().step * std::sqrt(3.0));
        ASSERT_LE(glm::distance(nearest->texture, corner.texture), 1.5 / 4095);
    }
    EXPECT_EQ(packed->images.size(), 1U) << testing::PrintToString(packed->notes);
}

INSTANTIATE_TEST_SUITE_P(
    EveryWay, GltfOfGltfpack,
    testing::Values(Packing{"Quantised", "p.glb", "", 1000.0 / 16383},
                    Packing{"FewBits", "p.glb", "-vp 8", 1000.0 / 255},
                    Packing{"Compressed", "p.glb", "-c", 1000.0 / 16383},
                    Packing{"WithBufferBeside", "p.gltf", "-cc", 1000.0 / 16383},
                    Packing{"WithFallback", "p.gltf", "-c -cf", 1000.0 / 16383},
                    Packing{"CompressedFloats", "p.gltf", "-c -noq", 1e-4}),
    [](const auto& packing) { return packing.param.name; });

std::string base64(const std::string& bytes) { return absl::Base64Escape(bytes); }

template <typename T>
void add(std::string& bytes, std::initializer_list<T> values) {
    for (const T value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Its y is up, and here z is. One triangle: places of 16 bits, normals and colours of 8,
/// normalised, in one view of 16 bytes a vertex.
std::string mixedGltf(const std::string& accessorMore = "", std::size_t count = 3) {
    std::string bytes;
    const std::array<std::array<std::int16_t, 3>, 3> places = {
        {{-32768, 0, 0}, {32767, 0, 0}, {0, 1000, -1}}};
    for (const auto& place : places) {
        add<std::int16_t>(bytes, {place[0], place[1], place[2], 0});
        add<std::int8_t>(bytes, {0, 0, 127, 0});
        add<std::uint8_t>(bytes, {255, 51, 0, 255});
    }
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"extensionsUsed":["KHR_mesh_quantization"],
"extensionsRequired":["KHR_mesh_quantization"],"scenes":[{{"nodes":[0]}}],"scene":0,
"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,
"COLOR_0":2}}}}]}}],"buffers":[{{"byteLength":48,
"uri":"data:application/octet-stream;base64,{}"}}],
"bufferViews":[{{"buffer":0,"byteLength":48,"byteStride":16}}],"accessors":[
{{"bufferView":0,"componentType":5122,"count":{},"type":"VEC3"{}}},
{{"bufferView":0,"byteOffset":8,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"}},
{{"bufferView":0,"byteOffset":12,"componentType":5121,"normalized":true,"count":3,
"type":"VEC4"}}]}})",
        base64(bytes), count, accessorMore);
}

TEST(GltfUnpacking, TakesIntegersForWhatTheySay) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), mixedGltf());
    const auto mesh = readMesh(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->triangles.size(), 1U);
    const auto [a, b, c] = mesh->triangles[0];
    EXPECT_EQ(mesh->positions[a], fabric::Vec3(-32768, 0, 0));
    EXPECT_EQ(mesh->positions[b], fabric::Vec3(32767, 0, 0));
    EXPECT_EQ(mesh->positions[c], fabric::Vec3(0, 1, 1000));
    EXPECT_EQ(mesh->normals[a], glm::vec3(0, -1, 0));
}

TEST(GltfUnpacking, DividesByTheMostWhereNumbersAreNormalised) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), mixedGltf(R"(,"normalized":true)"));
    const auto mesh = readMesh(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    const auto [a, b, c] = mesh->triangles[0];
    EXPECT_EQ(mesh->positions[a], fabric::Vec3(-1, 0, 0)) << "not a step beyond";
    EXPECT_EQ(mesh->positions[b], fabric::Vec3(1, 0, 0));
    EXPECT_NEAR(mesh->positions[c].z, 1000.0 / 32767, 1e-8);
}

TEST(GltfUnpacking, TakesTextureCoordinatesOfIntegersWithoutAnyExtension) {
    std::string bytes;
    add<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    add<std::uint16_t>(bytes, {0, 0, 65535, 0, 0, 13107});
    const auto fileOf = [&](const std::string& type) {
        return fmt::format(
            R"({{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"scene":0,
"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},
"material":0}}]}}],"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
"textures":[{{"source":0}}],"images":[{{"uri":"none.png"}}],"buffers":[{{"byteLength":48,
"uri":"data:application/octet-stream;base64,{}"}}],"bufferViews":[{{"buffer":0,"byteLength":36}},
{{"buffer":0,"byteOffset":36,"byteLength":12}}],"accessors":[
{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},
{{"bufferView":1,{},"count":3,"type":"VEC2"}}]}})",
            base64(bytes), type);
    };
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), fileOf(R"("componentType":5123,"normalized":true)"));
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    const auto [a, b, c] = mesh->triangles.at(0);
    EXPECT_EQ(mesh->textureCoordinates.at(a), glm::vec2(0, 0));
    EXPECT_EQ(mesh->textureCoordinates[b], glm::vec2(1, 0));
    EXPECT_LT(glm::distance(mesh->textureCoordinates[c], glm::vec2(0, 0.2)), 1e-6);
    const auto plain = unpacked(fileOf(R"("componentType":5126)"));
    EXPECT_TRUE(plain.ok() && !plain->has_value()) << "nothing to do";
}

/// A file of what EXT_meshopt_compression says of `code`, which is a whole bufferView.
std::string packedGltf(const std::string& code, const std::string& said) {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"extensionsUsed":["EXT_meshopt_compression"],
"buffers":[{{"byteLength":{0},"uri":"data:;base64,{1}"}}],"bufferViews":[{{"buffer":0,
"byteLength":1,"extensions":{{"EXT_meshopt_compression":{{"buffer":0,"byteLength":{0},{2}}}}}}}]}})",
        code.size(), base64(code), said);
}

std::string codeOf(const std::vector<float>& vertices, std::size_t stride) {
    const std::size_t count = vertices.size() * sizeof(float) / stride;
    std::string code(meshopt_encodeVertexBufferBound(count, stride), '\0');
    code.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(code.data()),
                                           code.size(), vertices.data(), count, stride));
    return code;
}

TEST(GltfUnpacking, ReadsNamesThatAreNoUtf8) {
    const test::TemporaryFolder folder;
    std::string text = mixedGltf();
    test::writeFile(folder.file("m.gltf"), text);
    const auto right = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(right.ok()) << right.status();
    text.insert(1, "\"extras\":{\"na\xefve\":\"M\xfchle \xc3\xa4\"},");
    test::writeFile(folder.file("m.gltf"), text);
    const auto odd = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(odd.ok()) << odd.status();
    EXPECT_EQ(odd->positions, right->positions);
    EXPECT_EQ(odd->triangles, right->triangles);
}

TEST(GltfUnpacking, FindsFilesOfNamesThatAreNoUtf8) {
    const test::TemporaryFolder folder;
    const std::string name = "M\xfchle.bin";
    std::string corners(36, '\0');
    const float ones[] = {1, 1};
    std::memcpy(corners.data() + 12, &ones[0], 4);
    std::memcpy(corners.data() + 28, &ones[1], 4);
    test::writeFile(folder.file(name), corners);
    test::writeFile(folder.file("m.gltf"),
                    R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":")" +
                        name + "\"}]}");
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 1U);
}

TEST(GltfUnpacking, SaysWhatIsWrong) {
    const std::string code = codeOf({1, 2, 3, 4, 5, 6}, 12);
    const std::string sound = R"("byteStride":12,"count":2,"mode":"ATTRIBUTES")";
    EXPECT_TRUE(unpacked(packedGltf(code, sound)).ok());
    const auto errorOf = [](const std::string& file) {
        return std::string(unpacked(file).status().message());
    };
    for (const char* said :
         {R"("byteStride":12,"count":2,"mode":"TRIANGLES")", R"("byteStride":12,"count":2)",
          R"("byteStride":10,"count":2,"mode":"ATTRIBUTES")",
          R"("byteStride":12,"count":300,"mode":"ATTRIBUTES")",
          R"("byteStride":12,"count":2,"mode":"ATTRIBUTES","filter":"QUATERNION")",
          R"("byteStride":12,"count":2,"mode":"ATTRIBUTES","filter":"UNHEARD")"})
        EXPECT_THAT(errorOf(packedGltf(code, said)),
                    HasSubstr("bufferView 0 is not packed as it says, or is damaged"))
            << said;
    EXPECT_THAT(errorOf(packedGltf(code, R"("byteStride":256,"count":99999999,"mode":"INDICES")")),
                HasSubstr("99999999 times 256 bytes packed in"));
    EXPECT_THAT(errorOf(packedGltf(code, R"("byteStride":12,"count":-2,"mode":"ATTRIBUTES")")),
                HasSubstr("bufferView 0 has no whole number 'count'"));
    EXPECT_THAT(errorOf(packedGltf(code, R"("byteOffset":7,)" + sound)), HasSubstr("has bytes 7"));
    EXPECT_THAT(errorOf(mixedGltf("", 4)),
                HasSubstr("accessor 0 has 4 elements, more than its bufferView"));
    EXPECT_THAT(errorOf(mixedGltf("", std::numeric_limits<std::size_t>::max())),
                HasSubstr("more than its bufferView"));
    EXPECT_THAT(errorOf(mixedGltf(R"(,"byteOffset":18446744073709551615)")),
                HasSubstr("more than its bufferView"));
    EXPECT_THAT(errorOf(mixedGltf(R"(,"sparse":{"count":1})")), HasSubstr("quantised and sparse"));
    std::string without = packedGltf(code, sound);
    without.replace(without.find("data:"), without.find("bufferViews") - without.find("data:"),
                    R"(none.bin"}],")");
    EXPECT_THAT(errorOf(without), HasSubstr("buffer 0 is in 'none.bin', which is not there"));
    for (const std::string& text : {std::string("{"), std::string(200'000, '['), std::string()})
        EXPECT_EQ(unpacked(text).value(), std::nullopt) << "Assimp says it";
}

TEST(GltfUnpacking, RefusesBytesThatAreSharedMoreThanAnyMeshDoes) {
    const std::string accessor =
        R"({"bufferView":0,"componentType":5121,"type":"SCALAR","count":30000,"normalized":true})";
    std::string accessors = accessor;
    for (int i = 1; i < 200; ++i) accessors += "," + accessor;
    const std::string file = fmt::format(
        R"({{"buffers":[{{"uri":"data:;base64,{}"}}],"bufferViews":[{{"buffer":0,
"byteLength":30000}}],"accessors":[{}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]}})",
        base64(std::string(30'000, 'x')), accessors);
    EXPECT_THAT(std::string(unpacked(file).status().message()),
                HasSubstr("it unpacks to more than 64 times its size"));
}

TEST(GltfUnpacking, TakesNoDamageForAMesh) {
    const test::TemporaryFolder folder;
    writeSheet(folder);
    const std::string beside = std::filesystem::path(folder.file("m.obj")).parent_path().string();
    ASSERT_EQ(std::system(fmt::format("cd '{}' && gltfpack -i m.obj -o p.glb -c", beside).c_str()),
              0);
    const std::string whole = readFile(folder.file("p.glb"));
    for (const double kept : {0.2, 0.5, 0.9, 0.99}) {
        test::writeFile(
            folder.file("cut.glb"),
            whole.substr(0, static_cast<std::size_t>(kept * static_cast<double>(whole.size()))));
        EXPECT_FALSE(readMesh(folder.file("cut.glb")).ok()) << kept;
    }
}

}  // namespace
}  // namespace eyrie::import
