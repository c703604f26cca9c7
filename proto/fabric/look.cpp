// SPDX-License-Identifier: Apache-2.0
#include "fabric/look.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::fabric {
namespace {

constexpr double kFlattest = 1e-9;

absl::Status checkRange(double value, double least, double most, std::string_view field) {
    if (value >= least && value <= most)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("look.{} is {}; it must be from {} to {}", field, value, least, most));
}

}  // namespace

absl::Status validate(const Look& look) {
    RETURN_IF_ERROR(
        checkRange(look.exaggeration, -kMaxExaggeration, kMaxExaggeration, "exaggeration"));
    RETURN_IF_ERROR(checkRange(look.slopeShading, 0, 1, "slopeShading"));
    RETURN_IF_ERROR(checkRange(look.saturation, 0, 2, "saturation"));
    if (look.contours) {
        RETURN_IF_ERROR(
            checkRange(look.contours->intervalMetres, 1e-3, 1e5, "contours.intervalMetres"));
        RETURN_IF_ERROR(checkRange(look.contours->widthPixels, 0.25, 16, "contours.widthPixels"));
    }
    if (look.transfer)
        RETURN_IF_ERROR(validate(*look.transfer));
    if (look.cutCamera)
        if (const absl::Status status = validate(*look.cutCamera); !status.ok())
            return withContext(status, "look.cutCamera");
    if (look.sun) {
        RETURN_IF_ERROR(checkRange(look.sun->azimuthDegrees, -360, 360, "sun.azimuthDegrees"));
        RETURN_IF_ERROR(checkRange(look.sun->elevationDegrees, -90, 90, "sun.elevationDegrees"));
    }
    return absl::OkStatus();
}

Mat4 exaggerated(const Mat4& worldFromObject, double exaggeration) {
    const double flattest = exaggeration < 0 ? -kFlattest : kFlattest;
    const double factor = std::abs(exaggeration) < kFlattest ? flattest : exaggeration;
    Mat4 result = worldFromObject;
    result[2] *= factor;
    return result;
}

}  // namespace eyrie::fabric
