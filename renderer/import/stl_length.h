// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace eyrie::import {

/// What is wrong with a binary STL that is shorter or longer than the triangles that it counts, as
/// downloads are that were cut off; nothing where it is as long, or is text.
std::optional<std::string> wrongLengthOfStl(std::span<const std::byte> file);

}  // namespace eyrie::import
