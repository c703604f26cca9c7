// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dxf_text.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fabric/box.h"
#include "renderer/import/assimp_reader.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A unit square of a corner at 5, 5, 0.
constexpr std::string_view kFace =
    "0\n3DFACE\n8\n0\n10\n5\n20\n5\n30\n0\n11\n6\n21\n5\n31\n0\n12\n6\n22\n6\n32\n0\n13\n5\n23\n6\n"
    "33\n0\n";

/// That square, and what else there is, in a block with its base at `base`, 0, 0, of which
/// `inserts` is what the drawing has.
std::string dxfOf(double base, std::string_view others, std::string_view inserts) {
    return fmt::format(
        "  0\nSECTION\n  2\nBLOCKS\n  0\nBLOCK\n  2\nB\n 10\n{}\n 20\n0\n 30\n0\n{}{}0\nENDBLK\n"
        "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{}0\nENDSEC\n0\nEOF\n",
        base, kFace, others, inserts);
}

struct Read {
    fabric::Box bounds;
    std::size_t triangles;
    std::vector<std::string> notes;
};

Read read(const std::string& dxf) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.dxf"), dxf);
    const auto mesh = readWithAssimp(folder.file("m.dxf"));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    if (!mesh.ok())
        return {};
    Read read{{}, mesh->triangles.size(), mesh->notes};
    for (const fabric::Vec3& position : mesh->positions) read.bounds.grow(position);
    return read;
}

TEST(DxfForAssimp, PutsBlocksWhereTheirScaleAndBaseHaveThem) {
    struct Case {
        double base;
        std::string_view scale;
        double least, most;  // x
    };
    for (const auto& [base, scale, least, most] :
         {Case{0, "", 105, 106}, Case{0, "41\n2\n", 110, 112}, Case{0, "41\n-1\n", 94, 95},
          Case{5, "", 100, 101}, Case{5, "41\n2\n", 100, 102}}) {
        const Read found =
            read(dxfOf(base, "", fmt::format("0\nINSERT\n2\nB\n10\n100\n{}", scale)));
        EXPECT_EQ(found.bounds.min, fabric::Vec3(least, 5, 0)) << base << scale;
        EXPECT_EQ(found.bounds.max, fabric::Vec3(most, 6, 0)) << base << scale;
        EXPECT_THAT(found.notes, IsEmpty());
    }
}

TEST(DxfForAssimp, RepeatsBlocksInRowsAndColumns) {
    const Read found =
        read(dxfOf(5, "", "0\nINSERT\n2\nB\n42\n2\n70\n3\n71\n2\n44\n10\n45\n100\n"));
    EXPECT_EQ(found.triangles, 12U);
    EXPECT_EQ(found.bounds.min, fabric::Vec3(0, 10, 0));
    EXPECT_EQ(found.bounds.max, fabric::Vec3(21, 112, 0));
    EXPECT_THAT(found.notes, IsEmpty());
}

TEST(DxfForAssimp, KeepsBlocksApartFromWhatIsNotReadInThem) {
    const Read found =
        read(dxfOf(5, "0\nHATCH\n2\nSOLID\n10\n77\n1\n{none\n",
                   fmt::format("0\nINSERT\n2\nB\n10\n100\n0\nMTEXT\n1\n{{none\n{}", kFace)));
    EXPECT_EQ(found.triangles, 4U);
    EXPECT_EQ(found.bounds.max, fabric::Vec3(101, 6, 0));
    EXPECT_THAT(found.notes, IsEmpty());
}

TEST(DxfForAssimp, LeavesAsTheyAreFilesThatAreReadRightly) {
    EXPECT_FALSE(dxfForAssimp(dxfOf(0, "", "0\nINSERT\n2\nB\n10\n1\n50\n0\n70\n1\n")));
    EXPECT_FALSE(dxfForAssimp(""));
    EXPECT_FALSE(dxfForAssimp("0\nINSERT\n41\n2\n"));
    EXPECT_FALSE(dxfForAssimp(dxfOf(0, "", "0\nINSERT\n2\nB\n41\n0\n"))) << "which has no area";
}

/// Groups of the codes 10, 20, 30 on.
std::string placeOf(int first, double x, double y, double z) {
    return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n", first, x, first + 10, y, first + 20, z);
}

std::string drawingOf(const std::string& entities, const std::string& layers = "") {
    return "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n" + layers +
           "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n";
}

