// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/image.h"

/// Readers of what `eyrie render` writes, independent of its writers.
namespace eyrie::test {

/// A PNG of 8 bits a channel, without depth; its bottom row comes first, as images have it.
absl::StatusOr<fabric::Image> readPng(const std::string& path);

/// A single-channel PFM. Little-endian only, which a negative scale says.
struct DepthPicture {
    int width = 0;
    int height = 0;
    double scale = 0;
    std::vector<float> metres;  ///< as in the file: its first row is the bottom one
};
absl::StatusOr<DepthPicture> readPfm(const std::string& path);

/// The bytes of a file; NotFound when there is none.
absl::StatusOr<std::string> readFile(const std::string& path);

}  // namespace eyrie::test
