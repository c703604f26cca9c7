// SPDX-License-Identifier: Apache-2.0
// Triangles as they are read back from the device, held against those of the pages.
#include "renderer/draw/near_triangles.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/gl/debug_output.h"
#include "renderer/gl/egl_context.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/mesh/vertex_packing.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::draw {
namespace {

constexpr std::uint64_t kNoLimit = std::uint64_t{1} << 40;

using Corners = std::vector<fabric::Vec3>;

/// A ball of more nodes than are kept, all of them on the device.
class NearTrianglesTest : public testing::Test {
protected:
    void SetUp() override {
        gl::setOnGlError(gl::OnGlError::Abort);
        import::MeshImportOptions options;
        options.leafTriangles = 500;
        ASSERT_TRUE(
            import::importMesh(import::synthesizeMesh(20000, 5), folder_.path("ball.eym"), options)
                .ok());
        file_ = std::make_shared<const mesh::EymFile>(
            mesh::EymFile::open(folder_.path("ball.eym")).value());
        paging_ = MeshPaging::open(file_, loader_, {kNoLimit, kNoLimit, 0}).value();

        std::vector<CutNode> all;
        for (std::uint32_t node = 0; node < file_->nodes().size(); ++node)
            if (file_->nodes()[node].indexCount > 0)
                all.push_back({.node = node});
        page::HostPages::Loads loaded;
        while (paging_->reach(all, {}, loaded, {})) {
        }
        for (const CutNode& each : all)
            if (paging_->isResident(each.node))
                nodes_.push_back(each.node);
        ASSERT_EQ(nodes_.size(), all.size());
        ASSERT_GT(nodes_.size(), 2 * NearTriangles::kMostNodes);
    }

    /// Of all the node's blocks, or of the one only.
    Corners readBack(NearTriangles& near, std::uint32_t node,
                     const mesh::TriangleBlock* only = nullptr) {
        const DeviceNode& device = *paging_->node(node);
        const TrianglesOf triangles = near.of(node, device);
        Corners corners;
        for (const mesh::TriangleBlock& block : device.blocks)
            if (only == nullptr || only == &block)
                triangles(block, [&](std::span<const fabric::Vec3, 3> one) {
                    corners.insert(corners.end(), one.begin(), one.end());
                });
        return corners;
    }

    /// Corners of a node's page from index `first` on, up to `end`.
    Corners ofPage(std::uint32_t node, std::size_t first = 0,
                   std::size_t end = std::numeric_limits<std::size_t>::max()) const {
        const mesh::NodeGeometry geometry = file_->geometry(node).value();
        Corners corners;
        for (std::size_t i = first; i < std::min(end, geometry.indices.size()); ++i)
            corners.push_back(file_->lattice().metres(
                mesh::unpackPosition(geometry.positions[geometry.indices[i]])));
        return corners;
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<gl::EglContext> context_ = gl::EglContext::create(-1).value();
    page::Loader loader_;
    std::shared_ptr<const mesh::EymFile> file_;
    std::unique_ptr<MeshPaging> paging_;
    std::vector<std::uint32_t> nodes_;  ///< on the device
};

/// Twice in turn, so that each has been dropped for others when it comes again; and the last ones
/// the other way round, out of what is kept.
TEST_F(NearTrianglesTest, AreThoseOfThePages) {
    NearTriangles near(*file_);
    std::vector<std::uint32_t> order = nodes_;
    order.insert(order.end(), nodes_.begin(), nodes_.end());
    order.insert(order.end(), nodes_.rbegin(), nodes_.rend());
    for (const std::uint32_t node : order)
        ASSERT_EQ(readBack(near, node), ofPage(node)) << "node " << node;
}

TEST_F(NearTrianglesTest, OfABlockAreThatBlocksOnly) {
    NearTriangles near(*file_);
    std::size_t blocks = 0;
    for (const std::uint32_t node : nodes_)
        for (const mesh::TriangleBlock& block : paging_->node(node)->blocks) {
            ASSERT_EQ(readBack(near, node, &block),
                      ofPage(node, block.first, block.first + block.count));
            ++blocks;
        }
    EXPECT_GT(blocks, nodes_.size());
}

}  // namespace
}  // namespace eyrie::draw
