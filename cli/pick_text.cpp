// SPDX-License-Identifier: Apache-2.0
#include "cli/pick_text.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "cli/bound_text.h"

namespace eyrie::cli {
namespace {

/// In the digits that the error leaves, with how far off it is so.
std::string elevationText(double metres, double error) {
    const double places = error > 0 ? std::ceil(1 - std::log10(error)) : 6;
    const std::string text =
        fmt::format("{:.{}f}", metres, static_cast<int>(std::clamp(places, 0.0, 9.0)));
    const double lost = std::abs(std::strtod(text.c_str(), nullptr) - metres);
    return fmt::format("{} m, off by {} m at most", text, boundText(error + lost));
}

}  // namespace

std::string pickText(const fabric::PickedPoint& point, const std::string& object) {
    const fabric::Vec3& p = point.worldMetres;
    std::string text =
        fmt::format("{}\n  at          {:.17g} {:.17g} {:.17g}\n", object, p.x, p.y, p.z);
    if (point.elevationMetres)
        text += fmt::format("  elevation   {}\n",
                            elevationText(*point.elevationMetres, point.elevationErrorMetres));
    text += fmt::format("  off by      {} m at most\n", boundText(point.errorMetres));
    text += fmt::format("  distance    {:.17g} m; the source is met from {:.17g} m on{}\n",
                        point.distanceMetres, point.nearestMetres,
                        std::isinf(point.farthestMetres)
                            ? ", if at all"
                            : fmt::format(", by {:.17g} m", point.farthestMetres));
    return text;
}

}  // namespace eyrie::cli
