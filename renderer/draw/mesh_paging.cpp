// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_paging.h"

#include <cstddef>

#include "fabric/status.h"

namespace eyrie::draw {
namespace {

DeviceNode upload(const mesh::NodeGeometry& geometry) {
    const auto offsetOf = [&geometry](const auto& array) {
        return static_cast<GLintptr>(reinterpret_cast<const std::byte*>(array.data()) -
                                     geometry.block.data());
    };
    DeviceNode node;
    node.normalOffset = offsetOf(geometry.normals);
    node.colourOffset = offsetOf(geometry.colours);
    node.indexOffset = offsetOf(geometry.indices);
    node.indexCount = static_cast<GLsizei>(geometry.indices.size());
    glNamedBufferStorage(node.buffer.id(), static_cast<GLsizeiptr>(geometry.block.size()),
                         geometry.block.data(), 0);
    return node;
}

}  // namespace

absl::StatusOr<const DeviceNode*> MeshPaging::node(std::uint32_t index,
                                                   fabric::FrameStatistics& statistics) {
    if (const DeviceNode* node = resident_.find(index); node != nullptr)
        return node;
    ASSIGN_OR_RETURN(const mesh::NodeGeometry geometry, file_.geometry(index));
    ++statistics.pagesLoaded;
    statistics.bytesLoaded += file_.nodes()[index].pageBytes;
    return &resident_.insert(index, upload(geometry), geometry.block.size());
}

}  // namespace eyrie::draw
