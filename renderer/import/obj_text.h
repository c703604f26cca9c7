// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace eyrie::import {

/// An OBJ file as Assimp 5.2 takes it for what is meant; nothing for one that it reads rightly. It
/// passes over lines that are indented, or follow a byte order mark; counts the numbers of a line
/// before it reads them, but none that begins with its point (.5), so that vertices are lost;
/// divides vertices by a fourth number, and loses those of five or of more than six; fails on
/// comments that end such lines; counts vertices and their colours apart, so that those that have
/// none, where others do, take the colours of others: they become white; and takes several material
/// files of one line for one.
std::optional<std::string> objForAssimp(std::string_view obj);

/// For TriangleMesh::notes: numbers of vertices that are neither their place nor their colour.
std::vector<std::string> objVertexCaveats(std::string_view obj);

}  // namespace eyrie::import
