// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/image.h"

/// Pictures on disk. Every file appears under its name only when it is complete.
/// Errors: those of mesh::OutputFile; InvalidArgument where said.
namespace eyrie::cli {

/// The colour of `image` as the bytes of an 8-bit RGB PNG file.
absl::StatusOr<std::vector<std::byte>> encodePng(const fabric::Image& image);

/// The colour of `image`: 8-bit RGB PNG or, for .jpg and .jpeg, JPEG of quality 95 without
/// subsampling. InvalidArgument for another ending.
absl::Status writePicture(const fabric::Image& image, const std::string& path);

/// Whether writePicture knows the ending of `path`; the message names `option`.
absl::Status checkPictureName(const std::string& path, std::string_view option);

/// View-space depth in metres as PFM: 32-bit little-endian floats, bottom row first, infinity where
/// nothing was hit. Precondition: image.hasDepth().
absl::Status writeDepth(const fabric::Image& image, const std::string& path);

absl::Status writeFile(std::span<const std::byte> bytes, const std::string& path);
absl::Status writeText(std::string_view text, const std::string& path);

}  // namespace eyrie::cli
