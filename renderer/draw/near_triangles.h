// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <vector>

#include "renderer/draw/block_error.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::draw {

/// Triangles of the nodes of a mesh that the eye is in, or before: what the device has of them,
/// read back once and kept for the last few nodes. GL thread.
class NearTriangles {
public:
    /// At most so many are kept, of some 0.3 MB each, 0.9 at most.
    static constexpr std::size_t kMostNodes = 16;

    explicit NearTriangles(const mesh::EymFile& file) : file_(file) {}

    /// Of `node`, which is on the device as `drawn`. Both outlive what is returned.
    TrianglesOf of(std::uint32_t node, const DeviceNode& drawn);

private:
    struct Kept {
        std::uint32_t node;
        std::vector<std::uint64_t> positions;  ///< packed
        std::vector<std::uint16_t> indices;
    };
    const Kept& read(std::uint32_t node, const DeviceNode& drawn);

    const mesh::EymFile& file_;
    std::list<Kept> kept_;  ///< the last one used first
};

}  // namespace eyrie::draw
