// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace eyrie::import {

/// An OBJ file as Assimp 5.2 takes it for what is meant; nothing for one that it reads rightly. It
/// passes over lines that are indented, or follow a byte order mark; counts the numbers of a line
/// before it reads them, but none that begins with its point (.5), so that vertices are lost, or
/// divided by what it takes for a fourth coordinate; fails on comments that end such lines; and
/// counts vertices and their colours apart, so that those that have none, where others do, take the
/// colours of others: they become white.
std::optional<std::string> objForAssimp(std::string_view obj);

}  // namespace eyrie::import
