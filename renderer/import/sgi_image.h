// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/image.h"
#include "renderer/mesh/material.h"

namespace eyrie::import {

/// Whether a file that begins so is an image of Silicon Graphics' format (.rgb, .rgba, .bw, .sgi).
bool looksLikeSgi(std::span<const std::byte> bytes);

/// Its sides, as its header has them. Safe on any bytes. Errors: InvalidArgument (other than 8 bits
/// a channel, too large).
absl::StatusOr<mesh::ImageShape> sgiShapeOf(std::span<const std::byte> bytes);

/// Its texels, rows from the top, and its sides in `shape`. Of one or two channels the first is
/// grey; the second, or the fourth of four, is alpha. Safe on any bytes. Errors: InvalidArgument
/// (other than 8 bits a channel, too large, damaged).
/// P. Haeberli, "The SGI Image File Format", 1.00.
absl::StatusOr<std::vector<fabric::Rgba>> decodeSgi(std::span<const std::byte> bytes,
                                                    mesh::ImageShape& shape);

}  // namespace eyrie::import
