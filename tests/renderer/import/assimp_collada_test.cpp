// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "renderer/import/collada_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

/// A triangle at 0, 0, 0 and 1, 0, 0 and 0, 1, 0 in a node with such transforms.
std::string colladaOf(const std::string& transforms) {
    return fmt::format(
        R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">{}<instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)",
        transforms);
}

/// Where the corner at 0, 1, 0 comes to, its x and y rounded to 1e-6.
fabric::Vec3 upperCorner(const std::string& transforms) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.dae"), colladaOf(transforms));
    const auto mesh = readWithAssimp(folder.file("m.dae"));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    if (!mesh.ok())
        return {};
    EXPECT_EQ(mesh->triangles.size(), 1U);
    for (const fabric::Vec3& position : mesh->positions)
        if (position.y > 0.5)
            return {std::round(position.x * 1e6) / 1e6, std::round(position.y * 1e6) / 1e6,
                    position.z};
    return {};
}

TEST(AssimpReader, SkewsNodesOfCollada) {
    EXPECT_EQ(upperCorner(""), fabric::Vec3(0, 1, 0));
    EXPECT_EQ(upperCorner("<skew sid=\"shear\">45 0 1 0 1 0 0</skew>"), fabric::Vec3(1, 1, 0));
    EXPECT_EQ(upperCorner("<skew>\n-45\t0 2 0 3 0 0\n</skew>"), fabric::Vec3(-1, 1, 0));
    EXPECT_EQ(upperCorner("<translate>5 0 0</translate><skew>45 0 1 0 1 0 0</skew>"),
              fabric::Vec3(6, 1, 0));
    const std::string tooFar = "<skew>45 1 1 0 1 0 0</skew>";
    EXPECT_EQ(colladaForAssimp(tooFar), tooFar) << "which leads to the second axis";
}

TEST(ColladaForAssimp, MendsTheOuterOfSkewsWithinEachOther) {
    const std::string skew = "<skew>45 0 1 0 1 0 0 ";
    const std::string mended = colladaForAssimp(skew + skew + "</skew> and what follows");
    EXPECT_TRUE(mended.starts_with("<matrix>")) << mended;
    EXPECT_TRUE(mended.ends_with("</matrix> and what follows")) << mended;
    EXPECT_EQ(mended.find("<skew>"), mended.npos) << mended;
}

TEST(AssimpReader, SkewsNodesOfColladaFromAxesThatAreNotAtRightAngles) {
    // From 45 degrees before y, along x, to 45 degrees behind it.
    EXPECT_EQ(upperCorner("<skew>90 -1 1 0 1 0 0</skew>"), fabric::Vec3(2, 1, 0));
}

}  // namespace
}  // namespace eyrie::import
