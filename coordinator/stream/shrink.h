// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/image.h"

namespace eyrie::stream {

/// The colours of `image` in a picture of fewer pixels, each the mean of the area that it covers,
/// off by at most one level in 256; without depth. Preconditions: 1 ≤ width ≤ image.area.width, the
/// same for heights.
fabric::Image shrunk(const fabric::Image& image, int width, int height);

}  // namespace eyrie::stream
