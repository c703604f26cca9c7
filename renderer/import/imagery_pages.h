// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/imagery_source.h"
#include "renderer/import/part_set.h"
#include "renderer/import/progress.h"
#include "renderer/import/terrain_stages.h"
#include "renderer/import/texel_store.h"
#include "renderer/terrain/eyt_writer.h"
#include "renderer/terrain/imagery/imagery_index.h"
#include "renderer/terrain/scratch.h"

namespace eyrie::import {

/// The pictures that an ImagerySource reads.
struct NamedPictures {
    std::string names;        ///< for messages
    std::uint64_t stamp = 0;  ///< pictureStamp, where an interrupted import may go on with them
};

/// Makes the texture tiles of all levels and writes them in their order, in parallel but for the
/// reading of the pictures. `store` keeps the coarser levels while they are made. The tiles of
/// level 0 come from `parts`, which may be null, instead of the source. Some tiles of a level at a
/// time are a stage of `stages`: those that an earlier run wrote of the same pictures are taken as
/// they are. Reported as "imagery". Errors: the source's, the writer's, the scratch's, the parts',
/// the stages', InvalidArgument (the terrain has no covered texel), Cancelled.
absl::StatusOr<terrain::ImageryIndex> buildImagery(
    ImagerySource& source, const NamedPictures& pictures, const PartSet* parts, TexelStore& store,
    const terrain::Scratch& scratch, const ImportControl& control, TerrainStages& stages,
    terrain::EytWriter& writer);

/// Takes the k-th of the textures asked for. One thread at a time.
using TextureSink = std::function<absl::Status(std::size_t k, const TexturePiece& texture)>;

/// Makes texture tiles of level 0 alone, `textures` of them, ascending, and hands them to `sink` in
/// whatever order they are read fastest. Stage "imagery". Errors: the source's, the sink's,
/// Cancelled.
absl::Status buildTextures(ImagerySource& source, const std::vector<std::uint32_t>& textures,
                           const ImportControl& control, const TextureSink& sink);

}  // namespace eyrie::import
