// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/terrain_ray_caster.h"

/// What a model without levels of detail is drawn with: fewer triangles, equally spread, whatever
/// the view. The yardstick of an adaptive one.
namespace eyrie::truth {

/// Every `stride`-th post of every `stride`-th row, the first ones included. Precondition: stride
/// >= 1 leaves 2 x 2 posts.
HeightGrid everyPost(const HeightGrid& grid, int stride);

/// Of a grid drawn with two triangles for each cell that has all four posts.
std::size_t trianglesOf(const HeightGrid& grid);

/// Of these, or of a mesh's, those that are not all beyond one side of what a camera sees, or
/// behind it: what is left where triangles out of view are not drawn.
std::size_t trianglesInView(const HeightGrid& grid, const fabric::Mat4& worldFromGrid,
                            const Pinhole& camera);
std::size_t trianglesInView(const TriangleMesh& mesh, const fabric::Mat4& worldFromMesh,
                            const Pinhole& camera);

/// Vertices of one cell of a cubic grid become one of them, by meshopt_simplifySloppy: the finest
/// grid that leaves at most `triangles`, or none at all.
TriangleMesh clustered(const TriangleMesh& mesh, std::size_t triangles);

}  // namespace eyrie::truth
