// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/image_files.h"

namespace eyrie::cli {

/// An 8-bit RGB PNG (sRGB), compressed row by row: only a few rows are in memory at a time.
/// Errors: those of mesh::OutputFile; ResourceExhausted (no memory), Internal (libpng).
absl::StatusOr<std::unique_ptr<PictureFile>> createPng(const std::string& path, int width,
                                                       int height);

/// The colour of `image` as the bytes of an 8-bit RGB PNG file, top row first.
absl::StatusOr<std::vector<std::byte>> encodePng(const fabric::Image& image);

}  // namespace eyrie::cli
