// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace eyrie::import {

/// Tells pictures from others, in their order, by their sizes, first and last MiB, and 64 pieces of
/// what is between: pictures may be too large to read them all for that. Names do not count, since
/// machines see a shared folder under different ones; but what of a file they name does, and so do
/// the files that virtual ones name. 0 for none.
std::uint64_t pictureFingerprint(const std::vector<std::string>& paths);

/// Tells pictures on this machine from what they were before, by the names, sizes and times of last
/// change of all their files, those that virtual ones name included.
std::uint64_t pictureStamp(const std::vector<std::string>& paths);

}  // namespace eyrie::import
