// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include <glm/geometric.hpp>

#include "renderer/import/triangle_mesh.h"

namespace eyrie::test {

/// What a shell command prints.
inline std::string outputOf(const std::string& command) {
    const auto close = [](FILE* pipe) { return pipe != nullptr ? ::pclose(pipe) : 0; };
    const std::unique_ptr<FILE, decltype(close)> pipe(::popen(command.c_str(), "r"), close);
    std::string content;
    std::array<char, 65536> buffer;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe.get()))
        content.append(buffer.data(), count);
    return content;
}

/// The bytes of a file, those of .zst and .gz unpacked by the system's own tools.
inline std::string contentOf(const std::string& path) {
    const std::string tool = path.ends_with(".zst")  ? "zstd -qdc "
                             : path.ends_with(".gz") ? "gunzip -c "
                                                     : "cat ";
    return outputOf(tool + "'" + path + "'");
}

/// Positive where a closed surface's triangles are counter-clockwise seen from outside.
inline double signedVolume(const import::TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += glm::dot(mesh.positions[a], glm::cross(mesh.positions[b], mesh.positions[c]));
    return sum / 6;
}

inline double area(const import::TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += glm::length(glm::cross(mesh.positions[b] - mesh.positions[a],
                                      mesh.positions[c] - mesh.positions[a]));
    return sum / 2;
}

}  // namespace eyrie::test
