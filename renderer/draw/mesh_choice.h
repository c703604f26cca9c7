// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "fabric/scene.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/mesh_cut.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/draw/near_triangles.h"
#include "renderer/draw/node_shares.h"
#include "renderer/draw/prefetch.h"
#include "renderer/draw/tau_choice.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::draw {

/// Chooses which nodes of a mesh stand for it in a channel, and brings them to the device. GL
/// thread.
class MeshChoice {
public:
    MeshChoice(std::shared_ptr<const mesh::EymFile> file, const fabric::SceneObject& object,
               std::unique_ptr<MeshPaging> paging);

    /// Drawable's.
    std::uint64_t viewTriangles(const CutRequest& request) const;
    double viewWork(const CutRequest& request);
    Cut select(const CutRequest& request);
    double errorPixels() const { return errorPixels_; }
    MemoryUse memory() const { return paging_->memory(); }

    /// Of a piece of the last cut. Valid until the next.
    const DeviceNode* node(std::uint32_t index) { return paging_->node(index); }

private:
    MeshCut wantedOf(const lod::ObjectView& view, double tauPixels) const;
    const MeshCut& wantedAt(int step, const CutRequest& request);
    MeshCut cutNow(int step, const CutRequest& request, const NodeShares& shares);
    std::vector<NeededItem> itemsOf(const MeshCut& wanted) const;
    std::uint64_t bytesOf(int step, const CutRequest& request, const NodeShares& shares);
    std::uint64_t countMissing(const MeshCut& cut) const;
    page::HostPages::Loads reach(const CutRequest& request, double tauPixels,
                                 const NodeShares& shares);
    MeshPaging::Progress load(const CutRequest& request, double tauPixels, const NodeShares& shares,
                              const MeshCut& drawn);
    std::vector<Piece> piecesOf(const MeshCut& drawn, const NodeShares& shares) const;
    double errorOf(const MeshCut& drawn, const CutRequest& request);
    bool hasBlended(std::uint32_t node) const;

    const std::shared_ptr<const mesh::EymFile> file_;
    const fabric::Mat4 worldFromObject_;
    /// Points are lit as their triangles, but do not know which way these face.
    const bool mayBePoints_;
    const std::unique_ptr<MeshPaging> paging_;
    NearTriangles near_;
    PerView<Prefetch> prefetch_;
    TauChoice tau_;
    /// By the view that is about to be drawn, whatever is there, by step.
    std::map<int, MeshCut> wanted_;
    double errorPixels_ = 0;  ///< of the last cut
};

}  // namespace eyrie::draw
