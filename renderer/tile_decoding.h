// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace eyrie {

/// What makes terrain's vertices and indices: the same ones either way.
enum class TileDecoding : std::uint8_t {
    Auto,  ///< whichever is faster on this machine, measured on the first terrain that is opened
    Cpu,
    Gpu,  ///< the CPU still reads the bits: those of a page come one after the other
};

}  // namespace eyrie
