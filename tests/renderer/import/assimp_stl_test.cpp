// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <cstddef>
#include <cstring>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include "renderer/import/assimp_reader.h"
#include "renderer/import/stl_text.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(AssimpReader, SaysWhichStlsWereCutOff) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& text) {
        return test::notesOfFile(folder.file("m.stl"), text);
    };
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\n";
    EXPECT_THAT(notesOf("solid a\n" + facet + facet + "endsolid a\n"), IsEmpty());
    EXPECT_THAT(notesOf("solid a\n" + facet + facet), ElementsAre(HasSubstr("without 'endsolid'")));
    EXPECT_THAT(notesOf("solid a\n" + facet + "endsolid a\nsolid b\n" + facet),
                ElementsAre(HasSubstr("without 'endsolid'")));
    EXPECT_THAT(notesOf("solid a\n" + facet + "endsolid a\nsolid b\n" + facet + "endsolid b\n"),
                IsEmpty());
}

TEST(AssimpReader, ReadsTextStlInCapitalsAndBehindBlankLines) {
    const test::TemporaryFolder folder;
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 5E-1 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\n";
    std::string capitals = facet;
    for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    for (const std::string& text :
         {"SOLID A\n" + capitals + "ENDSOLID A\n", "\r\n \nsolid A\r\n" + facet + "endsolid A\n",
          "\xef\xbb\xbf\nSolid A\n" + facet + "EndSolid A\n", "solid\n" + capitals + "endsolid\n",
          "solid A\n" + facet + "endsolid A\n"}) {
        test::writeFile(folder.file("m.stl"), text);
        const auto mesh = readWithAssimp(folder.file("m.stl"));
        ASSERT_TRUE(mesh.ok()) << text << mesh.status();
        ASSERT_EQ(mesh->triangles.size(), 1U) << text;
        EXPECT_EQ(mesh->positions[mesh->triangles[0][0]], fabric::Vec3(0.5, 0, 0)) << text;
        EXPECT_THAT(mesh->notes, IsEmpty()) << text;
    }
    EXPECT_THAT(test::notesOfFile(folder.file("m.stl"), "\nSOLID A\n" + capitals),
                ElementsAre(HasSubstr("without 'endsolid'")));
}

TEST(StlTextForAssimp, LeavesAsTheyAreFilesThatAreReadRightly) {
    EXPECT_FALSE(stlTextForAssimp("solid Of Names\nfacet normal 1E3 0 0\nendsolid Of Names"));
    EXPECT_FALSE(stlTextForAssimp("Solid" + std::string(79, '\0'))) << "binary";
    // As many facets as bytes of its count that are no zeros say, and letters among its numbers.
    constexpr std::size_t kBytes = 84 + std::size_t{50} * 0x01010101;
    void* const sparse = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    ASSERT_NE(sparse, MAP_FAILED);
    const std::string begin = "solid part" + std::string(70, ' ') + "\x01\x01\x01\x01\nAA\n";
    std::memcpy(sparse, begin.data(), begin.size());
    EXPECT_FALSE(stlTextForAssimp({static_cast<const char*>(sparse), kBytes})) << "binary";
    munmap(sparse, kBytes);
    EXPECT_FALSE(stlTextForAssimp(""));
    EXPECT_FALSE(stlTextForAssimp(" \nsoli"));
}

TEST(AssimpReader, SaysHowLongABinaryStlOughtToBe) {
    const test::TemporaryFolder folder;
    for (const std::string header : {"made by hand", "solid made by hand"}) {
        std::string file = header + std::string(84 + 2 * 50 - header.size(), '\0');
        file[80] = 2;
        file[84 + 26] = file[84 + 40] = '\x40';  // corners at 0 0 0, 2 0 0 and 0 2 0, and no others
        test::writeFile(folder.file("m.stl"), file);
        EXPECT_TRUE(readWithAssimp(folder.file("m.stl")).ok()) << header;
        test::writeFile(folder.file("m.stl"), file.substr(0, 150));
        EXPECT_THAT(std::string(readWithAssimp(folder.file("m.stl")).status().message()),
                    HasSubstr("m.stl: its header counts 2 triangles, which take 184 bytes, and it "
                              "has 150; it is cut off"))
            << header;
    }
}

/// A binary STL of two facets, each with its corners at 0 0 0, 2 0 0 and 0 2 0, and its colour in
/// the last two of its 50 bytes.
std::string twoFacets() {
    std::string file(84 + 2 * 50, '\0');
    file[80] = 2;
    for (const std::size_t facet : {84U, 134U}) file[facet + 26] = file[facet + 40] = '\x40';
    return file;
}

/// The first is red, and the second, without the highest bit, has no colour.
TEST(AssimpReader, HasFacetsOfAnStlWithoutAColourOpaque) {
    const test::TemporaryFolder folder;
    std::string file = twoFacets();
    file[84 + 49] = '\xFC';
    test::writeFile(folder.file("m.stl"), file);
    const auto mesh = readWithAssimp(folder.file("m.stl"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->triangles.size(), 2U);
    EXPECT_EQ(mesh->colours[mesh->triangles[0][0]], (fabric::Rgba{255, 0, 0, 255}));
    EXPECT_EQ(mesh->colours[mesh->triangles[1][0]], (fabric::Rgba{153, 153, 153, 255}));
    EXPECT_THAT(mesh->notes, IsEmpty());
}

/// The first facet is red, of its own; the second has the green of the part. Those with the highest
/// bit the other way around are MeshLab's.
TEST(AssimpReader, TakesColoursOfAnStlAsMaterialiseMeansThem) {
    const test::TemporaryFolder folder;
    for (const bool isMeshLab : {false, true}) {
        std::string file = twoFacets();
        file.replace(0, 6, "COLOR=");
        file[7] = file[9] = '\xFF';
        file[84 + 48] = 31;
        file[isMeshLab ? 84 + 49 : 134 + 49] = '\x80';
        test::writeFile(folder.file("m.stl"), file);
        const auto mesh = readWithAssimp(folder.file("m.stl"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        ASSERT_EQ(mesh->triangles.size(), 2U);
        EXPECT_EQ(mesh->colours[mesh->triangles[0][0]], (fabric::Rgba{255, 0, 0, 255}));
        EXPECT_EQ(mesh->colours[mesh->triangles[1][0]], (fabric::Rgba{0, 255, 0, 255}));
    }
}

}  // namespace
}  // namespace eyrie::import
