// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/texel_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace eyrie::terrain {
namespace {

double linearOf(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// From sRGB's bytes to linear light and back. Where a byte's step is smallest, at black, it is
/// five of the way back's.
class TransferTables {
public:
    TransferTables() {
        for (std::size_t k = 0; k < linear_.size(); ++k)
            linear_[k] = static_cast<float>(linearOf(static_cast<double>(k) / 255));
        for (std::size_t byte = 0, k = 0; k < encoded_.size(); ++k) {
            const double linear = static_cast<double>(k) / kSteps;
            while (byte < 255 && linearOf((static_cast<double>(byte) + 0.5) / 255) < linear) ++byte;
            encoded_[k] = static_cast<std::uint8_t>(byte);
        }
    }

    float linear(std::uint8_t encoded) const { return linear_[encoded]; }
    std::uint8_t encoded(float linear) const {
        return encoded_[static_cast<std::size_t>(linear * kSteps + 0.5F)];
    }

private:
    static constexpr int kSteps = 1 << 14;
    std::array<float, 256> linear_{};
    std::array<std::uint8_t, kSteps + 1> encoded_{};
};

fabric::Rgba meanOf(const std::array<fabric::Rgba, 4>& texels, const TransferTables& tables) {
    float alpha = 0;
    std::array<float, 3> sum{};
    for (const fabric::Rgba& texel : texels) {
        const float weight = texel.a;
        alpha += weight;
        sum[0] += weight * tables.linear(texel.r);
        sum[1] += weight * tables.linear(texel.g);
        sum[2] += weight * tables.linear(texel.b);
    }
    if (alpha == 0)
        return {0, 0, 0, 0};
    const auto channel = [&](float weighted) {
        return tables.encoded(std::min(weighted / alpha, 1.0F));
    };
    return {channel(sum[0]), channel(sum[1]), channel(sum[2]),
            static_cast<std::uint8_t>(alpha / 4 + 0.5F)};
}

}  // namespace

void halve(std::span<const fabric::Rgba> texels, std::int32_t columns, std::int32_t rows,
           std::span<fabric::Rgba> out) {
    static const TransferTables kTables;
    auto* to = out.data();
    for (std::int32_t y = 0; y < rows; y += 2) {
        const fabric::Rgba* upper = texels.data() + std::ptrdiff_t{y} * columns;
        const fabric::Rgba* lower = y + 1 < rows ? upper + columns : upper;
        for (std::int32_t x = 0; x < columns; x += 2) {
            const std::int32_t next = std::min(x + 1, columns - 1);
            *to++ = meanOf({upper[x], upper[next], lower[x], lower[next]}, kTables);
        }
    }
}

}  // namespace eyrie::terrain
