// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/amf_text.h"
#include "renderer/import/assimp_reader.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A triangle that is put at 10, 5, 2 and at 20, 5, 2 and turned by such an angle.
std::string amfOfInstances(std::string_view angle) {
    std::string amf =
        "<?xml version=\"1.0\"?><amf unit=\"meter\"><object id=\"0\"><mesh><vertices>";
    for (const char* vertex : {"<x>0</x><y>0</y>", "<x>1</x><y>0</y>", "<x>0</x><y>1</y>"})
        amf += fmt::format("<vertex><coordinates>{}<z>0</z></coordinates></vertex>", vertex);
    amf +=
        "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh>"
        "</object><constellation id=\"1\">";
    for (const int x : {10, 20})
        amf += fmt::format(
            "<instance objectid=\"0\"><deltax>{}</deltax><deltay>5</deltay><deltaz>2</deltaz>"
            "<rx>0</rx><ry>{}</ry><rz>\n{}</rz></instance>",
            x, angle, angle);
    return amf + "</constellation></amf>";
}

TEST(AssimpReader, PutsInstancesOfAmfAtTheirPlacesWhateverTheirAngles) {
    const test::TemporaryFolder folder;
    for (const std::string_view angle : {"0", "0.00", "90"}) {
        test::writeFile(folder.file("m.amf"), amfOfInstances(angle));
        const auto mesh = readWithAssimp(folder.file("m.amf"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_THAT(mesh->positions,
                    testing::IsSupersetOf({fabric::Vec3(10, 5, 2), fabric::Vec3(20, 5, 2)}));
        EXPECT_THAT(
            mesh->notes,
            testing::Contains(HasSubstr("rotations of 2 instances")).Times(angle == "90" ? 1 : 0));
    }
}

TEST(AssimpReader, CountsObjectsOfAmfThatHaveSeveralMeshes) {
    const test::TemporaryFolder folder;
    const std::string one = amfOfInstances("0");
    const std::size_t begin = one.find("<mesh>"), end = one.find("</object>");
    std::string two = one;
    two.insert(end, one.substr(begin, end - begin));
    EXPECT_THAT(test::notesOfFile(folder.file("m.amf"), one), IsEmpty());
    EXPECT_THAT(test::notesOfFile(folder.file("m.amf"), two),
                ElementsAre(HasSubstr("all but one of the meshes of 1 objects")));
}

/// Three triangles side by side, of two volumes, the second of which has so much of its own.
std::string amfOfVolumes(const std::string& object, const std::string& first,
                         const std::string& second) {
    std::string amf =
        "<?xml version=\"1.0\"?><amf unit=\"meter\"><material "
        "id=\"7\"><color><r>0</r><g>0</g><b>1</b>"
        "</color></material><object id=\"0\">" +
        object + "<mesh><vertices>";
    for (int x = 0; x < 3; ++x)
        for (const char* y :
             {"<x>{0}.0</x><y>0</y>", "<x>{0}.5</x><y>0</y>", "<x>{0}.0</x><y>1</y>"})
            amf += fmt::format("<vertex><coordinates>{}<z>0</z></coordinates></vertex>",
                               fmt::format(fmt::runtime(y), x));
    return amf + "</vertices><volume>" + first +
           "<triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume> <volume/>\n<volume " +
           second +
           "<triangle><v1>3</v1><v2>4</v2><v3>5</v3></triangle><triangle><color><r>1</r><g>1</g>"
           "<b>0</b></color><v1>6</v1><v2>7</v2><v3>8</v3></triangle></volume></mesh></object></"
           "amf>";
}

TEST(AssimpReader, HasAllVolumesOfAnAmfMeshInTheirColours) {
    const test::TemporaryFolder folder;
    const std::string red = "<color><r>1</r><g>0</g><b>0</b></color>";
    const std::string green =
        "<metadata type=\"name\">b</metadata><color><r>0</r><g>1</g><b>0</b></color>";
    const auto coloursOf = [&](const std::string& amf) {
        test::writeFile(folder.file("m.amf"), amf);
        const auto mesh = readWithAssimp(folder.file("m.amf"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        std::vector<std::pair<double, fabric::Rgba>> colours;  // of the first corners, by their x
        for (const auto& [a, b, c] : mesh->triangles)
            colours.emplace_back(
                std::min({mesh->positions[a].x, mesh->positions[b].x, mesh->positions[c].x}),
                mesh->colours.at(a));
        std::ranges::sort(colours, {}, &std::pair<double, fabric::Rgba>::first);
        EXPECT_THAT(mesh->notes, IsEmpty());
        return colours;
    };
    const fabric::Rgba isRed{255, 0, 0, 255}, isGreen{0, 255, 0, 255}, isBlue{0, 0, 255, 255};
    const std::pair last{2.0, fabric::Rgba{255, 255, 0, 255}};
    EXPECT_THAT(coloursOf(amfOfVolumes("", red, ">" + green)),
                ElementsAre(std::pair(0.0, isRed), std::pair(1.0, isGreen), last));
    EXPECT_THAT(coloursOf(amfOfVolumes("", red, "materialid=\"7\">")),
                ElementsAre(std::pair(0.0, isRed), std::pair(1.0, isBlue), last));
    EXPECT_THAT(coloursOf(amfOfVolumes(red, green, ">")),
                ElementsAre(std::pair(0.0, isGreen), std::pair(1.0, isRed), last));
    EXPECT_THAT(
        coloursOf(amfOfVolumes("", red, ">")),
        ElementsAre(std::pair(0.0, isRed), std::pair(1.0, fabric::Rgba{255, 255, 255, 255}), last));
}

TEST(AmfForAssimp, PutsNoColourBehindATriangleOfNothing) {
    const auto joined = amfForAssimp(
        "<amf><object><mesh><volume><triangle></triangle></volume><volume><color><r>1</r></color>"
        "<triangle/><triangle></triangle></volume></mesh></object></amf>");
    EXPECT_EQ(joined,
              "<amf><object><mesh><volume><triangle></triangle>"
              "<triangle/><triangle><color><r>1</r></color></triangle></volume></mesh></object>"
              "</amf>");
}

}  // namespace
}  // namespace eyrie::import
