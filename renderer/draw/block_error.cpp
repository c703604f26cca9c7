// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/block_error.h"

#include <algorithm>

#include "fabric/box.h"

namespace eyrie::draw {

double errorOfBlocksPixels(std::span<const mesh::TriangleBlock> blocks,
                           const mesh::Lattice& lattice, const lod::ObjectView& view,
                           const DrawnWith& with, const TrianglesOf& trianglesOf) {
    double worst = 0;
    for (const mesh::TriangleBlock& block : blocks) {
        const fabric::Box box{lattice.metres(block.bounds.min), lattice.metres(block.bounds.max)};
        const double rounding = view.roundingPixels(box, box);
        // Of most it is known at once that others are worse.
        if (view.looseErrorPixels(with.errorMetres, box) + rounding <= worst)
            continue;
        const double ofBox = view.screenSpaceErrorPixels(with.errorMetres, box) + rounding;
        if (ofBox <= with.tauPixels) {
            worst = std::max(worst, ofBox);
            continue;
        }
        double ofTriangles = worst;
        trianglesOf(block, [&](std::span<const fabric::Vec3, 3> triangle) {
            ofTriangles = std::max(ofTriangles,
                                   view.displacedPixels(with.errorMetres, triangle, ofTriangles));
        });
        worst = std::max(worst, std::min(ofBox, ofTriangles));
    }
    return worst;
}

}  // namespace eyrie::draw
