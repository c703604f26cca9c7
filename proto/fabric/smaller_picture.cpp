// SPDX-License-Identifier: Apache-2.0
#include "fabric/smaller_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eyrie::fabric {

PictureSides smallerPicture(int width, int height, double scale, int least) {
    if (scale >= 1)
        return {width, height};
    constexpr int kNearby = 16;
    constexpr double kClearly = 0.9;  // what fewer pixels are worth
    const int widest = std::clamp(static_cast<int>(std::lround(scale * width)), 1, width);
    PictureSides best;
    double off = std::numeric_limits<double>::infinity();
    for (int each = widest; each >= widest - std::min(kNearby, widest / kNearby); --each) {
        const long other = std::lround(static_cast<double>(each) * height / width);
        const PictureSides sides{each, std::max(1, static_cast<int>(other))};
        if (const double error = shapeErrorPixels(width, height, sides); error < kClearly * off) {
            off = error;
            best = sides;
        }
    }
    return {std::max(best.width, std::min(least, width)),
            std::max(best.height, std::min(least, height))};
}

double shapeErrorPixels(int width, int height, const PictureSides& drawn) {
    if (drawn.width <= 0 || drawn.height <= 0)
        return 0;
    const double wider =
        static_cast<double>(drawn.height) * width / (static_cast<double>(drawn.width) * height);
    return 0.5 * width * std::abs(wider - 1);
}

}  // namespace eyrie::fabric
