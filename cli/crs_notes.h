// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/page/page_source.h"

namespace eyrie::cli {

/// The name in a coordinate reference system's well-known text.
std::string crsName(const std::string& wkt);

/// A line for each terrain of `scene` that is in another CRS than the first one and those before
/// it: coordinates of two systems are no places in one scene, so that neighbours may lie far apart.
/// Terrains without a CRS say nothing. Precondition: objects are .eyt and .eym files. Errors: those
/// of EytFile::open.
absl::StatusOr<std::vector<std::string>> crsNotes(const fabric::Scene& scene,
                                                  const page::SourceOptions& sources);

}  // namespace eyrie::cli
