// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace eyrie::simulator {

/// Ways to share a picture between renderers, as .eqc text makes them.
struct Layout {
    std::string name;  ///< 2D, DB, direct send, binary swap, DPlex
    std::string eqc;
};

/// Of `renderers` (1 or more) with a picture of `width` x `height`; binary swap for powers of two
/// only. One renderer: the plain picture, whatever the name.
std::vector<Layout> layoutsOf(int renderers, int width, int height);

}  // namespace eyrie::simulator
