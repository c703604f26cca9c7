// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/gltf_extensions.h"

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::span<const std::byte> bytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string requiring(std::string_view names) {
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "extensionsUsed": [{0}], "extensionsRequired" : [ {0} ]}})",
        names);
}

std::string glbOf(std::string json) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string file = "glTF";
    const auto add = [&file](std::uint32_t value) {
        file.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(2);
    add(static_cast<std::uint32_t>(20 + json.size()));
    add(static_cast<std::uint32_t>(json.size()));
    add(0x4E4F534A);
    return file + json;
}

TEST(GltfExtensions, ThatAreReadMayBeRequired) {
    EXPECT_TRUE(checkGltfExtensions(bytesOf(R"({"asset": {"version": "2.0"}})")).ok());
    EXPECT_TRUE(checkGltfExtensions(bytesOf(requiring(""))).ok());
    EXPECT_TRUE(checkGltfExtensions(
                    bytesOf(requiring(R"("KHR_draco_mesh_compression", "KHR_materials_unlit",)"
                                      R"("KHR_texture_transform", "KHR_lights_punctual", )"
                                      R"("KHR_mesh_quantization", "EXT_meshopt_compression")")))
                    .ok());
}

TEST(GltfExtensions, ThatAreNotReadAreNamedWithWhatToDo) {
    for (const std::string& file : {requiring(R"("KHR_materials_ior" ,"EXT_unheard_of")"),
                                    glbOf(requiring(R"("EXT_unheard_of")"))}) {
        const absl::Status status = checkGltfExtensions(bytesOf(file));
        EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(status.message()), HasSubstr("EXT_unheard_of"));
    }
    const absl::Status packed =
        checkGltfExtensions(bytesOf(requiring(R"("KHR_meshopt_compression")")));
    EXPECT_THAT(std::string(packed.message()),
                testing::AllOf(HasSubstr("KHR_meshopt_compression"), HasSubstr("Draco")));
}

TEST(GltfExtensions, OfAbsurdNamesAreNamedWithoutWhatTerminalsObeyAndNotAtLength) {
    const absl::Status status =
        checkGltfExtensions(bytesOf(requiring("\"\x1b[31m\n" + std::string(100'000, 'x') + "\"")));
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    const std::string message(status.message());
    EXPECT_THAT(message, HasSubstr("\\x1b[31m\\x0a"));
    EXPECT_LT(message.size(), 400U);
}

TEST(GltfExtensions, AreWhatTheFileSaysTheyAreAndNotWhatItsTextsSay) {
    EXPECT_TRUE(
        checkGltfExtensions(bytesOf(R"({"nodes": [{"name": "extensionsRequired"}]})")).ok());
    for (std::string_view file :
         {R"({"extensionsRequired")", R"({"extensionsRequired":)", R"({"extensionsRequired":[)",
          R"({"extensionsRequired":[])", R"({"extensionsRequired": 3)", "glTF"})
        EXPECT_TRUE(checkGltfExtensions(bytesOf(file)).ok()) << file;
    EXPECT_FALSE(checkGltfExtensions(bytesOf(R"({"extensionsRequired":["x)")).ok());
}

TEST(GltfExtensions, ThatMoveRepeatHideOrClearMeshesAreToldOfWhereTheyAreLeftOut) {
    EXPECT_THAT(gltfCaveats(bytesOf(R"({"extensionsUsed": ["KHR_materials_sheen"]})")), IsEmpty());
    EXPECT_THAT(gltfCaveats(bytesOf(R"({"extensionsUsed": ["KHR_materials_unlit"]})")),
                testing::ElementsAre(testing::HasSubstr("lit as the rest is")));
    EXPECT_THAT(
        gltfCaveats(bytesOf(R"({"extensionsUsed": ["CESIUM_RTC", "EXT_mesh_gpu_instancing"]})")),
        ElementsAre(HasSubstr("CESIUM_RTC"), HasSubstr("EXT_mesh_gpu_instancing")));
    EXPECT_THAT(
        gltfCaveats(bytesOf(
            R"({"extensionsUsed": ["KHR_node_visibility", "KHR_materials_transmission"]})")),
        ElementsAre(HasSubstr("nodes, too, that are not to be seen"), HasSubstr("is opaque")));
}

TEST(GltfScenes, ThatAreNotShownAreCounted) {
    const auto caveatsOf = [](std::string_view scenes) {
        return gltfCaveats(bytesOf(fmt::format(R"({{"scene": 0, "scenes"{}}})", scenes)));
    };
    EXPECT_THAT(caveatsOf(R"( : [{"name": "}, {\"]", "nodes": [0, 1], "extras": {"a": [{}]}}])"),
                IsEmpty());
    EXPECT_THAT(caveatsOf(R"(: [ {"nodes": [0]}, {"nodes": [1]},{}])"),
                ElementsAre(HasSubstr("left out 2 of its 3 scenes")));
    for (const std::string_view broken : {"", ":", ":[", ":[}", ":3", ": []", R"(:["\)"})
        EXPECT_THAT(caveatsOf(broken), IsEmpty()) << broken;
}

TEST(GltfExtensions, OfTexturesAreToldOfWhereThereIsNoOtherImage) {
    for (const std::string_view name :
         {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"}) {
        const auto caveatsOf = [&](std::string_view otherwise) {
            return gltfCaveats(bytesOf(fmt::format(
                R"({{"extensionsUsed": ["{0}"], "nodes": [{{"name": "textures"}}],
"textures": [{{"source": 1}}, {{"extensions": {{"{0}": {{"source": 0}}}}{1}}}]}})",
                name, otherwise)));
        };
        EXPECT_THAT(caveatsOf(""), ElementsAre(testing::AllOf(HasSubstr("1 of 2 textures"),
                                                              HasSubstr(std::string(name)))));
        EXPECT_THAT(caveatsOf(R"(, "source": 1)"), IsEmpty());
    }
    for (const std::string_view textures : {"", R"(, "textures": 3)", R"(, "textures": [3])"})
        EXPECT_THAT(gltfCaveats(bytesOf(
                        fmt::format(R"({{"extensionsUsed": ["EXT_texture_webp"]{}}})", textures))),
                    IsEmpty());
}

TEST(GltfExtensions, AreLookedAtBeforeAFileIsRead) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), requiring(R"("EXT_unheard_of")"));
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    EXPECT_THAT(std::string(mesh.status().message()),
                testing::AllOf(HasSubstr("m.gltf"), HasSubstr("EXT_unheard_of")));
}

}  // namespace
}  // namespace eyrie::import
