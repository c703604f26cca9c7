// SPDX-License-Identifier: Apache-2.0
#include "fabric/regridding.h"

#include <algorithm>

namespace eyrie::fabric {
namespace {

int count(int pixels, int first, int every) {
    return std::max(0, (pixels - first + every - 1) / every);
}

/// Where the pixels that are made begin, how far apart they are, and how large: columns that are
/// left out make no pixel larger.
void follow(const Regridding& regridding, Raster& raster, Vec2& pixel) {
    if (regridding.kind == Regridding::Kind::EveryNth) {
        // Pixel i shows the centre of pixel first + i * every.
        const Vec2 every(regridding.everyColumn, regridding.everyRow);
        const Vec2 first(regridding.of.x + regridding.firstColumn,
                         regridding.of.y + regridding.firstRow);
        raster.origin += raster.step * (first + .5 - every / 2.0);
        raster.step *= every;
    } else {
        raster.origin += raster.step * Vec2(regridding.of.x, regridding.of.y);
        const Vec2 larger(static_cast<double>(regridding.of.width) / regridding.width,
                          static_cast<double>(regridding.of.height) / regridding.height);
        raster.step *= larger;
        pixel *= larger;
    }
    raster.width = regridding.width;
    raster.height = regridding.height;
}

}  // namespace

Regridding everyNth(const PixelViewport& of, int firstColumn, int everyColumn, int firstRow,
                    int everyRow) {
    return {Regridding::Kind::EveryNth,
            of,
            count(of.width, firstColumn, everyColumn),
            count(of.height, firstRow, everyRow),
            firstColumn,
            firstRow,
            everyColumn,
            everyRow};
}

Raster rasterAfter(const PixelViewport& view, std::span<const Regridding> regriddings,
                   const Vec2& jitter) {
    Raster raster{view.width, view.height, {0, 0}, {1, 1}};
    Vec2 pixel(1, 1);
    for (const Regridding& regridding : regriddings) follow(regridding, raster, pixel);
    raster.origin += pixel * jitter;
    return raster;
}

}  // namespace eyrie::fabric
