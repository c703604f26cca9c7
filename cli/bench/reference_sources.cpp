// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/reference_sources.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cli/source_record.h"
#include "fabric/status.h"
#include "renderer/import/raster_name.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::cli::bench {
namespace {

namespace fs = std::filesystem;

using Files = std::vector<std::string>;

/// What an import says of its source.
struct Kept {
    std::uint64_t hash = 0;
    bool areTurned = false;  ///< some of its triangles
};

absl::StatusOr<Kept> keptOf(const fabric::SceneObject& object, const page::SourceOptions& remote) {
    if (object.kind == fabric::ObjectKind::Mesh) {
        ASSIGN_OR_RETURN(const mesh::EymFile file, mesh::EymFile::open(object.path, remote));
        return Kept{file.sourceHash(), file.turnedTriangles() > 0};
    }
    ASSIGN_OR_RETURN(const auto file, terrain::EytFile::open(object.path, remote));
    return Kept{file->index().sourceHash};
}

bool areThere(const Files& files) {
    return !files.empty() && std::ranges::all_of(files, import::isThere);
}

/// Takes those of `given` that are named like the recorded ones, in their order; none unless all
/// are.
Files takeNamedLike(const Files& recorded, Files& given) {
    Files files;
    Files left = given;
    for (const std::string& one : recorded) {
        const auto same = std::ranges::find_if(left, [&](const std::string& path) {
            return fs::path(path).filename() == fs::path(one).filename();
        });
        if (same == left.end())
            return {};
        files.push_back(std::move(*same));
        left.erase(same);
    }
    given = std::move(left);
    return files;
}

Files beside(const std::string& imported, const Files& recorded) {
    Files files;
    for (const std::string& one : recorded)
        files.push_back((fs::path(imported).parent_path() / fs::path(one).filename()).string());
    return files;
}

/// What is named on the command line and never looked at would be taken for what was measured.
absl::Status checkGiven(const fabric::Scene& scene, const Files& given) {
    Files wanted;
    for (const fabric::SceneObject& object : scene.objects) {
        const std::optional<Files> recorded = recordedSources(object.path);
        if (!recorded)
            return absl::OkStatus();  // any may be its source
        for (const std::string& one : *recorded)
            wanted.push_back(fs::path(one).filename().string());
    }
    for (const std::string& path : given) {
        if (!import::isThere(path))
            return absl::NotFoundError(fmt::format("--source {}: no such file", path));
        if (std::ranges::find(wanted, fs::path(path).filename().string()) == wanted.end())
            return absl::InvalidArgumentError(
                fmt::format("--source {}: no source of what the scene shows has this name; give "
                            "them the names under which they were imported: {}",
                            path, fmt::join(wanted, ", ")));
    }
    return absl::OkStatus();
}

/// Where to look, in this order. What is given may be several imports' of one name, or, where none
/// says how they are named, that of one of them or all of one's: their hash tells.
std::vector<Files> places(const std::string& imported, const std::optional<Files>& recorded,
                          Files given) {
    std::vector<Files> candidates;
    if (recorded) {
        for (Files like; !(like = takeNamedLike(*recorded, given)).empty();)
            candidates.push_back(std::move(like));
        candidates.push_back(*recorded);
        if (Files neighbours = beside(imported, *recorded); neighbours != *recorded)
            candidates.push_back(std::move(neighbours));
        return candidates;
    }
    candidates.push_back(given);
    if (given.size() > 1)
        for (const std::string& one : given) candidates.push_back({one});
    return candidates;
}

absl::Status isNowhere(const std::string& imported, const std::optional<Files>& recorded) {
    if (!recorded)
        return absl::NotFoundError(
            fmt::format("{}: where its source lies is not known, since {} is not there; import it "
                        "again, or name the source's files with --source",
                        imported, sourceRecordName(imported)));
    return absl::NotFoundError(fmt::format(
        "{}: its source {} is not there, nor beside it; put it there, or name the source's "
        "files with --source",
        imported, fmt::join(*recorded, ", ")));
}

/// `others` are not it either.
absl::Status isAnother(const Files& files, const std::string& imported, std::uint64_t hash,
                       std::uint64_t kept, const std::vector<Files>& others = {}) {
    std::string nor;
    for (const Files& other : others) nor += fmt::format(", nor is {}", fmt::join(other, ", "));
    return absl::InvalidArgumentError(
        fmt::format("{}: is not what {} was imported from: its hash is {:016x}, that of the "
                    "import's source {:016x}{}; import it again, or name what it was with --source",
                    fmt::join(files, ", "), imported, hash, kept, nor));
}

/// For people.
std::string sizeText(std::uint64_t bytes) {
    const auto size = static_cast<double>(bytes);
    return size < 0x1p20 ? fmt::format("{:.1f} KiB", size / 0x1p10)
                         : fmt::format("{:.1f} MiB", size / 0x1p20);
}

struct Candidate {
    FoundSource source;
    std::uint64_t neededBytes = 0;
};

absl::StatusOr<Candidate> findSource(const fabric::SceneObject& object, const Files& given,
                                     const page::SourceOptions& remote) {
    ASSIGN_OR_RETURN(const Kept kept, keptOf(object, remote));
    const std::optional<Files> recorded = recordedSources(object.path);
    absl::Status unread;
    std::optional<std::uint64_t> firstHash;
    std::vector<Files> others;
    for (const Files& files : places(object.path, recorded, given)) {
        if (!areThere(files))
            continue;
        const auto facts = truth::inspectSource(object.kind, files);
        if (!facts.ok()) {
            unread.Update(facts.status());
            continue;
        }
        if (facts->hash == kept.hash)
            return Candidate{
                {object.path, object.kind, {object.singleSided, kept.areTurned}, files, kept.hash},
                facts->neededBytes};
        if (!firstHash)
            firstHash = facts->hash;
        others.push_back(files);
    }
    if (!others.empty())
        return isAnother(others.front(), object.path, *firstHash, kept.hash,
                         {others.begin() + 1, others.end()});
    return unread.ok() ? isNowhere(object.path, recorded) : unread;
}

}  // namespace

