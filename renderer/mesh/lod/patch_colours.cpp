// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/patch_colours.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
/// A corner of weight w is within (1 - w) times the longest side. Without those of less than t, of
/// which there are two at most, light changes by less than 2t times what the corners differ by:
/// most as displayed where they are darkest. Opacity changes so at any. A third of all weights is
/// the least that the greatest has.
float reachShare(const FieldRange& shown) {
    float least = 1.0F / 3;
    for (int k = 0; k < 4; ++k) {
        const float tolerable =
            k < 3 ? (2 * std::sqrt(shown.least[k]) + kMostTint) * kMostTint : kMostTint;
        const float span = shown.most[k] - shown.least[k];
        if (2 * least * span > tolerable)
            least = tolerable / (2 * span);
    }
    return 1 - least;
}

std::array<FieldValue, 3> lightsOf(const PackedMesh& mesh, const Triangle& triangle) {
    std::array<FieldValue, 3> lights;
    for (std::size_t k = 0; k < 3; ++k)
        lights[k] = lightOf(unpackColour(mesh.colours[triangle[k]]));
    return lights;
}

double longestSide(const PackedMesh& mesh, const Triangle& triangle) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 from(unpackPosition(mesh.positions[triangle[k]]));
        const glm::dvec3 to(unpackPosition(mesh.positions[triangle[(k + 1) % 3]]));
        longest = std::max(longest, glm::distance(from, to));
    }
    return longest;
}

bool hasOneColour(const PackedMesh& mesh, const Patch& patch) {
    if (mesh.colours.empty() || patch.triangles.empty())
        return true;
    if (!patch.tints.empty())
        return false;
    const std::uint32_t first = mesh.colours[patch.triangles[0][0]];
    return std::ranges::all_of(patch.triangles, [&](const Triangle& triangle) {
        return std::ranges::all_of(
            triangle, [&](std::uint32_t vertex) { return mesh.colours[vertex] == first; });
    });
}

std::vector<FieldChanges> tintsOf(const PackedMesh& mesh, const Patch& patch) {
    if (!patch.tints.empty())
        return patch.tints;
    std::vector<FieldChanges> tints;
    tints.reserve(patch.triangles.size());
    for (const Triangle& triangle : patch.triangles)
        tints.emplace_back(rangeOf(lightsOf(mesh, triangle)));
    return tints;
}

double colourReach(const PackedMesh& mesh, const Patch& patch) {
    double reach = 0;
    for (std::size_t i = 0; i < patch.tints.size(); ++i) {
        const FieldRange shown = rangeOf(lightsOf(mesh, patch.triangles[i]));
        if (isOff(patch.tints[i], shown))
            reach =
                std::max(reach, double{reachShare(shown)} * longestSide(mesh, patch.triangles[i]));
    }
    return reach;
}

}  // namespace eyrie::mesh
