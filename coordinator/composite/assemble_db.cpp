// SPDX-License-Identifier: Apache-2.0
#include "coordinator/composite/assemble_db.h"

#include <utility>

#include "fabric/depth_merge.h"

namespace eyrie::coordinator {

fabric::Image assembleDb(const fabric::PixelViewport& area, fabric::Rgba background,
                         std::vector<fabric::Image> layers) {
    std::erase_if(layers, [](const fabric::Image& layer) { return layer.area.isEmpty(); });
    fabric::Image picture;
    auto next = layers.begin();
    if (next != layers.end() && next->area == area) {
        // A layer as large as the picture becomes the picture: nothing to fill, nothing to copy.
        picture = std::move(*next++);
    } else {
        picture = fabric::makeImage(area, background, true);
        if (next != layers.end())
            fabric::paste(*next++, picture);
    }
    for (; next != layers.end(); ++next) fabric::mergeDepth(*next, picture);
    return picture;
}

}  // namespace eyrie::coordinator
