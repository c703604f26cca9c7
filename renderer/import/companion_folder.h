// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

/// Where the files may lie that a mesh is read with: material files, buffers, images, other models
/// that it names. Its own readers and Assimp's ask here, so that none is forgotten; what lies
/// elsewhere is not there for them, and is told as what is missing.
namespace eyrie::import {

/// Below `folder` alone from now on, in this process and those that it begins; anywhere where it is
/// empty, as at first. Before anything is read: no thread may read at the time.
/// Errors: NotFound.
absl::Status keepCompanionsBelow(const std::string& folder);

/// Whether the file at `path`, links followed, may be read with a mesh.
bool mayBeCompanion(const std::string& path);

}  // namespace eyrie::import
