// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace eyrie::import {

/// Whether this is a JPEG without the marker that ends it, as some programs write it and as files
/// are that were cut off.
bool lacksJpegEnd(std::span<const std::byte> bytes);

/// Whether such a JPEG has one scan without restarts: what is drawn of one that was cut off depends
/// then on what follows it.
bool isOneJpegScan(std::span<const std::byte> bytes);

/// A JPEG with something behind it, and then the marker that ends it.
std::vector<std::byte> withJpegEnd(std::span<const std::byte> bytes, std::string_view between);

}  // namespace eyrie::import
