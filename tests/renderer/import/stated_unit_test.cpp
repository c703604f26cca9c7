// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/stated_unit.h"

#include <string>
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

/// A triangle with sides of 10 along x and y.
std::string amfOf(const std::string& attributes) {
    std::string amf =
        fmt::format("<?xml version=\"1.0\"?><amf{}><object id=\"0\"><mesh><vertices>", attributes);
    for (const char* vertex : {"<x>0</x><y>0</y>", "<x>10</x><y>0</y>", "<x>0</x><y>10</y>"})
        amf += fmt::format("<vertex><coordinates>{}<z>0</z></coordinates></vertex>", vertex);
    return amf +
           "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh>"
           "</object></amf>";
}

/// One with sides of 10 along x and up.
std::string x3dOf(const std::string& head) {
    return fmt::format(
        "<?xml version=\"1.0\"?><X3D><head>{}</head><Scene><Shape><IndexedFaceSet "
        "coordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 10 0 0 0 10 0\"/></IndexedFaceSet>"
        "</Shape></Scene></X3D>",
        head);
}

struct Read {
    double width = 0;  ///< metres along x
    std::vector<std::string> notes;
};

Read read(const std::string& name, const std::string& text) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file(name), text);
    const auto mesh = readWithAssimp(folder.file(name));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    if (!mesh.ok())
        return {};
    fabric::Box bounds;
    for (const fabric::Vec3& position : mesh->positions) bounds.grow(position);
    return {bounds.size().x, mesh->notes};
}

TEST(StatedUnit, BringsAmfToMetres) {
    for (const auto& [unit, metres] :
         {std::pair("millimeter", 0.01), {"inch", 0.254}, {"feet", 3.048}, {"micron", 1e-5}}) {
        const Read found = read("m.amf", amfOf(fmt::format(" version='1.1' unit='{}'", unit)));
        EXPECT_NEAR(found.width, metres, 1e-6 * metres) << unit;
        EXPECT_THAT(found.notes, ElementsAre(HasSubstr("brought to metres"))) << unit;
    }
    const Read unnamed = read("m.amf", amfOf(""));
    EXPECT_NEAR(unnamed.width, 0.01, 1e-8) << "millimetres, as ISO/ASTM 52915 has it";
    EXPECT_THAT(unnamed.notes, ElementsAre(HasSubstr("brought to metres")));
    const Read plain = read("m.amf", amfOf(" unit=\"meter\""));
    EXPECT_DOUBLE_EQ(plain.width, 10);
    EXPECT_THAT(plain.notes, IsEmpty());
}

TEST(StatedUnit, BringsX3dToMetres) {
    const std::string angle = "<unit category='angle' name='degree' conversionFactor='0.017'/>";
    const Read feet = read(
        "m.x3d", x3dOf(angle + "<unit category='length' name='ft' conversionFactor='0.3048'/>"));
    EXPECT_NEAR(feet.width, 3.048, 1e-6);
    EXPECT_THAT(feet.notes, ElementsAre(HasSubstr("brought to metres")));
    const Read plain = read("m.x3d", x3dOf(angle));
    EXPECT_DOUBLE_EQ(plain.width, 10);
    EXPECT_THAT(plain.notes, IsEmpty());
}

TEST(StatedUnit, ThatIsNoneIsToldAndTakenForMetres) {
    const std::string unit = "<unit category='length' name='x' conversionFactor='{}'/>";
    for (const char* factor : {"-1", "0", "nan", "inf", "one"}) {
        const Read x3d = read("m.x3d", x3dOf(fmt::format(fmt::runtime(unit), factor)));
        EXPECT_DOUBLE_EQ(x3d.width, 10) << factor;
        EXPECT_THAT(x3d.notes, ElementsAre(HasSubstr("taken to be in metres"))) << factor;
    }
}

}  // namespace
}  // namespace eyrie::import
