// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::test {

/// One triangle each, whose material files are called m.mtl.
inline constexpr const char* kObj =
    "mtllib m.mtl\nv 5 0 0\nv 6 0 0\nv 5 1 0\nusemtl red\nf 1 2 3\n";
inline constexpr const char* kMtl = "newmtl red\nKd 1 0 0\n";
inline constexpr const char* kJdn =
    "Number of Materials = 0\nNumber of Objects = 1\nMaterial ID = 0\nNum Vertices = 3\n"
    "Num Faces = 1\nVert = 0 0 0\nVert = 1 0 0\nVert = 0 1 0\nFace = 0 1 2\n";
/// Four triangles, of materials whose images are there or not, and of one without.
inline constexpr const char* kTexturedObj =
    "mtllib m.mtl\nv 5 0 0\nv 6 0 0\nv 5 1 0\nvt 0.25 0\nvt 1 0\nvt 0 1\n"
    "usemtl tiles\nf 1/1 2/2 3/3\nusemtl lost\nf 1/1 3/3 2/2\nusemtl pane\nf 1 2 3\n"
    "usemtl broken\nf 1/1 2/2 3/3\n";
inline constexpr const char* kTexturedMtl =
    "newmtl tiles\nKd 0 0 0\nmap_Kd textures\\Tiles.tga\nnewmtl lost\nKd 1 0 0\nmap_Kd lost.png\n"
    "newmtl pane\nKd 0 0 1\nd 0.4\nnewmtl broken\nKd 0 1 0\nmap_Kd broken.png\n";
/// Two triangles of two materials, the first of which has an image m_A.png, the second one that is
/// not there.
inline constexpr const char* kTexturedPly =
    "ply\nformat ascii 1.0\ncomment TextureFile <this>_A.png\ncomment TextureFile lost.png\n"
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nelement face 2\n"
    "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
    "property int texnumber\nend_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n"
    "1 1 0 255 0 0\n3 0 1 2 6 0 0 1 0 0 1 0\n3 2 1 3 6 0 1 1 0 1 1 1\n";

}  // namespace eyrie::test
