// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/terrain_choices.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <xxhash.h>

#include "fabric/name_beside.h"
#include "renderer/import/terrain_import.h"

namespace eyrie::import {
namespace {

constexpr std::uint64_t kLeastScratch = std::uint64_t{4} << 20;

/// What pages under way take more where the ground is noise, every post of it a vertex, than where
/// it is mountains; and what strips of a very wide grid do: measured.
constexpr std::uint64_t kRoomForNoise = std::uint64_t{32} << 20;

fabric::Mat4 objectFromLattice(const terrain::GridFrame& frame,
                               const terrain::HeightLattice& lattice) {
    fabric::Mat4 m(1.0);
    m[0] = {frame.perColumn.x, frame.perColumn.y, 0, 0};
    m[1] = {frame.perRow.x, frame.perRow.y, 0, 0};
    m[2] = {0, 0, lattice.stepMetres, 0};
    m[3] = {frame.origin.x, frame.origin.y, 0, 1};
    return m;
}

/// What GDAL warps of pictures at once, and texture tiles under way: measured.
constexpr std::uint64_t kImagery = std::uint64_t{40} << 20;

/// Summaries, coarse vertex levels, tile records, and those again while they are written.
std::uint64_t tileBytes(const terrain::GridFrame& frame) {
    constexpr std::uint64_t kPostsPerByte = 10;
    return static_cast<std::uint64_t>(frame.columns) * static_cast<std::uint64_t>(frame.rows) /
           kPostsPerByte;
}

std::uint64_t pictureBytes(const ImagerySource* imagery) {
    return imagery == nullptr ? 0 : kImagery + imagery->readingBytes();
}

/// Bytes that every import holds in memory, whatever lies on scratch.
std::uint64_t residentBytes(const HeightSource& posts, std::uint64_t ofPictures) {
    // The program with GDAL and PROJ, GDAL's cache, strips and pages under way: measured.
    constexpr std::uint64_t kProgram = std::uint64_t{160} << 20;
    return kProgram + posts.readingBytes() + tileBytes(posts.frame()) + ofPictures;
}

/// What level 0 may be off at least: where heights are rounded, by half a step for that and half of
/// it again for what is left out.
double finestErrorMetres(const terrain::HeightLattice& lattice) {
    return lattice.isLossless ? 0 : lattice.stepMetres * 0.75;
}

}  // namespace

std::vector<double> levelThresholds(int levels, double postMetres,
                                    const terrain::HeightLattice& lattice,
                                    const std::optional<double>& errorMetres) {
    std::vector<double> thresholds;
    for (int level = 0; level < levels; ++level)
        thresholds.push_back(kErrorPerSpacing * postMetres *
                             std::exp2(level - terrain::kFullResolutionLevels + 1));
    thresholds[0] = lattice.isLossless ? 0 : lattice.stepMetres / 4;
    if (errorMetres)  // half a step is for the heights' own rounding
        thresholds[0] = std::max(thresholds[0],
                                 *errorMetres - (lattice.isLossless ? 0 : lattice.stepMetres / 2));
    for (double& threshold : thresholds) threshold = std::max(threshold, thresholds[0]);
    return thresholds;
}

std::vector<std::string> notesOnError(const terrain::HeightLattice& lattice,
                                      const std::optional<double>& errorMetres) {
    const double finest = finestErrorMetres(lattice);
    if (!errorMetres || *errorMetres >= finest)
        return {};
    return {
        fmt::format("the finest level may be off by {:.4g} m, not by {:.4g} m at most: heights "
                    "are stored in steps of {:.4g} m",
                    finest, *errorMetres, lattice.stepMetres)};
}

std::vector<std::string> notesOnMemory(const HeightSource& posts, const ImagerySource* imagery,
                                       std::uint64_t memoryBytes) {
    const std::uint64_t ofPictures = pictureBytes(imagery);
    const std::uint64_t taken = residentBytes(posts, ofPictures) + kLeastScratch;
    if (taken <= memoryBytes)
        return {};
    const terrain::GridFrame& frame = posts.frame();
    const std::string why =
        ofPictures > tileBytes(frame)
            ? fmt::format("reading pictures takes {} MB of that", ofPictures >> 20)
            : fmt::format(
                  "what is known of the tiles of {} x {} posts does not go to the scratch "
                  "file",
                  frame.columns, frame.rows);
    return {fmt::format("takes about {} MB of memory, not {} MB: {}", taken >> 20,
                        memoryBytes >> 20, why)};
}

terrain::EytIndex emptyIndex(const terrain::ElevationModel& model,
                             const terrain::HeightLattice& lattice, const std::string& crsWkt,
                             std::uint64_t sourceHash) {
    terrain::EytIndex index;
    index.quadtree = terrain::Quadtree(static_cast<std::uint32_t>(model.frame.columns),
                                       static_cast<std::uint32_t>(model.frame.rows));
    index.objectFromLattice = objectFromLattice(model.frame, lattice);
    index.crsWkt = crsWkt;
    index.sourceHash = sourceHash;
    index.nodataPosts = model.statistics.nodataPosts;
    index.tiles.resize(index.quadtree.tileCount());
    index.pages.resize(index.quadtree.pageCount());
    return index;
}

std::uint32_t texturesOf(const ImagerySource* imagery) {
    return imagery == nullptr ? 0
                              : static_cast<std::uint32_t>(imagery->pyramid().tilesX(0)) *
                                    static_cast<std::uint32_t>(imagery->pyramid().tilesY(0));
}

std::uint64_t imageryBytes(const HeightSource& posts, std::uint64_t memoryBytes) {
    const std::uint64_t resident = residentBytes(posts, kImagery);
    return memoryBytes > resident ? memoryBytes - resident : 0;
}

std::uint64_t scratchBytes(const HeightSource& posts, const ImagerySource* imagery,
                           std::uint64_t memoryBytes) {
    const std::uint64_t resident = residentBytes(posts, pictureBytes(imagery)) + kRoomForNoise;
    return std::max(kLeastScratch, memoryBytes > resident ? memoryBytes - resident : 0);
}

std::string scratchPath(const std::string& out, const std::string& folder) {
    namespace fs = std::filesystem;
    if (folder.empty())
        return fabric::nameBeside(out, ".scratch");
    const std::string whole = fs::absolute(out).lexically_normal().string();
    return fabric::nameBeside(
        (fs::path(folder) / fs::path(out).filename()).string(),
        fmt::format("-{:016x}.scratch", XXH64(whole.data(), whole.size(), 0)));
}

}  // namespace eyrie::import
