// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string>

#include "renderer/import/triangle_mesh.h"

namespace eyrie::test {

enum class Encoding { Ascii, LittleEndian, BigEndian };

/// Builds the body of a PLY file value by value, in any encoding.
class PlyBody {
public:
    explicit PlyBody(Encoding encoding) : encoding_(encoding) {}

    template <typename T>
    PlyBody& add(T value) {
        if (encoding_ == Encoding::Ascii) {
            std::array<char, 64> text;
            std::snprintf(text.data(), text.size(), "%.17g ", static_cast<double>(value));
            bytes_ += text.data();
            return *this;
        }
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), &value, sizeof(T));
        if (encoding_ == Encoding::BigEndian)
            std::reverse(raw.begin(), raw.end());
        bytes_.append(raw.data(), raw.size());
        return *this;
    }
    PlyBody& endLine() {
        if (encoding_ == Encoding::Ascii)
            bytes_ += '\n';
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

private:
    Encoding encoding_;
    std::string bytes_;
};

inline std::string formatLine(Encoding encoding) {
    switch (encoding) {
        case Encoding::Ascii:
            return "ply\nformat ascii 1.0\n";
        case Encoding::LittleEndian:
            return "ply\nformat binary_little_endian 1.0\n";
        default:
            return "ply\nformat binary_big_endian 1.0\n";
    }
}

/// `mesh` as PLY with double coordinates; normals and colours where it has them.
inline std::string plyOf(const import::TriangleMesh& mesh, Encoding encoding) {
    std::string header = formatLine(encoding) + "element vertex " +
                         std::to_string(mesh.positions.size()) +
                         "\nproperty double x\nproperty double y\nproperty double z\n";
    if (!mesh.normals.empty())
        header += "property float nx\nproperty float ny\nproperty float nz\n";
    if (!mesh.colours.empty())
        header +=
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar alpha\n";
    header += "element face " + std::to_string(mesh.triangles.size()) +
              "\nproperty list uchar int vertex_indices\nend_header\n";
    PlyBody body(encoding);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) body.add(mesh.positions[i][axis]);
        if (!mesh.normals.empty())
            body.add(mesh.normals[i].x).add(mesh.normals[i].y).add(mesh.normals[i].z);
        if (!mesh.colours.empty())
            body.add(mesh.colours[i].r)
                .add(mesh.colours[i].g)
                .add(mesh.colours[i].b)
                .add(mesh.colours[i].a);
        body.endLine();
    }
    for (const auto& [a, b, c] : mesh.triangles)
        body.add(std::uint8_t{3})
            .add(static_cast<std::int32_t>(a))
            .add(static_cast<std::int32_t>(b))
            .add(static_cast<std::int32_t>(c))
            .endLine();
    return header + body.bytes();
}

/// A tetrahedron with its corner at the origin and edges of one metre.
inline import::TriangleMesh tetrahedron() {
    import::TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

}  // namespace eyrie::test
