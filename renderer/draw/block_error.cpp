// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/block_error.h"

#include <algorithm>
#include <vector>

#include "fabric/box.h"

namespace eyrie::draw {

double errorOfBlocksPixels(std::span<const mesh::TriangleBlock> blocks,
                           const mesh::Lattice& lattice, const lod::ObjectView& view,
                           const DrawnWith& with, const TrianglesOf& trianglesOf,
                           int& mayLookInto) {
    struct Beyond {
        double pixels;
        const mesh::TriangleBlock* block;
    };
    std::vector<Beyond> beyondTau;
    double worst = with.knownPixels;
    for (const mesh::TriangleBlock& block : blocks) {
        const fabric::Box box{lattice.metres(block.bounds.min), lattice.metres(block.bounds.max)};
        const double rounding = view.roundingPixels(box, box);
        // Of most it is known at once that others are worse.
        if (view.looseErrorPixels(with.errorMetres, box) + rounding <= worst)
            continue;
        const double pixels = view.screenSpaceErrorPixels(with.errorMetres, box) + rounding;
        if (pixels <= with.tauPixels)
            worst = std::max(worst, pixels);
        else
            beyondTau.push_back({pixels, &block});
    }
    std::ranges::stable_sort(beyondTau, std::ranges::greater(), &Beyond::pixels);
    for (const auto& [pixels, block] : beyondTau) {
        if (pixels <= worst)
            break;
        if (mayLookInto == 0)
            return pixels;
        --mayLookInto;
        double ofTriangles = worst;
        trianglesOf(*block, [&](std::span<const fabric::Vec3, 3> triangle) {
            ofTriangles = std::max(ofTriangles,
                                   view.displacedPixels(with.errorMetres, triangle, ofTriangles));
        });
        worst = std::min(pixels, ofTriangles);
    }
    return worst;
}

}  // namespace eyrie::draw
