// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>

#include <absl/status/statusor.h>

/// XXH64 of files' bytes, which processes that read the same files share in a folder. What is noted
/// there of a file on a disk is of use for as long as its inode, size and times of last change are
/// what they were; machines that share the file see the same.
namespace eyrie::import {

/// Of a file by any name that GDAL opens. With a `folder`, unless that is empty, from what is noted
/// there; else it reads all bytes and, of a large file, notes the hash there if it can. Any number
/// of threads and processes at once. Errors: NotFound, those of checkOpenFiles; Unavailable and
/// DataLoss, of which not all bytes can be read, elsewhere and here; Cancelled, between two
/// megabytes.
absl::StatusOr<std::uint64_t> fileHash(const std::string& path, const std::string& folder,
                                       const std::stop_token& stop = {});

/// Sees to it that the hash of a large file is noted in a folder, where it can be and is not called
/// off. No others are.
void noteHash(const std::string& path, const std::string& folder, const std::stop_token& stop = {});

/// Removes all that is noted in a folder.
void removeNotedHashes(const std::string& folder);

}  // namespace eyrie::import
