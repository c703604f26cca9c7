// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <unordered_set>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/draw/drawable.h"
#include "renderer/draw/mesh_cut.h"
#include "renderer/draw/view_claims.h"
#include "renderer/draw/view_turns.h"
#include "renderer/gl/object.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/triangle_blocks.h"
#include "renderer/page/host_pages.h"
#include "renderer/page/resident_set.h"

namespace eyrie::draw {

/// A node's geometry on the device: one buffer, sections one after another, positions first.
struct DeviceNode {
    gl::Buffer buffer;
    GLintptr normalOffset = 0;
    GLintptr colourOffset = 0;
    GLintptr placeOffset = 0;  ///< of texture coordinates
    GLintptr indexOffset = 0;
    GLsizei indexCount = 0;
    std::vector<mesh::TriangleBlock> blocks;
};

/// Limits in bytes of what one mesh holds; they hold at all times. Of scenes two are held,
/// one within its limits, while the other is opened (RendererOptions::memoryBytes).
struct MeshMemory {
    std::uint64_t deviceBytes = 0;
    std::uint64_t hostBytes = 0;     ///< pages in memory or being loaded
    std::uint64_t textureBytes = 0;  ///< of those on the device, taken by textures
};

/// Which nodes of one mesh are on the device, and the pages on their way there. GL thread.
///
/// What a view needs comes coarse nodes first. Whatever is missing, something that is there is
/// drawn for it: any cut through the tree is without cracks (docs/errors.md). A page that
/// cannot be read is logged once, and tried again by the loader.
class MeshPaging {
public:
    /// Reads the root's page, if it has one, to stay on the device: it stands in for everything.
    /// `loader` outlives this. Errors: ResourceExhausted when the limits hold no page of `file`.
    /// A root that cannot be read is logged; its children are drawn.
    static absl::StatusOr<std::unique_ptr<MeshPaging>> open(
        std::shared_ptr<const mesh::EymFile> file, page::Loader& loader, const MeshMemory& limits);

    /// What the nodes of `file` may take with all of them in memory, at most.
    static MemoryUse greatestUse(const mesh::EymFile& file);

    using Prefetch = std::function<std::vector<std::uint32_t>()>;

    struct Progress {
        page::HostPages::Loads loaded;
        bool hasUploaded = false;
    };

    /// Brings what is there to the device for a few milliseconds and wishes for the rest, without
    /// waiting. What is drawn stays; then comes what lies below it, then, against the day when the
    /// camera draws back, what lies above; where nothing below is missing, pages of `prefetch()`:
    /// nodes that may be needed soon, likely ones first.
    /// Views that take turns spare each other's nodes, and their pages come by turns, too.
    Progress approach(const MeshCut& cut, const ViewTurn& turn, const Prefetch& prefetch);

    /// One round of waiting for `needed`, or until `stop`: false when nothing is left that may
    /// come. Other views' nodes give way where there is no other room.
    bool reach(const std::vector<CutNode>& needed, const ViewTurn& turn,
               page::HostPages::Loads& loaded, const std::stop_token& stop);

    /// Null when it is not on the device. Valid until the next approach() or reach().
    const DeviceNode* node(std::uint32_t index) {
        return index == 0 && root_ ? root_.get() : items_.find(index);
    }
    bool isResident(std::uint32_t index) const {
        return (index == 0 && root_ != nullptr) || items_.contains(index);
    }
    /// Whether it is there, or nothing says that it will not come before `time` and after.
    bool mayCome(std::uint32_t index, page::HostPages::Clock::time_point time) const {
        return isResident(index) || !pages_.isGivenUp(index, time);
    }
    bool isFailing(std::uint32_t index) const { return pages_.isFailing(index); }

    /// What a node takes on the device, beside the root.
    std::uint64_t bytesOf(std::uint32_t index) const {
        return index == 0 && root_ ? 0 : mesh::blockBytes(file_->shape(index));
    }
    std::uint64_t roomBytes() const { return items_.limitBytes(); }
    /// From a page's first wish to its arrival, averaged over the last ones.
    std::chrono::duration<double> latency() const { return pages_.latency(); }
    MemoryUse memory() const { return {rootBytes_ + items_.bytes(), pages_.bytes()}; }

private:
    MeshPaging(std::shared_ptr<const mesh::EymFile> file, page::Loader& loader,
               const MeshMemory& limits, std::unique_ptr<DeviceNode> root,
               std::uint64_t greatestPage);

    ViewClaim& beginFrame(const ViewTurn& turn);
    void rank(std::vector<CutNode> nodes, ViewClaim& claim);
    void rankAs(std::uint32_t node, std::uint32_t rank, ViewClaim& claim);
    bool upload(std::chrono::duration<double> time);

    const std::shared_ptr<const mesh::EymFile> file_;
    std::unique_ptr<DeviceNode> root_;  ///< null: it has no geometry, or none that can be read
    std::uint64_t rootBytes_;
    page::ResidentSet<std::uint32_t, DeviceNode> items_;
    struct Missing {
        std::uint32_t node;
        std::uint32_t rank;
    };
    std::vector<Missing> missing_;  ///< of this frame, in the order in which they are to come
    std::unordered_set<std::uint32_t> ranked_;  ///< of this frame
    std::uint64_t rankedBytes_ = 0;
    ViewClaims claims_;
    bool hasWishes_ = false;  ///< the loader may hold something for this
    page::HostPages pages_;   ///< read nodes; last: its loads use the file
};

}  // namespace eyrie::draw
