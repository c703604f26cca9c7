// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <absl/status/statusor.h>
#include <glm/vec3.hpp>

#include "fabric/box.h"
#include "fabric/vec.h"

namespace eyrie::mesh {

inline constexpr int kLatticeBits = 21;  ///< three fit one 64-bit word
inline constexpr std::uint32_t kMaxLatticeCoordinate = (1U << kLatticeBits) - 1;

/// Farthest coordinate from the origin that a mesh may have: past a light month, and small enough
/// that no later product of two of them leaves float32.
inline constexpr double kMaxCoordinateMetres = 1e15;

/// Spacing below which a lattice is never made (a float32 matrix must still hold it).
inline constexpr int kMinStepExponent = -100;

/// The integer points that one model's vertices lie on.
///
/// `stepMetres` is a power of two and `originMetres` a whole number of steps, below 2^52 of them:
/// every lattice point is a double exactly, and lattices of different models share their points
/// where the coarser one has any.
struct Lattice {
    fabric::Vec3 originMetres{0.0};
    double stepMetres = 1;

    /// Object-space position of a lattice point. Exact.
    fabric::Vec3 metres(const glm::uvec3& point) const {
        return originMetres + fabric::Vec3(point) * stepMetres;
    }
    /// The same as a map. Exact.
    fabric::Mat4 objectFromLattice() const;
    /// The lattice point nearest to `metres`, which must lie in the box the lattice was fitted to.
    glm::uvec3 nearest(const fabric::Vec3& metres) const;

    /// Farthest that rounding to the nearest lattice point moves a position: half a cell's
    /// diagonal.
    double errorMetres() const;

    bool operator==(const Lattice&) const = default;
};

/// Fewest bits of a coordinate that a lattice is fitted for.
inline constexpr int kMinLatticeBits = 8;

/// The finest lattice on which every point of `bounds` rounds to coordinates of `bits` bits, from
/// kMinLatticeBits to kLatticeBits: the longest side has 2^(bits-1) steps or more.
/// InvalidArgument when `bounds` is empty, not finite or beyond kMaxCoordinateMetres.
absl::StatusOr<Lattice> fitLattice(const fabric::Box& bounds, int bits = kLatticeBits);

/// Whether a lattice read from a file keeps the rules above.
bool isValid(const Lattice& lattice);

}  // namespace eyrie::mesh