absl::StatusOr<std::vector<FoundSource>> findSources(const fabric::Scene& scene, const Files& given,
                                                     const ReferenceMemory& memory,
                                                     const page::SourceOptions& remote) {
    RETURN_IF_ERROR(checkGiven(scene, given));
    std::vector<FoundSource> found;
    std::uint64_t needed = memory.framesBytes;
    for (const fabric::SceneObject& object : scene.objects) {
        if (std::ranges::any_of(found, [&](const FoundSource& one) { return one.isOf(object); }))
            continue;
        ASSIGN_OR_RETURN(Candidate one, findSource(object, given, remote));
        needed += one.neededBytes;
        found.push_back(std::move(one.source));
    }
    if (needed > memory.limitBytes)
        return absl::ResourceExhaustedError(fmt::format(
            "{}: the reference of all that the scene shows takes about {} of memory, {} of it for "
            "{}, and may use {}; allow more with --reference-memory, or measure fewer "
            "--reference-frames, a smaller --size or a part of the scene",
            found.front().files.front(), sizeText(needed), sizeText(memory.framesBytes),
            memory.frames, sizeText(memory.limitBytes)));
    return found;
}

absl::StatusOr<ReferenceScene> readSources(const fabric::Scene& scene,
                                           const std::vector<FoundSource>& found) {
    std::vector<truth::SourceSurface> sources;
    for (const FoundSource& one : found) {
        ASSIGN_OR_RETURN(sources.emplace_back(), truth::readSource(one.kind, one.files, one.sides));
        // A flight may have taken an hour since it was found.
        if (sources.back().hash != one.hash)
            return isAnother(one.files, one.imported, sources.back().hash, one.hash);
    }
    ReferenceScene reference;
    std::vector<truth::PlacedSurface> placed;
    for (const fabric::SceneObject& object : scene.objects) {
        const auto one = std::ranges::find_if(
            found, [&](const FoundSource& source) { return source.isOf(object); });
        const truth::SourceSurface& source = sources[static_cast<std::size_t>(one - found.begin())];
        reference.objects.push_back({source, object.path, object.worldFromObject});
        placed.push_back({source.surface(), object.worldFromObject});
    }
    reference.surface = std::make_shared<truth::PlacedSurfaces>(placed);
    return reference;
}

}  // namespace eyrie::cli::bench
