// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "renderer/terrain/height_grid.h"

namespace eyrie::import {

/// Distance of a synthetic terrain's posts.
inline constexpr double kSynthPostMetres = 30;

/// Mountains and valleys: `posts` a side, 30 m apart, from about 0 to 4000 m, south-west post at
/// UTM (500000, 5200000). The same for a seed on every machine; post (i, j) does not depend on
/// `posts`. Parallel. Precondition: posts from 2 to terrain::kMaxPosts.
terrain::HeightGrid synthesizeTerrain(std::uint32_t posts, std::uint64_t seed);

}  // namespace eyrie::import
