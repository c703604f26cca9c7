// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/part_set.h"

#include <charconv>
#include <filesystem>
#include <mutex>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "fabric/name_beside.h"
#include "fabric/partial_file.h"
#include "fabric/status.h"
#include "renderer/import/file_hash.h"
#include "renderer/import/terrain_choices.h"
#include "renderer/terrain/quadtree.h"
#include "renderer/terrain/tile_progress.h"

namespace eyrie::import {
namespace {

/// N of "shard-I-of-N"; 0 for other names.
std::uint32_t shardsOf(std::string_view name) {
    const std::size_t of = name.find("-of-");
    if (!name.starts_with("shard-") || of == std::string_view::npos)
        return 0;
    const std::string_view number = name.substr(of + 4);
    std::uint32_t shards = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), shards);
    return error == std::errc() && end == number.data() + number.size() && shards <= kMaxShards
               ? shards
               : 0;
}

absl::StatusOr<std::uint32_t> splitOf(const std::string& folder) {
    std::set<std::uint32_t> splits;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
        if (const std::uint32_t shards = shardsOf(entry->path().filename().string()); shards > 0)
            splits.insert(shards);
    if (splits.empty())
        return absl::NotFoundError(fmt::format(
            "{}: has no parts to merge; run the import with --shard 0/N to N-1/N first", folder));
    if (splits.size() > 1)
        return absl::InvalidArgumentError(
            fmt::format("{}: has parts of one of {} and one of {} shards; remove the files "
                        "'*-of-N' of the wrong one",
                        folder, *splits.begin(), *splits.rbegin()));
    return *splits.begin();
}

/// The first error of many threads.
class FirstError {
public:
    void add(absl::Status status) {
        const std::lock_guard lock(mutex_);
        if (status_.ok())
            status_ = std::move(status);
    }
    bool ok() const {
        const std::lock_guard lock(mutex_);
        return status_.ok();
    }
    absl::Status take() { return std::move(status_); }

private:
    mutable std::mutex mutex_;  ///< guards status_
    absl::Status status_;
};

absl::Status missing(const std::string& folder, const std::vector<std::uint32_t>& indices,
                     std::uint32_t shards) {
    std::string list;
    for (const std::uint32_t index : indices)
        list += fmt::format("{}{}/{}", list.empty() ? "" : ", ", index, shards);
    return absl::NotFoundError(
        fmt::format("{}: not all parts are there; run the import with --shard {}", folder, list));
}

/// Unless there is something else in it: then what to say of that.
std::vector<std::string> removeFolder(const std::string& folder) {
    if (rmdir(folder.c_str()) == 0)
        return {};
    std::set<std::string> names;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
        names.insert(entry->path().filename().string());
    if (names.empty())
        return {};
    const std::string more = names.size() == 1 ? "" : fmt::format(" and {} more", names.size() - 1);
    return {
        fmt::format("{}: still has {}{}, of another split or of a shard that is at work; "
                    "remove the folder once none is",
                    folder, *names.begin(), more)};
}

}  // namespace

absl::StatusOr<PartSet> PartSet::open(const std::string& out, PartIdentity identity,
                                      std::uint32_t textures) {
    const std::string folder = partsFolder(out);
    ASSIGN_OR_RETURN(const std::uint32_t shards, splitOf(folder));
    identity.shards = shards;
    PartSet set(out, ShardPlan(terrain::Quadtree(static_cast<std::uint32_t>(identity.columns),
                                                 static_cast<std::uint32_t>(identity.rows)),
                               shards, textures));
    std::vector<std::uint32_t> absent;
    for (std::uint32_t index = 0; index < shards; ++index) {
        const Shard shard{index, shards};
        absl::StatusOr<PartFile> part =
            PartFile::open(partPath(out, shard), identity, shard, set.plan_);
        if (absl::IsNotFound(part.status())) {
            absent.push_back(index);
            continue;
        }
        RETURN_IF_ERROR(part.status());
        if (!set.parts_.empty() && part->statistics() != set.parts_.front().statistics())
            return absl::DataLossError(
                fmt::format("{} and {}: do not agree on the range of all heights; remove both and "
                            "run their shards again",
                            set.parts_.front().path(), part->path()));
        set.parts_.push_back(*std::move(part));
    }
    if (!absent.empty())
        return missing(folder, absent, shards);
    return set;
}

absl::Status PartSet::gatherHeights(const terrain::Scratch& scratch, const ImportControl& control,
                                    terrain::ElevationModel& model) const {
    FirstError error;
    RETURN_IF_ERROR(terrain::forEachTile(
        plan_.tilesX(), plan_.tilesY(), "gathering", scratch, control,
        [&](std::int32_t x, std::int32_t y) {
            if (!error.ok())
                return;
            auto heights = terrain::TiledRaster<float>::newTile();
            if (absl::Status status = parts_[plan_.ownerOfTile(x, y)].readHeights(
                    static_cast<std::uint32_t>(y * plan_.tilesX() + x), heights.get());
                !status.ok())
                return error.add(std::move(status));
            model.relief.add(x, y, heights.get());
            model.heights.write(x, y, std::move(heights));
        }));
    model.statistics = parts_.front().statistics();
    return error.take();
}

absl::Status PartSet::gatherMeasured(const terrain::Scratch& scratch, const ImportControl& control,
                                     terrain::VertexLevels& levels) const {
    FirstError error;
    RETURN_IF_ERROR(terrain::forEachTile(
        plan_.tilesX(), plan_.tilesY(), "collecting", scratch, control,
        [&](std::int32_t x, std::int32_t y) {
            if (!error.ok())
                return;
            auto counts = terrain::TiledRaster<std::uint8_t>::newTile();
            if (absl::Status status = parts_[plan_.ownerOfTile(x, y)].readMeasured(
                    static_cast<std::uint32_t>(y * plan_.tilesX() + x), counts.get());
                !status.ok())
                return error.add(std::move(status));
            levels.setMeasured(x, y, std::move(counts));
        }));
    return error.take();
}

absl::StatusOr<std::vector<std::uint32_t>> PartSet::readPage(std::uint32_t page,
                                                             PageTiles& tiles) const {
    return parts_[plan_.ownerOfPage(page)].readPage(page, tiles);
}

absl::StatusOr<TexturePiece> PartSet::readTexture(std::uint32_t texture,
                                                  std::size_t halfTexels) const {
    return parts_[plan_.ownerOfTexture(texture)].readTexture(texture, halfTexels);
}

std::vector<std::string> PartSet::remove() {
    const auto shards = static_cast<std::uint32_t>(parts_.size());
    parts_.clear();
    for (std::uint32_t index = 0; index < shards; ++index) {
        const std::string part = partPath(out_, {index, shards});
        const std::string facts = factsPath(out_, {index, shards});
        const std::string scratch = scratchPath(part, "");  // of a run that was killed
        for (const std::string& path :
             {part, facts, scratch, fabric::nameBeside(scratch, ".journal")})
            unlink(path.c_str());
        fabric::removeAbandoned(part);
        fabric::removeAbandoned(facts);
    }
    removeNotedHashes(partsFolder(out_));
    return removeFolder(partsFolder(out_));
}

}  // namespace eyrie::import
