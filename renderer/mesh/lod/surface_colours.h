// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "fabric/image.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// What colour a mesh has anywhere on its surface: its vertices' times its images'. Any thread.
class SurfaceColours {
public:
    /// Of `mesh`, which outlives this.
    explicit SurfaceColours(const PackedMesh& mesh) : mesh_(mesh) {}

    /// Whether there is anything to ask for.
    bool areAny() const { return !mesh_.colours.empty() || !mesh_.textureCoordinates.empty(); }

    /// Which of an image's levels has texels about `spacingSteps` apart on a triangle; 0 without
    /// an image.
    std::uint32_t levelFor(const Triangle& triangle, double spacingSteps) const;

    /// At the place that `weights` (which add up to 1) of its corners give. Alpha is the vertices'
    /// times the image's.
    fabric::Rgba at(const Triangle& triangle, const glm::dvec3& weights, std::uint32_t level) const;

    /// Whether the material has no hole there, by texels about `spacingSteps` apart.
    bool isThere(const Triangle& triangle, const glm::dvec3& weights, double spacingSteps) const;

private:
    using Texels = std::vector<fabric::Rgba>;

    const Material* materialOf(const Triangle& triangle) const;
    fabric::Rgba texel(const Material& material, const Triangle& triangle,
                       const glm::dvec3& weights, std::uint32_t level) const;
    const Texels& texelsOf(std::uint32_t image, std::uint32_t level) const;

    const PackedMesh& mesh_;
    mutable std::mutex mutex_;
    mutable std::map<std::pair<std::uint32_t, std::uint32_t>, std::unique_ptr<const Texels>>
        decoded_;  ///< by image and level
};

}  // namespace eyrie::mesh
