// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_paging.h"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "fabric/status.h"

namespace eyrie::draw {
namespace {

template <typename T>
GLintptr append(std::vector<std::byte>& bytes, std::span<const T> values) {
    const auto offset = static_cast<GLintptr>(bytes.size());
    const auto source = std::as_bytes(values);
    bytes.insert(bytes.end(), source.begin(), source.end());
    return offset;
}

DeviceNode upload(const mesh::NodeGeometry& geometry, std::uint64_t& bytesUsed) {
    DeviceNode node;
    std::vector<std::byte> bytes;
    bytes.reserve(geometry.positions.size_bytes() + geometry.normals.size_bytes() +
                  geometry.colours.size_bytes() + geometry.indices.size_bytes());
    append(bytes, geometry.positions);
    node.normalOffset = append(bytes, geometry.normals);
    node.colourOffset = append(bytes, geometry.colours);
    node.indexOffset = append(bytes, geometry.indices);
    node.indexCount = static_cast<GLsizei>(geometry.indices.size());
    glNamedBufferStorage(node.buffer.id(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
    bytesUsed = bytes.size();
    return node;
}

}  // namespace

absl::StatusOr<const DeviceNode*> MeshPaging::node(std::uint32_t index,
                                                   fabric::FrameStatistics& statistics) {
    if (const DeviceNode* node = resident_.find(index); node != nullptr)
        return node;
    ASSIGN_OR_RETURN(const mesh::NodeGeometry geometry, file_.geometry(index));
    std::uint64_t bytes = 0;
    DeviceNode node = upload(geometry, bytes);
    ++statistics.pagesLoaded;
    statistics.bytesLoaded += bytes;
    return &resident_.insert(index, std::move(node), bytes);
}

}  // namespace eyrie::draw
