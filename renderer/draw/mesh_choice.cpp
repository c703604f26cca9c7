// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_choice.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "renderer/draw/node_work.h"
#include "renderer/draw/range_step.h"

namespace eyrie::draw {
namespace {

/// Of a frame, each of 128 triangles: some 3 ms.
constexpr int kMostBlocksLookedInto = 256;

/// For Prefetch::nodes.
struct NodeTree {
    using Node = std::uint32_t;

    const mesh::EymFile& file;
    double tauPixels;
    bool mayBePoints;

    Node root() const { return 0; }
    fabric::Box bounds(Node node) const { return file.bounds(node); }
    double errorMetres(Node node) const {
        const mesh::Node& at = file.nodes()[node];
        if (at.isOfPoints() && mayBePoints)
            return std::max(at.errorMetres * std::max(tauPixels / kMostPointPixels, 2.0),
                            double{at.farthestMetres()});
        return at.indexCount > 0 ? at.farthestMetres() : std::numeric_limits<double>::infinity();
    }
    template <typename Visit>
    void forEachChild(Node node, const Visit& visit) const {
        const mesh::Node& at = file.nodes()[node];
        if (at.isLeaf())
            return;
        visit(static_cast<Node>(at.left));
        visit(static_cast<Node>(at.right));
    }
};

}  // namespace

MeshChoice::MeshChoice(std::shared_ptr<const mesh::EymFile> file, const fabric::SceneObject& object,
                       std::unique_ptr<MeshPaging> paging)
    : file_(std::move(file)),
      worldFromObject_(object.worldFromObject),
      mayBePoints_(!object.singleSided),
      paging_(std::move(paging)),
      near_(*file_) {}

MeshCut MeshChoice::wantedOf(const lod::ObjectView& view, double tauPixels) const {
    return cutOf(
        *file_, view, tauPixels, [](std::uint32_t) { return true; }, mayBePoints_);
}

const MeshCut& MeshChoice::wantedAt(int step, const CutRequest& request) {
    const auto known = wanted_.find(step);
    if (known != wanted_.end())
        return known->second;
    const double tauPixels = request.tauPixels * page::TauLadder::factor(step);
    return wanted_.emplace(step, wantedOf(request.view, tauPixels)).first->second;
}

/// What of a view falls to the channel, drawn by what is there.
MeshCut MeshChoice::cutNow(int step, const CutRequest& request, const NodeShares& shares) {
    MeshCut cut = wantedAt(step, request);
    shares.keepNeeded(cut);
    if (countMissing(cut) == 0)
        return cut;
    const double tauPixels = request.tauPixels * page::TauLadder::factor(step);
    cut = cutOf(
        *file_, request.view, tauPixels,
        [&](std::uint32_t node) { return paging_->isResident(node) || !shares.isNeeded(node); },
        mayBePoints_);
    shares.keepNeeded(cut);
    return cut;
}

/// With all that may stand in.
std::vector<NeededItem> MeshChoice::itemsOf(const MeshCut& wanted) const {
    std::vector<NeededItem> items;
    for (const auto* nodes : {&wanted.wanted, &wanted.above})
        for (const CutNode& node : *nodes)
            if (const std::uint64_t bytes = paging_->bytesOf(node.node); bytes > 0)
                items.push_back({node.node, bytes});
    return items;
}

/// What a channel brings to the device at a step, with all that may stand in: of complete frames,
/// too, or they would leave finer nodes there that leave others no room for theirs.
std::uint64_t MeshChoice::bytesOf(int step, const CutRequest& request, const NodeShares& shares) {
    MeshCut needed = wantedAt(step, request);
    shares.keepNeeded(needed);
    std::uint64_t sum = 0;
    for (const NeededItem& item : itemsOf(needed)) sum += item.bytes;
    return sum;
}

std::uint64_t MeshChoice::countMissing(const MeshCut& cut) const {
    return static_cast<std::uint64_t>(std::ranges::count_if(
        cut.wanted, [this](const CutNode& node) { return !paging_->isResident(node.node); }));
}

/// Waits for every page that can be read; what stands in for one that cannot is waited for, too.
page::HostPages::Loads MeshChoice::reach(const CutRequest& request, double tauPixels,
                                         const NodeShares& shares) {
    const auto start = page::HostPages::Clock::now();
    const auto readable = [&] {
        MeshCut cut = cutOf(
            *file_, request.view, tauPixels,
            [&](std::uint32_t node) {
                return paging_->mayCome(node, start) || !shares.isNeeded(node);
            },
            mayBePoints_);
        shares.keepNeeded(cut);
        return std::move(cut.drawn);
    };
    page::HostPages::Loads loaded;
    page::HostPages::Loads round;
    std::vector<CutNode> needed = readable();
    while (paging_->reach(needed, request.turn, round, request.stop) &&
           !request.stop.stop_requested()) {
        loaded.add(round);
        if (round.hasFailed)
            needed = readable();
        round = {};
    }
    loaded.add(round);
    return loaded;
}

/// A point counts as a triangle.
std::uint64_t MeshChoice::viewTriangles(const CutRequest& request) const {
    std::uint64_t triangles = 0;
    for (const CutNode& node : wantedOf(request.view, request.tauPixels).wanted)
        triangles += node.points > 0 ? node.points : file_->nodes()[node.node].indexCount / 3;
    return triangles;
}

/// Waits for what a complete cut needs.
MeshPaging::Progress MeshChoice::load(const CutRequest& request, double tauPixels,
                                      const NodeShares& shares, const MeshCut& drawn) {
    Prefetch& prefetch = prefetch_.of(request.turn);
    prefetch.follow(request.view.view(), worldFromObject_, Prefetch::Clock::now());
    if (request.completeness == fabric::Completeness::Complete) {
        const bool isMissing = countMissing(drawn) > 0;
        return {reach(request, tauPixels, shares), isMissing};
    }
    return paging_->approach(drawn, request.turn, [&] {
        return prefetch.nodes(NodeTree{*file_, tauPixels, mayBePoints_}, tauPixels,
                              paging_->latency());
    });
}

std::vector<Piece> MeshChoice::piecesOf(const MeshCut& drawn, const NodeShares& shares) const {
    std::vector<Piece> pieces;
    for (const CutNode& one : drawn.drawn) {
        const NodePart part = shares.partOf(one);
        if (one.points == 0 && part.triangles == 0)
            continue;  // its triangles are too few for all ranges that meet in it
        pieces.push_back({one.node, part.rangePosition, file_->bounds(one.node), true,
                          one.points > 0 ? one.points : part.triangles, hasBlended(one.node),
                          one.points, one.pointPixels, part.firstTriangle});
    }
    return pieces;
}

/// Of nodes by their boxes; of the worst by what is in these, where boxes do not say enough: they
/// do not keep tau, as none can that the eye is in, or are so near that what single precision makes
/// of corners would show.
double MeshChoice::errorOf(const MeshCut& drawn, const CutRequest& request) {
    struct Rough {
        double pixels;
        std::uint32_t node;
    };
    std::vector<Rough> rough;
    double worst = drawn.isWhole ? 0 : std::numeric_limits<double>::infinity();
    for (const CutNode& each : drawn.drawn) {
        const fabric::Box box = file_->bounds(each.node);
        const double rounding = each.points > 0 ? 0 : request.view.roundingPixels(box, box);
        if (each.points > 0 || (each.errorPixels <= request.tauPixels && rounding == 0))
            worst = std::max(worst, each.errorPixels);
        else
            rough.push_back({each.errorPixels + rounding, each.node});
    }
    std::ranges::stable_sort(rough, std::ranges::greater(), &Rough::pixels);
    int mayLookInto = kMostBlocksLookedInto;
    for (std::size_t i = 0; i < rough.size() && rough[i].pixels > worst; ++i) {
        const auto& [pixels, index] = rough[i];
        const DeviceNode* const node = paging_->node(index);
        if (node == nullptr || i == NearTriangles::kMostNodes)
            return pixels;
        worst = std::min(pixels, errorOfBlocksPixels(node->blocks, file_->lattice(), request.view,
                                                     {file_->nodes()[index].farthestMetres(),
                                                      request.tauPixels, worst},
                                                     near_.of(index, *node), mayLookInto));
    }
    return worst;
}

double MeshChoice::viewWork(const CutRequest& request) {
    const std::vector<double> work = workOf(*file_, request.view, wantedAt(0, request).wanted);
    return std::accumulate(work.begin(), work.end(), 0.0);
}

Cut MeshChoice::select(const CutRequest& request) {
    const page::TauLadder::Choice choice = tau_.choose(
        request,
        [&](const lod::ObjectView& view, double tauPixels, int step) {
            return itemsOf(&view == &request.view ? wantedAt(step, request)
                                                  : wantedOf(view, tauPixels));
        },
        paging_->roomBytes());
    const std::vector<CutNode>& asked = wantedAt(0, request).wanted;
    // How much of the whole a node is decides nothing where all is drawn.
    const std::vector<double> work = request.range.isWhole() ? std::vector<double>(asked.size(), 1)
                                                             : workOf(*file_, request.view, asked);
    const auto sharesOf = [&](const fabric::Range& range) {
        CutRequest part = request;
        part.range = range;
        return NodeShares(*file_, asked, work, part,
                          [this](std::uint32_t node) { return hasBlended(node); });
    };
    const int step = stepOfRange(
        request.range, choice.step, paging_->roomBytes(),
        [&](const fabric::Range& range, int at) { return bytesOf(at, request, sharesOf(range)); });
    const double tauPixels = request.tauPixels * page::TauLadder::factor(step);
    const NodeShares shares = sharesOf(request.range);
    MeshCut drawn = cutNow(step, request, shares);
    const MeshPaging::Progress progress = load(request, tauPixels, shares, drawn);
    if (progress.hasUploaded)
        drawn = cutNow(step, request, shares);

    Cut cut;
    cut.pagesLoaded = progress.loaded.pages;
    cut.bytesLoaded = progress.loaded.bytes;
    cut.pagesMissing = countMissing(drawn);
    if (cut.pagesMissing > 0)
        cut.pagesFailed = static_cast<std::uint64_t>(
            std::ranges::count_if(drawn.wanted, [this](const CutNode& node) {
                return !paging_->isResident(node.node) && paging_->isFailing(node.node);
            }));
    cut.isComplete = cut.pagesMissing == 0 && choice.isLowest;
    cut.memoryRaisedTau = step > 0;
    cut.pieces = piecesOf(drawn, shares);
    errorPixels_ = errorOf(drawn, request);
    wanted_.clear();
    return cut;
}

bool MeshChoice::hasBlended(std::uint32_t node) const {
    return std::ranges::any_of(file_->ranges(node), [this](const mesh::MaterialRange& range) {
        return file_->materials()[range.material].isBlended();
    });
}

}  // namespace eyrie::draw
