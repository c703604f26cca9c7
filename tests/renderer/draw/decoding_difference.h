// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace eyrie::test {

/// In what the tiles that the GPU makes of a page's bytes differ from those that the CPU makes;
/// empty: in nothing, not even in what they refuse. Adds tiles with triangles to `tiles`.
std::string decodingDifference(const std::vector<std::uint32_t>& bytes,
                               std::size_t* tiles = nullptr);

}  // namespace eyrie::test
