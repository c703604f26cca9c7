// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <absl/status/statusor.h>

#include "fabric/statistics.h"
#include "renderer/gl/object.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/page/lru_cache.h"

namespace eyrie::draw {

/// A node's geometry on the device: one buffer, sections one after another, positions first.
struct DeviceNode {
    gl::Buffer buffer;
    GLintptr normalOffset = 0;
    GLintptr colourOffset = 0;
    GLintptr indexOffset = 0;
    GLsizei indexCount = 0;
};

/// Which nodes of one mesh are on the device. GL thread.
class MeshPaging {
public:
    /// `file` outlives this.
    MeshPaging(const mesh::EymFile& file, std::uint64_t memoryBytes)
        : file_(file), resident_(memoryBytes) {}

    /// The node, brought to the device if need be. Stays valid until trim.
    absl::StatusOr<const DeviceNode*> node(std::uint32_t index,
                                           fabric::FrameStatistics& statistics);
    void trim() { resident_.trim(); }
    std::uint64_t bytes() const { return resident_.bytes(); }

private:
    const mesh::EymFile& file_;
    page::LruCache<std::uint32_t, DeviceNode> resident_;
};

}  // namespace eyrie::draw
