// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/import/height_source.h"
#include "renderer/import/imagery_source.h"
#include "renderer/terrain/deviation.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/height_grid.h"

/// What an import of terrain, whole or a shard of it, settles from what its posts are like.
namespace eyrie::import {

/// By level, ascending: the error that level L may have, in metres, see kErrorPerSpacing.
/// `errorMetres` is what level 0 may leave out; none: nothing that `lattice` can tell.
std::vector<double> levelThresholds(int levels, double postMetres,
                                    const terrain::HeightLattice& lattice,
                                    const std::optional<double>& errorMetres);

/// What is to be said of such an error where `lattice` cannot keep it; nothing where it can.
std::vector<std::string> notesOnError(const terrain::HeightLattice& lattice,
                                      const std::optional<double>& errorMetres);

/// What is to be said where an import takes more memory than it was allowed.
std::vector<std::string> notesOnMemory(const HeightSource& posts, const ImagerySource* imagery,
                                       std::uint64_t memoryBytes);

/// With empty records of all tiles and pages.
terrain::EytIndex emptyIndex(const terrain::ElevationModel& model,
                             const terrain::HeightLattice& lattice, const std::string& crsWkt,
                             std::uint64_t sourceHash);

/// Texture tiles of level 0 that imagery has; 0 of null.
std::uint32_t texturesOf(const ImagerySource* imagery);

/// What reading pictures may take, see openImagery, and the scratch, before either has anything.
std::uint64_t imageryBytes(const HeightSource& posts, std::uint64_t memoryBytes);

/// Bytes of a scratch's memory, so that the whole process takes about `memoryBytes`, or as little
/// more as it can.
std::uint64_t scratchBytes(const HeightSource& posts, const ImagerySource* imagery,
                           std::uint64_t memoryBytes);

/// The scratch file for what becomes `out`: beside it, or in `folder` unless that is empty.
std::string scratchPath(const std::string& out, const std::string& folder);

}  // namespace eyrie::import
