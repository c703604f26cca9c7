// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/statusor.h>

#include "renderer/import/imagery_source.h"
#include "renderer/import/progress.h"
#include "renderer/import/texel_store.h"
#include "renderer/terrain/eyt_writer.h"
#include "renderer/terrain/imagery/imagery_index.h"
#include "renderer/terrain/scratch.h"

namespace eyrie::import {

/// Makes the texture tiles of all levels and writes them in their order, in parallel but for the
/// reading of the pictures. `store` keeps the coarser levels while they are made. Stage
/// "imagery". Errors: the source's, the writer's, the scratch's, InvalidArgument (the terrain has
/// no covered texel; `name` is the pictures', for the message), Cancelled.
absl::StatusOr<terrain::ImageryIndex> buildImagery(ImagerySource& source, const std::string& name,
                                                   TexelStore& store,
                                                   const terrain::Scratch& scratch,
                                                   const ImportControl& control,
                                                   terrain::EytWriter& writer);

}  // namespace eyrie::import
