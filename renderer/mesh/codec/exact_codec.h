// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/vec.h"
#include "renderer/mesh/lattice.h"

/// Lossless coding of a node's source positions, beside those on the lattice: what is left of each
/// coordinate after that of its lattice point, in steps from one floating-point number to the next.
///
/// A page, little-endian: uint32 bytes of the bits, even; the bits (shares of x, y and z, then
/// plain bits); the symbols as 16-bit words (codec/rans.h).
namespace eyrie::mesh {

/// What the source's numbers were.
enum class ExactForm : std::uint8_t { Float32, Float64 };

/// The least form that holds each of `positions` exactly.
ExactForm exactFormOf(std::span<const fabric::Vec3> positions);

/// Precondition: as many of both; each of `exact` is of the form.
std::vector<std::byte> encodeExact(std::span<const fabric::Vec3> exact,
                                   std::span<const std::uint64_t> onLattice, const Lattice& lattice,
                                   ExactForm form);

/// One position for each of `onLattice`. Safe on any bytes: DataLoss.
absl::StatusOr<std::vector<fabric::Vec3>> decodeExact(std::span<const std::byte> page,
                                                      std::span<const std::uint64_t> onLattice,
                                                      const Lattice& lattice, ExactForm form);

/// No page that encodeExact makes of so many positions is longer: a coordinate is a symbol, of a
/// word at most, and at most 8 bytes of plain bits. The rest is sizes, states, and shares of 3
/// contexts of up to 65 symbols, each in 3 bytes.
constexpr std::uint64_t mostExactBytes(std::uint32_t positions) {
    constexpr std::uint64_t kSharesAndSizes = 1 << 10;
    return kSharesAndSizes + std::uint64_t{positions} * 3 * (2 + 8);
}

}  // namespace eyrie::mesh
