// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace eyrie::wire {

/// How many bits stand for each symbol, so that symbols which occur `counts` times take the fewest
/// in all and none more than `longest`; 0 for one that does not occur. The same counts give the
/// same lengths on every machine. D. Huffman, "A Method for the Construction of Minimum-Redundancy
/// Codes", 1952; where a code would be too long, counts are made more alike, which costs little.
/// Precondition: 2^longest symbols at most.
std::vector<std::uint8_t> codeLengths(std::span<const std::uint32_t> counts, int longest);

/// The bits for symbols of these lengths as deflate has them, the first one lowest (RFC
/// 1951, 3.2.2).
std::vector<std::uint16_t> codesOf(std::span<const std::uint8_t> lengths);

}  // namespace eyrie::wire
