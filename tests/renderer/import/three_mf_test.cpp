// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/three_mf.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <minizip/zip.h>

#include "renderer/import/mesh_reader.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kTypes =
    R"(<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default
Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default
Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)";
constexpr const char* kRelations =
    R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r"
Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)";

/// A square of two triangles, with what else is said of these and of their object.
std::string squareOf(std::string_view ofObject, std::string_view ofFirst,
                     std::string_view ofSecond) {
    return fmt::format(
        R"(<object id="1" type="model" {}><mesh><vertices><vertex x="0" y="0" z="0"/>
<vertex x="1" y="0" z="0"/><vertex x="1" y="1" z="0"/><vertex x="0" y="1" z="0"/></vertices>
<triangles><triangle v1="0" v2="1" v3="2" {}/><triangle v1="0" v2="2" v3="3" {}/></triangles>
</mesh></object>)",
        ofObject, ofFirst, ofSecond);
}

std::string modelOf(std::string_view resources, std::string_view item) {
    return fmt::format(
        R"(<?xml version="1.0"?><!-- it's a model --><model unit="millimeter"
xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
xmlns:prod="http://schemas.microsoft.com/3dmanufacturing/production/2015/06">
<resources>{}</resources><build>{}</build></model>)",
        resources, item);
}

/// Of one square at 5, 0, 0, with groups of properties before it.
std::string modelOfASquare(std::string_view groups, const std::string& square) {
    return modelOf(std::string(groups) + square,
                   R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>)");
}

constexpr const char* kMaterials =
    R"(<basematerials id="7"><base name="a" displaycolor="#FF8000"/><base name="b"
displaycolor="#0000FF"/></basematerials>)";

class ThreeMf : public testing::Test {
protected:
    absl::StatusOr<TriangleMesh> read(const std::string& model) {
        const std::map<std::string, std::string> parts = {{"[Content_Types].xml", kTypes},
                                                          {"_rels/.rels", kRelations},
                                                          {"3D/3dmodel.model", model}};
        const std::string path = folder_.file("m.3mf");
        const zipFile archive = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
        for (const auto& [name, text] : parts) {
            zipOpenNewFileInZip(archive, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr,
                                Z_DEFLATED, Z_DEFAULT_COMPRESSION);
            zipWriteInFileInZip(archive, text.data(), static_cast<unsigned int>(text.size()));
            zipCloseFileInZip(archive);
        }
        zipClose(archive, nullptr);
        return readMesh(path);
    }

private:
    const test::TemporaryFolder folder_;
};

TEST_F(ThreeMf, HasTheColourOfAnObjectsMaterialWithoutAnOpacity) {
    const auto mesh = read(modelOfASquare(kMaterials, squareOf(R"(pid="7" pindex="0")", "", "")));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->positions[0], fabric::Vec3(5, 0, 0));
    EXPECT_THAT(mesh->colours, testing::Each(fabric::Rgba{255, 128, 0, 255}));
    EXPECT_THAT(mesh->notes, IsEmpty());
}

TEST_F(ThreeMf, SaysWhichColoursItLeavesOut) {
    const std::string second = R"(p1="1")", ofGroup = R"(pid="8" pindex="0")";
    const std::string ofMaterial = R"(pid="7" pindex="0")";
    const std::string group = R"(<m:colorgroup id="8"><m:color color="#FF0000"/></m:colorgroup>)";
    for (const std::string& model :
         {modelOfASquare(kMaterials, squareOf(ofMaterial, "", second)),
          modelOfASquare(kMaterials, squareOf("", "", R"(pid="7" p1="1")")),
          modelOfASquare(group, squareOf(ofGroup, "", "")),
          modelOfASquare(kMaterials + group, squareOf(ofMaterial, R"(pid="8" p1="0")", ""))}) {
        const auto mesh = read(model);
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_EQ(mesh->triangles.size(), 2U);
        EXPECT_THAT(mesh->notes, ElementsAre(HasSubstr("left out colours of 1 objects"))) << model;
    }
    for (const std::string& square :
         {squareOf("", "", ""), squareOf(ofMaterial, R"(p1="0")", ""),
          squareOf("", R"(pid="7" p1="1" p2="1" p3="1")", R"(pid="7" p1="1")")})
        EXPECT_THAT(read(modelOfASquare(kMaterials, square))->notes, IsEmpty()) << square;
}

/// Whose numbers there may be those of objects here, too.
TEST_F(ThreeMf, IsRefusedWhereItsObjectsAreInOtherParts) {
    const std::string path = R"(prod:path="/3D/Objects/o.model")";
    const std::string component = fmt::format(
        R"(<object id="2" type="model"><components><component {} objectid="1"/></components>
</object>)",
        path);
    for (const std::string& model :
         {modelOf(squareOf("", "", "") + component, R"(<item objectid="2"/>)"),
          modelOf(squareOf("", "", ""), fmt::format(R"(<item objectid="1" {}/>)", path))}) {
        const absl::Status refused = read(model).status();
        EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
        EXPECT_THAT(std::string(refused.message()),
                    testing::AllOf(HasSubstr("m.3mf: its object 1 is in another part of it, "
                                             "'/3D/Objects/o.model'"),
                                   HasSubstr("export it in one part")));
    }
}

TEST(CountRecoloured3mfObjects, ReadsWhateverThereIs) {
    const std::string model = modelOfASquare(
        kMaterials, squareOf(R"(pid="7" pindex="0")", R"(pid="9" p1="0")", R"(p1="1")"));
    EXPECT_EQ(*countRecoloured3mfObjects(model), 1U);
    for (std::size_t length = 0; length < model.size(); ++length)
        EXPECT_TRUE(countRecoloured3mfObjects(model.substr(0, length)).ok()) << length;
}

}  // namespace
}  // namespace eyrie::import
