// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_writer.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/mesh/output_file.h"

namespace eyrie::import {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
static_assert(std::endian::native == std::endian::little, "values are written as they are");

/// Collects values into large writes.
class BufferedOutput {
public:
    explicit BufferedOutput(mesh::OutputFile& out) : out_(out) {}

    template <typename T>
    void append(const T& value) {
        const auto bytes = std::as_bytes(std::span(&value, 1));
        buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
    absl::Status flushIfFull() {
        return buffer_.size() < kBufferBytes ? absl::OkStatus() : flush();
    }
    absl::Status flush() {
        RETURN_IF_ERROR(out_.write(buffer_));
        buffer_.clear();
        return absl::OkStatus();
    }

private:
    mesh::OutputFile& out_;
    std::vector<std::byte> buffer_;
};

bool fitsFloat(const TriangleMesh& mesh) {
    return std::all_of(mesh.positions.begin(), mesh.positions.end(),
                       [](const fabric::Vec3& p) { return fabric::Vec3(glm::vec3(p)) == p; });
}

std::string header(const TriangleMesh& mesh, bool asFloat) {
    const char* type = asFloat ? "float" : "double";
    std::string text = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment written by Eyrie\n"
        "element vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n",
        mesh.positions.size(), type, type, type);
    if (!mesh.normals.empty())
        text += "property float nx\nproperty float ny\nproperty float nz\n";
    if (!mesh.colours.empty())
        text +=
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar alpha\n";
    return text + fmt::format(
                      "element face {}\nproperty list uchar uint vertex_indices\n"
                      "end_header\n",
                      mesh.triangles.size());
}

}  // namespace

absl::Status writePly(const TriangleMesh& mesh, const std::string& path,
                      const std::stop_token& stop) {
    ASSIGN_OR_RETURN(mesh::OutputFile out, mesh::OutputFile::create(path, stop));
    const bool asFloat = fitsFloat(mesh);
    const std::string text = header(mesh, asFloat);
    RETURN_IF_ERROR(out.write(std::as_bytes(std::span(text))));
    BufferedOutput buffer(out);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (asFloat)
            buffer.append(glm::vec3(mesh.positions[i]));
        else
            buffer.append(mesh.positions[i]);
        if (!mesh.normals.empty())
            buffer.append(mesh.normals[i]);
        if (!mesh.colours.empty())
            buffer.append(mesh.colours[i]);
        RETURN_IF_ERROR(buffer.flushIfFull());
    }
    for (const auto& triangle : mesh.triangles) {
        buffer.append(std::uint8_t{3});
        buffer.append(triangle);
        RETURN_IF_ERROR(buffer.flushIfFull());
    }
    RETURN_IF_ERROR(buffer.flush());
    return out.commit();
}

}  // namespace eyrie::import
