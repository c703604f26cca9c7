// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/companion_folder.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/mesh_reader.h"
#include "tests/renderer/import/mesh_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A folder "in", of which alone companions are read, with files beside it.
class CompanionFolder : public testing::Test {
protected:
    CompanionFolder() {
        fs::create_directories(in("sub"));
        EXPECT_TRUE(keepCompanionsBelow(folder_.file("in")).ok());
        test::writeFile(folder_.file("secret.mtl"), kRed);
    }
    ~CompanionFolder() override { EXPECT_TRUE(keepCompanionsBelow("").ok()); }

    std::string in(const std::string& name) const { return folder_.file("in/" + name); }

    /// An OBJ with such a material file.
    std::string objOf(const std::string& library) const {
        test::writeFile(in("m.obj"),
                        "mtllib " + library + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
        return in("m.obj");
    }

    void expectMissing(const std::string& library) const {
        const std::string obj = objOf(library);
        const auto mesh = readMesh(obj);
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_THAT(mesh->colours, testing::Each(testing::Ne(fabric::Rgba{255, 0, 0, 255})))
            << library;
        EXPECT_THAT(mesh->notes, Contains(HasSubstr("1 of 1 material files are missing")))
            << library;
        EXPECT_THAT(*companionsOf(obj), IsEmpty()) << library;
    }

    static constexpr const char* kRed = "newmtl red\nKd 1 0 0\n";
    const test::TemporaryFolder folder_;
};

TEST_F(CompanionFolder, HasMaterialFilesThatLieInIt) {
    for (const std::string library : {"sub/own.mtl", "sub/../own.mtl", "own.mtl"}) {
        test::writeFile(in(library), kRed);
        const auto mesh = readMesh(objOf(library));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_THAT(mesh->colours, Contains(fabric::Rgba{255, 0, 0, 255})) << library;
        EXPECT_THAT(mesh->notes, IsEmpty()) << library;
    }
}

TEST_F(CompanionFolder, HasNoMaterialFilesThatLieBeyondIt) {
    fs::create_symlink(folder_.file("secret.mtl"), in("link.mtl"));
    fs::create_directory_symlink(folder_.file("."), in("up"));
    for (const std::string& library :
         {std::string("../secret.mtl"), std::string("sub/../../secret.mtl"),
          std::string("..\\secret.mtl"), std::string("%2e%2e/secret.mtl"),
          std::string("../in/../secret.mtl"), folder_.file("secret.mtl"), std::string("link.mtl"),
          std::string("LINK.MTL"), std::string("up/secret.mtl")})
        expectMissing(library);
    ASSERT_TRUE(keepCompanionsBelow("").ok());
    EXPECT_THAT(readMesh(objOf("../secret.mtl"))->colours, Contains(fabric::Rgba{255, 0, 0, 255}));
}

TEST_F(CompanionFolder, HasNoFoldersOfWhichItsNameIsABeginning) {
    fs::create_directories(folder_.file("inside"));
    test::writeFile(folder_.file("inside/secret.mtl"), kRed);
    expectMissing("../inside/secret.mtl");
}

TEST_F(CompanionFolder, HasNoImagesThatLieBeyondIt) {
    for (const std::string& image : {std::string("../a.tga"), folder_.file("a.tga")}) {
        test::writeFile(folder_.file("a.tga"), std::string("an image"));
        test::writeFile(in("own.mtl"), kRed + ("map_Kd " + image + "\n"));
        test::writeFile(in("m.obj"),
                        "mtllib own.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl red\n"
                        "f 1/1 2/1 3/1\n");
        const auto mesh = readMesh(in("m.obj"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_THAT(mesh->notes,
                    ElementsAre(testing::AllOf(HasSubstr("1 of 1 textures cannot be read"),
                                               HasSubstr("is not there"))));
    }
}

TEST_F(CompanionFolder, HasNoBuffersThatLieBeyondIt) {
    constexpr const char* kGltf =
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
"accessors":[{{"bufferView":0,"componentType":{},"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}}],"bufferViews":[{{"buffer":0,"byteLength":36,"byteStride":12}}],
"buffers":[{{"byteLength":36,"uri":"{}"}}]}})";
    constexpr int kFloat = 5126, kByte = 5121;  // which is unpacked before Assimp reads it
    for (const char* name : {"secret.bin", "in/own.bin"}) {
        std::string corners(36, '\0');
        corners.replace(14, 2, "\x80\x3F").replace(30, 2, "\x80\x3F");
        corners[24] = corners[1] = '\1';
        test::writeFile(folder_.file(name), corners);
    }
    for (const int type : {kFloat, kByte})
        for (const std::string& uri :
             {std::string("../secret.bin"), std::string("%2E%2E/secret.bin"),
              folder_.file("secret.bin"), std::string("own.bin")}) {
            test::writeFile(in("m.gltf"), fmt::format(kGltf, type, uri));
            EXPECT_EQ(readMesh(in("m.gltf")).ok(), uri == "own.bin") << type << ' ' << uri;
        }
}

TEST_F(CompanionFolder, HasNoScenesThatLieBeyondIt) {
    const auto x3dOf = [](int x, const std::string& more) {
        return fmt::format(
            "<?xml version='1.0'?><X3D><Scene><Shape><IndexedFaceSet coordIndex='0 1 2 -1'>"
            "<Coordinate point='{0} 0 0 {0} 1 0 {0} 0 "
            "1'/></IndexedFaceSet></Shape>{1}</Scene></X3D>",
            x, more);
    };
    test::writeFile(folder_.file("secret.x3d"), x3dOf(7, ""));
    test::writeFile(in("m.x3d"), x3dOf(0, "<Inline url='../secret.x3d'/>"));
    const auto isShown = [&] {
        const auto mesh = readMesh(in("m.x3d"));
        return mesh.ok() && std::ranges::any_of(mesh->positions, [](const fabric::Vec3& position) {
                   return position.x == 7;
               });
    };
    EXPECT_FALSE(isShown());
    ASSERT_TRUE(keepCompanionsBelow("").ok());
    EXPECT_TRUE(isShown());
}

TEST(KeepCompanionsBelow, WantsAFolderThatIsThere) {
    const test::TemporaryFolder folder;
    EXPECT_TRUE(absl::IsNotFound(keepCompanionsBelow(folder.file("none"))));
    EXPECT_TRUE(keepCompanionsBelow("").ok());
}

}  // namespace
}  // namespace eyrie::import
