// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

namespace eyrie::wire {

/// One baseline JPEG of `height` rows from those of its upper and its lower half, which were made
/// alike, with a restart marker between: what is after one depends on nothing before. So halves may
/// be encoded, and decoded, at the same time, and the pixels are those of a picture encoded whole.
///
/// `blocks`: how many the upper half has, of as many pixels as its chroma has one for; the lower
/// has no more. Errors: InvalidArgument (the two are no JPEGs, or not made alike).
absl::StatusOr<std::vector<std::byte>> joined(std::span<const std::byte> upper,
                                              std::span<const std::byte> lower, int height,
                                              int blocks);

}  // namespace eyrie::wire
