// SPDX-License-Identifier: Apache-2.0
#include "coordinator/composite/mean.h"

#include <cassert>
#include <cstdint>
#include <vector>

namespace eyrie::composite {

fabric::Image mean(std::span<const fabric::Image> samples) {
    assert(!samples.empty());
    fabric::Image image = samples.front();
    const std::size_t bytes = image.colour.size() * sizeof(fabric::Rgba);
    std::vector<std::uint32_t> sums(bytes, 0);
    for (const fabric::Image& sample : samples) {
        assert(sample.area == image.area);
        const auto* const values = reinterpret_cast<const std::uint8_t*>(sample.colour.data());
        for (std::size_t i = 0; i < bytes; ++i) sums[i] += values[i];
    }
    const auto count = static_cast<std::uint32_t>(samples.size());
    auto* const values = reinterpret_cast<std::uint8_t*>(image.colour.data());
    for (std::size_t i = 0; i < bytes; ++i)
        values[i] = static_cast<std::uint8_t>((sums[i] + count / 2) / count);
    return image;
}

}  // namespace eyrie::composite
