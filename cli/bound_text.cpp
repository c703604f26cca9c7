// SPDX-License-Identifier: Apache-2.0
#include "cli/bound_text.h"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace eyrie::cli {

std::string boundText(double bound) {
    const std::string nearest = fmt::format("{:.3g}", bound);
    if (!std::isfinite(bound) || std::strtod(nearest.c_str(), nullptr) >= bound)
        return nearest;
    const double step = std::pow(10, std::floor(std::log10(std::abs(bound))) - 2);
    return fmt::format("{:.3g}", (std::floor(bound / step) + 1) * step);
}

}  // namespace eyrie::cli
