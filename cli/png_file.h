// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include <absl/status/statusor.h>

#include "cli/image_files.h"

namespace eyrie::cli {

/// An 8-bit RGB PNG (sRGB), compressed as rows come: only a few of them are in memory at a time.
/// Errors: those of mesh::OutputFile.
absl::StatusOr<std::unique_ptr<PictureFile>> createPng(const std::string& path, int width,
                                                       int height, const std::stop_token& stop);

}  // namespace eyrie::cli