TEST(DxfForAssimp, KeepsCornersOfPolyfaceMeshesBeforeEdgesThatAreNotShown) {
    std::string mesh = "0\nPOLYLINE\n8\n0\n66\n1\n70\n64\n71\n4\n72\n2\n";
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
        mesh += "0\nVERTEX\n8\n0\n" + placeOf(10, x, y, -2) + "70\n192\n";
    mesh += "0\nVERTEX\n8\n0\n" + placeOf(10, 0, 0, 0) +
            "70\n128\n71\n1\n72\n2\n73\n-3\n"
            "0\nVERTEX\n8\n0\n70\n128\n71\n -1\n72\n3\n73\n-4\n0\nSEQEND\n";
    const Read found = read(drawingOf(mesh));
    EXPECT_EQ(found.triangles, 2U);
    EXPECT_EQ(found.bounds.min, fabric::Vec3(0, 0, -2));
    EXPECT_EQ(found.bounds.max, fabric::Vec3(1, 1, -2));
}

/// Of a face that has such groups.
fabric::Rgba colourOf(const std::string& groups, const std::string& layers = "") {
    const std::string face = "0\n3DFACE\n" + groups + placeOf(10, 0, 0, 0) + placeOf(11, 1, 0, 0) +
                             placeOf(12, 1, 1, 0) + placeOf(13, 1, 1, 0);
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.dxf"), drawingOf(face, layers));
    const auto mesh = readWithAssimp(folder.file("m.dxf"));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh.ok() && !mesh->colours.empty() ? mesh->colours[0] : fabric::Rgba{};
}

TEST(DxfForAssimp, HasTheColoursOfAutoCadsTable) {
    struct Case {
        int index;
        int red, green, blue;
    };
    for (const auto& [index, red, green, blue] :
         {Case{1, 255, 0, 0},   {2, 255, 255, 0},   {3, 0, 255, 0},
          {6, 255, 0, 255},     {7, 153, 153, 153}, {0, 153, 153, 153},
          {8, 65, 65, 65},      {10, 255, 0, 0},    {11, 255, 170, 170},
          {12, 189, 0, 0},      {30, 255, 127, 0},  {50, 255, 255, 0},
          {70, 127, 255, 0},    {90, 0, 255, 0},    {134, 0, 129, 129},
          {170, 0, 0, 255},     {200, 191, 0, 255}, {239, 79, 52, 65},
          {240, 255, 0, 63},    {250, 51, 51, 51},  {255, 255, 255, 255},
          {256, 153, 153, 153}, {-5, 0, 0, 255},    {-2147483648, 153, 153, 153}}) {
        const fabric::Rgba colour = colourOf(fmt::format("8\n0\n62\n{}\n", index));
        EXPECT_NEAR(colour.r, red, 1) << index;
        EXPECT_NEAR(colour.g, green, 1) << index;
        EXPECT_NEAR(colour.b, blue, 1) << index;
        EXPECT_EQ(colour.a, 255) << index;
    }
}

TEST(DxfForAssimp, HasColoursOfLayersAndOnesOfRedGreenAndBlue) {
    const std::string layers =
        "0\nLAYER\n2\nwalls\n70\n0\n62\n1\n0\nLAYER\n2\nroof\n62\n3\n420\n1056816\n"
        "0\nLAYER\n2\n0\n62\n7\n";
    const fabric::Rgba red{255, 0, 0, 255}, grey{153, 153, 153, 255}, own{16, 32, 48, 255};
    EXPECT_EQ(colourOf("8\nwalls\n", layers), red);
    EXPECT_EQ(colourOf("62\n256\n8\nwalls\n", layers), red);
    EXPECT_EQ(colourOf("8\nroof\n", layers), own);
    EXPECT_EQ(colourOf("8\n0\n", layers), grey);
    EXPECT_EQ(colourOf("62\n1\n", layers), red) << "on no layer";
    EXPECT_EQ(colourOf("8\nwalls\n62\n5\n420\n1056816\n", layers), own);
    EXPECT_EQ(colourOf("8\nwalls\n62\n7\n", layers), grey);
}

struct Coloured {
    std::vector<fabric::Rgba> colours;  ///< each once
    std::vector<std::string> notes;
};

/// Of a face with such groups in a block that is inserted with each of these.
Coloured colouredOf(const std::string& face, const std::vector<std::string>& inserts) {
    const std::string block = "0\n3DFACE\n" + face + placeOf(10, 0, 0, 0) + placeOf(11, 1, 0, 0) +
                              placeOf(12, 1, 1, 0) + placeOf(13, 1, 1, 0);
    std::string dxf =
        "0\nSECTION\n2\nTABLES\n0\nLAYER\n2\nwalls\n62\n1\n0\nLAYER\n2\nroof\n62\n3\n0\nENDSEC\n"
        "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nB\n10\n0\n20\n0\n30\n0\n" +
        block + "0\nENDBLK\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
    for (const std::string& insert : inserts) dxf += "0\nINSERT\n2\nB\n" + insert;
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.dxf"), dxf + "0\nENDSEC\n0\nEOF\n");
    const auto mesh = readWithAssimp(folder.file("m.dxf"));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    Coloured found;
    for (const fabric::Rgba& colour : mesh.ok() ? mesh->colours : std::vector<fabric::Rgba>())
        if (std::ranges::count(found.colours, colour) == 0)
            found.colours.push_back(colour);
    if (mesh.ok())
        found.notes = mesh->notes;
    return found;
}

