// SPDX-License-Identifier: Apache-2.0
#include "fabric/sight.h"

#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "fabric/camera.h"
#include "fabric/status.h"

namespace eyrie::fabric {
namespace {

/// Of the products of a rotation's columns: more than rounding adds.
constexpr double kRounding = 1e-9;

absl::Status invalid(std::string_view field, std::string_view found, std::string_view expected) {
    return absl::InvalidArgumentError(
        fmt::format("sight.{} is {}; it must be {}", field, found, expected));
}

absl::Status checkEye(const Vec3& eye) {
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(eye[i]) <= kMaxCoordinateMetres))
            return invalid("eye", fmt::format("({}, {}, {})", eye.x, eye.y, eye.z),
                           fmt::format("three numbers (metres) from {:g} to {:g}",
                                       -kMaxCoordinateMetres, kMaxCoordinateMetres));
    return absl::OkStatus();
}

absl::Status checkRotation(const Mat3& rotation) {
    const Mat3 product = glm::transpose(rotation) * rotation;
    bool isRotation = glm::determinant(rotation) > 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            isRotation = isRotation && std::abs(product[i][j] - (i == j ? 1 : 0)) <= kRounding;
    if (isRotation)
        return absl::OkStatus();
    return invalid("viewFromCamera", "no rotation",
                   "three axes of length 1 at right angles, right-handed, to 1e-9");
}

absl::Status checkExtent(double low, double high, std::string_view lowName,
                         std::string_view highName) {
    for (const auto& [value, name] : {std::pair(low, lowName), std::pair(high, highName)})
        if (!(std::abs(value) <= kMaxFrustumTangent))
            return invalid(
                fmt::format("frustum.{}", name), fmt::format("{}", value),
                fmt::format("from {:g} to {:g}", -kMaxFrustumTangent, kMaxFrustumTangent));
    if (high - low >= kMinFrustumSize)
        return absl::OkStatus();
    return invalid(
        fmt::format("frustum.{}", highName), fmt::format("{}", high),
        fmt::format("above frustum.{}, {}, by {:g} or more", lowName, low, kMinFrustumSize));
}

}  // namespace

absl::Status validate(const Sight& sight) {
    RETURN_IF_ERROR(checkEye(sight.eye));
    RETURN_IF_ERROR(checkRotation(sight.viewFromCamera));
    const Frustum& f = sight.frustum;
    RETURN_IF_ERROR(checkExtent(f.left, f.right, "left", "right"));
    return checkExtent(f.bottom, f.top, "bottom", "top");
}

}  // namespace eyrie::fabric
