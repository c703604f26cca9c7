// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fabric/image.h"

namespace eyrie::coordinator {

/// The picture of `area` from parts side by side (sort-first): background, with depth 0, where no
/// part is. Depth is in the result if `withDepth`; every part that is not empty then has it.
/// Parts overwrite those before them where they overlap. Precondition: `area` contains each part.
fabric::Image assemble2D(const fabric::PixelViewport& area, fabric::Rgba background, bool withDepth,
                         std::vector<fabric::Image> parts);

}  // namespace eyrie::coordinator
