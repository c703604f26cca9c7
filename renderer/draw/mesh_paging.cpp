// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_paging.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "fabric/log.h"
#include "fabric/status.h"
#include "renderer/draw/least_memory.h"
#include "renderer/page/remote_name.h"

namespace eyrie::draw {
namespace {

/// A page, and what is made of it by whoever reads it.
struct LoadedNode {
    explicit LoadedNode(mesh::NodeGeometry read)
        : geometry(std::move(read)), blocks(mesh::triangleBlocks(geometry)) {}

    mesh::NodeGeometry geometry;
    std::vector<mesh::TriangleBlock> blocks;
};

DeviceNode upload(const LoadedNode& loaded) {
    const mesh::NodeGeometry& geometry = loaded.geometry;
    const auto offsetOf = [&geometry](const auto& array) {
        return static_cast<GLintptr>(reinterpret_cast<const std::byte*>(array.data()) -
                                     geometry.block.data());
    };
    DeviceNode node;
    node.normalOffset = offsetOf(geometry.normals);
    node.colourOffset = offsetOf(geometry.colours);
    node.placeOffset = offsetOf(geometry.textureCoordinates);
    node.indexOffset = offsetOf(geometry.indices);
    node.indexCount = static_cast<GLsizei>(geometry.indices.size());
    node.blocks = loaded.blocks;
    glNamedBufferStorage(node.buffer.id(), static_cast<GLsizeiptr>(geometry.block.size()),
                         geometry.block.data(), 0);
    return node;
}

/// What a node's page takes in memory.
std::uint64_t hostBytes(const mesh::EymFile& file, std::uint32_t node) {
    return mesh::blockBytes(file.shape(node));
}

page::Loader::Load loadFrom(std::shared_ptr<const mesh::EymFile> file) {
    return [file = std::move(file)](std::uint32_t node) -> absl::StatusOr<page::Loaded> {
        ASSIGN_OR_RETURN(mesh::NodeGeometry geometry, file->geometry(node));
        return page::Loaded{std::make_shared<const LoadedNode>(std::move(geometry)),
                            hostBytes(*file, node)};
    };
}

page::PageFacts factsOf(const std::shared_ptr<const mesh::EymFile>& file) {
    return {file->path(), [file](std::uint32_t node) { return hostBytes(*file, node); },
            [file](std::uint32_t node) { return file->nodes()[node].pageBytes; }};
}

std::unique_ptr<DeviceNode> uploadRoot(const mesh::EymFile& file) {
    if (!file.nodes()[0].hasGeometry())
        return nullptr;
    absl::StatusOr<mesh::NodeGeometry> geometry = file.geometry(0);
    if (geometry.ok())
        return std::make_unique<DeviceNode>(upload(LoadedNode(*std::move(geometry))));
    const std::string_view message(geometry.status().message().data(),
                                   geometry.status().message().size());
    spdlog::warn("{}; finer data stand in for it", message);
    return nullptr;
}

}  // namespace

/// On the host as much again is for pages that are being loaded (HostPages).
MemoryUse MeshPaging::greatestUse(const mesh::EymFile& file) {
    MemoryUse use;
    std::uint64_t greatestPage = 0;
    for (std::uint32_t node = 0; node < file.nodes().size(); ++node) {
        use.deviceBytes += mesh::blockBytes(file.shape(node));
        use.hostBytes += 2 * hostBytes(file, node);
        greatestPage = std::max(greatestPage, hostBytes(file, node));
    }
    use.hostBytes += 2 * greatestPage;
    return use;
}

absl::StatusOr<std::unique_ptr<MeshPaging>> MeshPaging::open(
    std::shared_ptr<const mesh::EymFile> file, page::Loader& loader, const MeshMemory& limits) {
    std::uint64_t greatestBlock = 0;
    std::uint64_t greatestPage = 0;
    for (std::uint32_t node = 0; node < file->nodes().size(); ++node) {
        greatestBlock = std::max<std::uint64_t>(greatestBlock, mesh::blockBytes(file->shape(node)));
        greatestPage = std::max(greatestPage, hostBytes(*file, node));
    }
    const std::uint64_t least = limits.textureBytes + mesh::blockBytes(file->shape(0)) +
                                (file->nodes().size() > 1 ? greatestBlock : 0);
    RETURN_IF_ERROR(checkHolds({limits.deviceBytes, limits.hostBytes}, {least, 2 * greatestPage},
                               file->path(), limits.textureBytes));
    std::unique_ptr<DeviceNode> root = uploadRoot(*file);
    return std::unique_ptr<MeshPaging>(
        new MeshPaging(std::move(file), loader, limits, std::move(root), greatestPage));
}

MeshPaging::MeshPaging(std::shared_ptr<const mesh::EymFile> file, page::Loader& loader,
                       const MeshMemory& limits, std::unique_ptr<DeviceNode> root,
                       std::uint64_t greatestPage)
    : file_(std::move(file)),
      root_(std::move(root)),
      rootBytes_(root_ ? mesh::blockBytes(file_->shape(0)) : 0),
      items_(limits.deviceBytes - limits.textureBytes - rootBytes_),
      pages_(loader, loadFrom(file_), factsOf(file_), limits.hostBytes, greatestPage) {}

ViewClaim& MeshPaging::beginFrame(const ViewTurn& turn) {
    items_.beginFrame();
    pages_.beginFrame();
    missing_.clear();
    ranked_.clear();
    rankedBytes_ = 0;
    return claims_.begin(turn);
}

void MeshPaging::rankAs(std::uint32_t node, std::uint32_t rank, ViewClaim& claim) {
    items_.rank(node, rank);
    claim.items.emplace_back(node, rank);
}

/// Coarse nodes first, and of a level the worst: gives what is on the device its rank, and lists
/// what is missing as far as it will fit.
void MeshPaging::rank(std::vector<CutNode> nodes, ViewClaim& claim) {
    std::sort(nodes.begin(), nodes.end(), [](const CutNode& a, const CutNode& b) {
        return a.level != b.level               ? a.level < b.level
               : a.errorPixels != b.errorPixels ? a.errorPixels > b.errorPixels
                                                : a.node < b.node;
    });
    for (const CutNode& node : nodes) {
        if ((node.node == 0 && root_) || !ranked_.insert(node.node).second)
            continue;
        rankedBytes_ += bytesOf(node.node);
        if (rankedBytes_ > items_.limitBytes())
            return;
        const auto rank = static_cast<std::uint32_t>(ranked_.size());
        rankAs(node.node, rank, claim);
        if (!items_.contains(node.node)) {
            missing_.push_back({node.node, rank});
            claim.pages.push_back(node.node);
        }
    }
}

bool MeshPaging::upload(std::chrono::duration<double> time) {
    const auto end = page::HostPages::Clock::now() + time;
    bool hasUploaded = false;
    std::erase_if(missing_, [&](const Missing& missing) {
        if (hasUploaded && page::HostPages::Clock::now() >= end)
            return false;
        const auto* page = pages_.find(missing.node);
        const std::uint64_t bytes = bytesOf(missing.node);
        if (page == nullptr || !items_.makeRoom(bytes, missing.rank))
            return false;
        items_.insert(missing.node, draw::upload(*static_cast<const LoadedNode*>(page->get())),
                      bytes, missing.rank);
        hasUploaded = true;
        return true;
    });
    return hasUploaded;
}

MeshPaging::Progress MeshPaging::approach(const MeshCut& cut, const ViewTurn& turn,
                                          const Prefetch& prefetch) {
    ViewClaim& claim = beginFrame(turn);
    for (const CutNode& node : cut.drawn) {
        rankAs(node.node, 0, claim);
        ranked_.insert(node.node);
        rankedBytes_ += bytesOf(node.node);
    }
    std::vector<CutNode> below = cut.wanted;
    below.insert(below.end(), cut.between.begin(), cut.between.end());
    rank(std::move(below), claim);
    const bool isUrgent = !missing_.empty();
    rank(cut.above, claim);
    if (!isUrgent)
        for (const std::uint32_t node : prefetch())
            if (!isResident(node))
                claim.soon.push_back(node);
    claims_.rankOthers(turn, items_, 0);
    const bool hasWishes = claims_.want(pages_);
    if (!hasWishes && !hasWishes_)
        return {};
    Progress progress;
    progress.loaded = pages_.tryTake();
    progress.hasUploaded = upload(kUploadTime);
    std::erase_if(claim.pages, [this](std::uint32_t node) { return items_.contains(node); });
    pages_.tryWish();
    hasWishes_ = hasWishes;
    return progress;
}

bool MeshPaging::reach(const std::vector<CutNode>& needed, const ViewTurn& turn,
                       page::HostPages::Loads& loaded, const std::stop_token& stop) {
    rank(needed, beginFrame(turn));
    if (missing_.empty())
        return false;
    claims_.rankOthers(turn, items_, static_cast<std::uint32_t>(ranked_.size()) + 1);
    for (const Missing& missing : missing_) pages_.want(missing.node);
    const page::HostPages::Loads arrived = pages_.take();
    loaded.add(arrived);
    const bool hasUploaded = upload(std::chrono::hours(1));
    pages_.wish();
    hasWishes_ = true;
    return !missing_.empty() && (hasUploaded || arrived.hasFailed || pages_.wait(stop));
}

}  // namespace eyrie::draw
