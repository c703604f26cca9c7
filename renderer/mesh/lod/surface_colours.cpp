// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/surface_colours.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "renderer/mesh/image_codec.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

glm::dvec3 pointOf(const PackedMesh& mesh, std::uint32_t vertex) {
    return glm::dvec3(unpackPosition(mesh.positions[vertex]));
}

/// Twice the area of a triangle of the plane, or of space.
double doubleArea(const glm::dvec2& ab, const glm::dvec2& ac) {
    return std::abs(ab.x * ac.y - ab.y * ac.x);
}
double doubleArea(const glm::dvec3& ab, const glm::dvec3& ac) {
    return glm::length(glm::cross(ab, ac));
}

/// In texels of a side: repeated, or the outermost where it is clamped.
std::uint32_t texelAlong(double part, std::uint32_t texels, bool isClamped) {
    const double in = isClamped ? std::clamp(part, 0.0, 1.0) : part - std::floor(part);
    return std::min(static_cast<std::uint32_t>(in * texels), texels - 1);
}

std::uint8_t product(std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>((a * b + 127) / 255);
}

}  // namespace

const Material* SurfaceColours::materialOf(const Triangle& triangle) const {
    return mesh_.materials.empty() ? nullptr : &mesh_.materials[mesh_.materialOf[triangle[0]]];
}

std::uint32_t SurfaceColours::levelFor(const Triangle& triangle, double spacingSteps) const {
    const Material* material = materialOf(triangle);
    if (material == nullptr || !material->hasImage())
        return 0;
    const ImageShape& shape = mesh_.images[static_cast<std::size_t>(material->image)].shape;
    const auto texelsAt = [&](std::uint32_t vertex) {
        return glm::dvec2(mesh_.textureCoordinates[vertex]) / double{kTextureSteps} *
               glm::dvec2(shape.width, shape.height);
    };
    const auto& [a, b, c] = triangle;
    const double steps =
        doubleArea(pointOf(mesh_, b) - pointOf(mesh_, a), pointOf(mesh_, c) - pointOf(mesh_, a));
    const double texels = doubleArea(texelsAt(b) - texelsAt(a), texelsAt(c) - texelsAt(a));
    const double between = spacingSteps * std::sqrt(texels / std::max(steps, 1e-30));
    const double level = std::floor(std::log2(std::max(between, 1.0)) + 0.5);
    return static_cast<std::uint32_t>(std::min(level, shape.levels() - 1.0));
}

const SurfaceColours::Texels& SurfaceColours::texelsOf(std::uint32_t image,
                                                       std::uint32_t level) const {
    const std::lock_guard lock(mutex_);
    auto& texels = decoded_[{image, level}];
    if (!texels) {
        const Image& from = mesh_.images[image];
        texels = std::make_unique<const Texels>(decodeLevel(from.shape, from.blocks, level));
    }
    return *texels;
}

fabric::Rgba SurfaceColours::texel(const Material& material, const Triangle& triangle,
                                   const glm::dvec3& weights, std::uint32_t level) const {
    const auto image = static_cast<std::uint32_t>(material.image);
    const ImageShape& shape = mesh_.images[image].shape;
    glm::dvec2 place(0.0);
    for (int k = 0; k < 3; ++k)
        place += weights[k] * glm::dvec2(mesh_.textureCoordinates[triangle[std::size_t(k)]]);
    place /= double{kTextureSteps};
    const std::uint32_t column =
        texelAlong(place.x, shape.widthAt(level), (shape.flags & kClampsU) != 0);
    const std::uint32_t row =
        texelAlong(place.y, shape.heightAt(level), (shape.flags & kClampsV) != 0);
    const std::size_t rowTexels = (shape.widthAt(level) + 3) / 4 * 4;
    return texelsOf(image, level)[row * rowTexels + column];
}

fabric::Rgba SurfaceColours::at(const Triangle& triangle, const glm::dvec3& weights,
                                std::uint32_t level) const {
    fabric::Rgba colour{255, 255, 255, 255};
    if (!mesh_.colours.empty()) {
        glm::dvec4 sum(0);  // of light, which is what is linear (tints.h); and of alpha
        for (int k = 0; k < 3; ++k) {
            const fabric::Rgba one = unpackColour(mesh_.colours[triangle[std::size_t(k)]]);
            sum += weights[k] * glm::dvec4(one.r * one.r, one.g * one.g, one.b * one.b, one.a);
        }
        const auto byte = [](double value) {
            return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
        };
        const auto shown = [&](double light) { return byte(std::sqrt(std::max(light, 0.0))); };
        colour = {shown(sum.x), shown(sum.y), shown(sum.z), byte(sum.w)};
    }
    const Material* material = materialOf(triangle);
    if (material == nullptr || !material->hasImage())
        return colour;
    const fabric::Rgba shown = texel(*material, triangle, weights, level);
    return {product(colour.r, shown.r), product(colour.g, shown.g), product(colour.b, shown.b),
            product(colour.a, shown.a)};
}

bool SurfaceColours::isThere(const Triangle& triangle, const glm::dvec3& weights,
                             double spacingSteps) const {
    const Material* material = materialOf(triangle);
    return material == nullptr || material->alphaCutoff <= 0 ||
           at(triangle, weights, levelFor(triangle, spacingSteps)).a >=
               255.0 * double{material->alphaCutoff};
}

}  // namespace eyrie::mesh
