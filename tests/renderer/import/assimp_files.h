// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "tests/renderer/mesh/temporary_folder.h"

/// Files that several tests of readWithAssimp() read.
namespace eyrie::test {

/// An AC3D file: a red square and a grey triangle at places of their own.
inline constexpr const char* kAc3d = R"(AC3Db
MATERIAL "red" rgb 1 0 0 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0
MATERIAL "half" rgb 0.5 0.5 0.5 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0
OBJECT world
kids 2
OBJECT poly
loc 1 2 3
numvert 4
0 0 0
1 0 0
1 0 1
0 0 1
numsurf 1
SURF 0x10
mat 0
refs 4
0 0 0
1 0 0
2 0 0
3 0 0
kids 0
OBJECT poly
loc 10 0 0
numvert 3
0 0 0
1 0 0
0 1 0
numsurf 1
SURF 0x10
mat 1
refs 3
0 0 0
1 0 0
2 0 0
kids 0
)";

/// Two nodes that show one triangle, the second mirrored and moved; linear red 0.2159 is shown as
/// 128.
inline constexpr const char* kGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"translation":[1e6,0,0],"children":[1,2]},{"mesh":0},
{"mesh":0,"scale":[-1,1,1],"translation":[0.25,0,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.21586,1,0,1]}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

/// What reading that text says.
inline std::vector<std::string> notesOfFile(const std::string& path, const std::string& text) {
    writeFile(path, text);
    const auto mesh = import::readWithAssimp(path);
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh.ok() ? mesh->notes : std::vector<std::string>();
}

}  // namespace eyrie::test
