// SPDX-License-Identifier: Apache-2.0
#include "fabric/transfer_function.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <glm/exponential.hpp>

#include "fabric/status.h"

namespace eyrie::fabric {
namespace {

absl::Status invalid(std::size_t primitive, std::string_view field, double found,
                     std::string_view expected) {
    return absl::InvalidArgumentError(fmt::format(
        "look.transfer.primitives[{}].{} is {}; it must be {}", primitive, field, found, expected));
}

absl::Status validatePrimitive(const TransferPrimitive& primitive, std::size_t i) {
    if (!(std::abs(primitive.centre) <= kMaxTransferHeight))
        return invalid(i, "centre", primitive.centre, "from -1000000 to 1000000");
    if (!(primitive.width > 0 && primitive.width <= kMaxTransferHeight))
        return invalid(i, "width", primitive.width, "more than 0, and at most 1000000");
    for (int channel = 0; channel < 3; ++channel)
        if (!(primitive.colour[channel] >= 0 && primitive.colour[channel] <= 1))
            return invalid(i, fmt::format("colour[{}]", channel), primitive.colour[channel],
                           "from 0 to 1");
    if (!(primitive.opacity >= 0 && primitive.opacity <= 1))
        return invalid(i, "opacity", primitive.opacity, "from 0 to 1");
    return absl::OkStatus();
}

}  // namespace

absl::Status validate(const TransferFunction& function) {
    if (function.primitives.size() > kMaxTransferPrimitives)
        return absl::InvalidArgumentError(
            fmt::format("look.transfer.primitives has {} entries; at most {} are allowed",
                        function.primitives.size(), kMaxTransferPrimitives));
    for (std::size_t i = 0; i < function.primitives.size(); ++i)
        RETURN_IF_ERROR(validatePrimitive(function.primitives[i], i));
    return absl::OkStatus();
}

double shapeAt(PrimitiveShape shape, double distance) {
    const double d = std::abs(distance);
    if (!(d < 1))
        return 0;
    switch (shape) {
        case PrimitiveShape::Blend:
            return d <= 0.5 ? 1 : (1 - d) / d;
        case PrimitiveShape::Box:
            return 1;
        case PrimitiveShape::Tent:
            return 1 - d;
        case PrimitiveShape::Smooth:
            return (1 - d * d) * (1 - d * d);
    }
    return 0;
}

Tint evaluate(const TransferFunction& function, double height) {
    Vec3 weighted(0);
    double sum = 0;
    Tint tint;
    for (const TransferPrimitive& primitive : function.primitives) {
        const double opacity =
            primitive.opacity *
            shapeAt(primitive.shape, (height - primitive.centre) / primitive.width);
        weighted += primitive.colour * primitive.colour * opacity;
        sum += opacity;
        tint.opacity = std::max(tint.opacity, opacity);
    }
    if (sum > 0)
        tint.colour = weighted / sum;
    return tint;
}

TransferFunction hypsometricTints() {
    // As in effects/terrain.effect: linear, equal steps of elevation apart.
    constexpr std::array kLinear = {Vec3(0.12, 0.19, 0.06), Vec3(0.07, 0.14, 0.05),
                                    Vec3(0.22, 0.21, 0.09), Vec3(0.25, 0.19, 0.13),
                                    Vec3(0.34, 0.31, 0.28), Vec3(0.86, 0.89, 0.93)};
    TransferFunction function;
    const double step = 1.0 / (kLinear.size() - 1);
    for (std::size_t i = 0; i < kLinear.size(); ++i)
        function.primitives.push_back(
            {PrimitiveShape::Blend, static_cast<double>(i) * step, step, glm::sqrt(kLinear[i]), 1});
    return function;
}

}  // namespace eyrie::fabric