TEST(DxfForAssimp, HasTheColoursThatBlocksAreInsertedWith) {
    const fabric::Rgba red{255, 0, 0, 255}, green{0, 255, 0, 255}, grey{153, 153, 153, 255};
    const std::string walls = "8\nwalls\n", roof = "8\nroof\n", green3 = "62\n3\n";
    struct Case {
        std::string face;
        std::vector<std::string> inserts;
        fabric::Rgba colour;
    };
    for (const auto& [face, inserts, colour] :
         {Case{"8\n0\n62\n0\n", {green3 + walls}, green},  // BYBLOCK
          {"8\n0\n62\n0\n", {walls}, red},
          {"8\n0\n", {green3 + walls, walls}, red},
          {"", {roof}, green},
          {"8\nwalls\n", {roof}, red},
          {"8\n0\n62\n1\n", {roof}, red},
          {"8\nroof\n62\n0\n", {green3 + walls, roof}, green},
          {"8\n0\n62\n0\n", {"8\n0\n"}, grey}}) {
        const Coloured found = colouredOf(face, inserts);
        EXPECT_THAT(found.colours, ElementsAre(colour)) << face << inserts[0];
        EXPECT_THAT(found.notes, IsEmpty()) << face << inserts[0];
    }
    for (const std::string face : {"8\n0\n62\n0\n", "8\n0\n"}) {
        const Coloured found = colouredOf(face, {walls, roof});
        EXPECT_THAT(found.colours, ElementsAre(grey)) << face;
        EXPECT_THAT(found.notes, ElementsAre(HasSubstr("1 surfaces of blocks are grey"))) << face;
    }
}

TEST(DxfCaveats, CountBlocksThatAreNotPutAsTheFileHasThem) {
    const std::string insert = "0\nINSERT\n2\nB\n";
    EXPECT_THAT(read(dxfOf(0, "", insert)).notes, IsEmpty());
    for (const std::string_view other :
         {"50\n90\n", "230\n-1\n", "210\n1\n230\n0\n", "70\n32767\n71\n32767\n"}) {
        const Read found = read(dxfOf(0, "", insert + insert + std::string(other)));
        EXPECT_EQ(found.triangles, 4U) << other;
        EXPECT_THAT(found.notes, ElementsAre(HasSubstr("1 blocks are not put"))) << other;
    }
}

/// Sixteen of these are as many copies as there may be.
TEST(DxfCaveats, CountBlocksThatAFileRepeatsTooOften) {
    std::string inserts;
    for (int i = 0; i < 18; ++i) inserts += "0\nINSERT\n2\nB\n70\n64\n71\n64\n";
    const std::string dxf = dxfOf(0, "", inserts);
    EXPECT_THAT(dxfCaveats(dxf), ElementsAre(HasSubstr("2 blocks are not put")));
    EXPECT_LT(dxfForAssimp(dxf)->size(), std::size_t{16} << 20);
}

TEST(DxfCaveats, CountBlocksInRowsWhoseNamesAreTooLongForSoManyCopies) {
    for (const std::size_t length : {std::size_t{255}, std::size_t{60000}}) {
        const std::string dxf = dxfOf(
            0, "", fmt::format("0\nINSERT\n2\n{}\n70\n256\n71\n256\n", std::string(length, 'B')));
        EXPECT_THAT(dxfCaveats(dxf), SizeIs(length > 255 ? 1 : 0));
        EXPECT_LT(dxfForAssimp(dxf)->size(), std::size_t{32} << 20);
    }
}

TEST(DxfCaveats, NameTheSurfacesThatAreNotRead) {
    const std::string entities =
        fmt::format("{}{}", kFace,
                    "0\nSOLID\n10\n5\n0\nSOLID\n10\n5\n0\n3DSOLID\n0\nTEXT\n0\nCIRCLE\n"
                    "40\n5\n0\nLWPOLYLINE\n39\n3\n0\nPOLYLINE\n70\n17\n0\nSEQEND\n");
    EXPECT_THAT(dxfCaveats(dxfOf(0, "", entities)),
                ElementsAre(HasSubstr(
                    "left out 5 surfaces of the kinds 3DSOLID, LWPOLYLINE, POLYLINE, SOLID,")));
}

}  // namespace
}  // namespace eyrie::import
