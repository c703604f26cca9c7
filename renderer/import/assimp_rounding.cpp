// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_rounding.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "renderer/import/stl_text.h"

namespace eyrie::import {
namespace {

/// Of a matrix made from a quaternion: each entry takes up to ten roundings of 1, 2^-24 each, and
/// two of the scale.
constexpr double kTurnRounding = 1.0 / (1 << 19);

/// Most that a matrix lengthens: the largest row of A^T A bounds its eigenvalues, and is the
/// largest where A is a rotation of a scale.
double stretchOf(const glm::dmat3& matrix) {
    const glm::dmat3 squared = glm::transpose(matrix) * matrix;
    double most = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 row = glm::abs(squared[i]);
        most = std::max(most, row.x + row.y + row.z);
    }
    return std::sqrt(most);
}

/// Of a matrix's stretch. None of axes that change places or signs.
double roundingOf(const glm::dmat3& matrix) {
    bool isOfAxes = true, isDiagonal = true;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) {
            const double entry = std::abs(matrix[column][row]);
            isOfAxes = isOfAxes && (entry == 0 || entry == 1);
            isDiagonal = isDiagonal && (entry == 0 || row == column);
        }
    return isOfAxes ? 0 : isDiagonal ? kSingleRounding : kTurnRounding;
}

}  // namespace

bool hasSingleCoordinates(const AssimpFormat& format, std::string_view text) {
    if (format.extension == ".stl")
        return !isStlText(text);
    return format.isGltf() && text.find("KHR_mesh_quantization") == std::string_view::npos;
}

AssimpPlace::AssimpPlace(const glm::dmat4& worldFromScene)
    : worldFromNode_(worldFromScene), stretch_(stretchOf(glm::dmat3(worldFromScene))) {}

AssimpPlace AssimpPlace::child(const glm::dmat4& parentFromNode) const {
    const glm::dmat3 turn(parentFromNode);
    const double distance = glm::length(glm::dvec3(parentFromNode[3]));
    const double stretch = stretchOf(turn);
    AssimpPlace place = *this;
    place.worldFromNode_ = worldFromNode_ * parentFromNode;
    place.shift_ += (perUnit_ + stretch_ * kSingleRounding) * distance;
    place.perUnit_ = (perUnit_ + stretch_ * roundingOf(turn)) * stretch;
    place.stretch_ *= stretch;
    return place;
}

double AssimpPlace::roundingMetres(double distance, bool isRounded) const {
    return shift_ + (perUnit_ + (isRounded ? stretch_ * kSingleRounding : 0)) * distance;
}

}  // namespace eyrie::import
