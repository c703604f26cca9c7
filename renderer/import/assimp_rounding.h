// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <glm/mat4x4.hpp>

#include "renderer/import/assimp_formats.h"

/// What single precision, in which Assimp has all numbers, moves: docs/errors.md#single-precision.
namespace eyrie::import {

/// How far a coordinate or translation may be moved, as a share of its distance from 0: seven
/// roundings, as text takes up to five (two of the digits, three of an exponent).
inline constexpr double kSingleRounding = 7.0 / (1 << 24);

/// Whether the file's own coordinates are in single precision, and come as they are.
bool hasSingleCoordinates(const AssimpFormat& format, std::string_view text);

/// In which frame a mesh is, and how far rounding has moved that.
class AssimpPlace {
public:
    explicit AssimpPlace(const glm::dmat4& worldFromScene);
    /// A node there.
    AssimpPlace child(const glm::dmat4& parentFromNode) const;

    const glm::dmat4& worldFromNode() const { return worldFromNode_; }
    /// Bound, in metres of the world, on how far a point is moved that the node has `distance` from
    /// its origin, with its own coordinates rounded or not.
    double roundingMetres(double distance, bool isRounded) const;

private:
    glm::dmat4 worldFromNode_;
    double stretch_;      ///< most that directions are lengthened by
    double shift_ = 0;    ///< metres that the origin may be off
    double perUnit_ = 0;  ///< and a point more, by its distance from there
};

}  // namespace eyrie::import
