// SPDX-License-Identifier: Apache-2.0
#include "coordinator/composite/assemble_2d.h"

#include <utility>

namespace eyrie::coordinator {

fabric::Image assemble2D(const fabric::PixelViewport& area, fabric::Rgba background, bool withDepth,
                         std::vector<fabric::Image> parts) {
    if (parts.size() == 1 && parts[0].area == area && (parts[0].hasDepth() || !withDepth)) {
        fabric::Image whole = std::move(parts[0]);
        if (!withDepth)
            whole.depth.clear();
        return whole;
    }
    fabric::Image picture = fabric::makeImage(area, background, withDepth);
    for (const fabric::Image& part : parts) fabric::paste(part, picture);
    return picture;
}

}  // namespace eyrie::coordinator
