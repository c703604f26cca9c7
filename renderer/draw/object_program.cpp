// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/object_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "renderer/lod/lattice_view.h"

namespace eyrie::draw {
namespace {

/// Of ObjectBlock::Variant::lights (effects/object.block): lights of either kind, and spots.
constexpr int kWithPoints = fabric::kMaxLights;
constexpr int kWithSpots = fabric::kMaxLights + 1;
static_assert(effects::ObjectBlock::Variant::kMaxLights == kWithSpots);

/// Of cosines, between where a cone lets all through and where nothing: no edge is harder, as glTF
/// has it.
constexpr double kHardestEdge = 0.001;

/// The even scale of a rotation that also scales; 0 where the map shears, mirrors or scales
/// unevenly.
double conformalScale(const fabric::Mat3& map) {
    const double scale = glm::length(map[0]);
    const fabric::Mat3 product = glm::transpose(map) * map;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(product[i][j] - (i == j ? scale * scale : 0)) > 1e-9 * scale * scale)
                return 0;
    return glm::determinant(map) > 0 ? scale : 0;
}

int variantOf(const fabric::Lights& lights) {
    if (std::ranges::any_of(lights.points,
                            [](const auto& light) { return light.cone.has_value(); }))
        return kWithSpots;
    if (!lights.points.empty())
        return kWithPoints;
    return std::max(static_cast<int>(lights.distant.size()), 1);
}

/// What the shader has of the cones of lights, by light.
class Cones {
public:
    Cones() { offsets_.fill(1); }

    void set(std::size_t light, const fabric::LightCone& cone,
             const fabric::Mat3& shadingFromWorld) {
        const double outer = std::cos(glm::radians(cone.outerDegrees));
        const double inner = std::cos(glm::radians(cone.innerDegrees));
        const double scale = 1 / std::max(kHardestEdge, inner - outer);
        axes_[light] = glm::vec3(shadingFromWorld * glm::normalize(cone.axis) * -scale);
        offsets_[light] = static_cast<float>(-outer * scale);
    }
    void setIn(const effects::ObjectBlock& program) const {
        program.lightAxes(axes_);
        program.lightConeOffsets(offsets_);
    }

private:
    std::array<glm::vec3, kWithSpots> axes_{};
    std::array<float, kWithSpots> offsets_{};
};

/// `shadingFromWorld` turns directions; `snappedEye` is what the vertices are relative to, world
/// space. See the axes in effects/object.block.
void setLights(const effects::ObjectBlock& program, const FrameState& frame,
               const fabric::Mat3& shadingFromWorld, const fabric::Vec3& snappedEye) {
    std::array<glm::vec3, kWithSpots> places{};
    std::array<float, kWithSpots> falloffs{};
    std::array<glm::vec3, kWithSpots> colours{};
    Cones cones;
    std::size_t count = 0;
    const auto add = [&](const fabric::Vec3& place, double falloff, const fabric::Vec3& colour) {
        places[count] = glm::vec3(shadingFromWorld * place);
        falloffs[count] = static_cast<float>(falloff);
        colours[count] = glm::vec3(colour);
        ++count;
    };
    for (const fabric::DirectionalLight& light : frame.lights.distant)
        add(glm::normalize(-light.direction), 0, light.colour);
    for (const fabric::PointLight& light : frame.lights.points) {
        if (light.cone)
            cones.set(count, *light.cone, shadingFromWorld);
        add(light.positionMetres - snappedEye, 1 / (light.reachMetres * light.reachMetres),
            light.colour);
    }
    if (count == 0)
        add(glm::normalize(glm::transpose(frame.view.cameraFromWorldRotation) *
                           fabric::Vec3(-0.3, 0.4, 1)),
            0, fabric::Vec3(1));
    const int variant = variantOf(frame.lights);
    if (variant == kWithSpots)
        cones.setIn(program);
    const auto counted = static_cast<std::size_t>(variant);
    program.lightPlaces(std::span(places).first(counted));
    program.lightFalloffs(std::span(falloffs).first(counted));
    program.lightColours(std::span(colours).first(counted));
    program.ambient(static_cast<float>(frame.lights.ambient));
}

}  // namespace

effects::ObjectBlock::Variant variantFor(const FrameState& frame,
                                         const fabric::Mat4& worldFromObject) {
    return {.lights = variantOf(frame.lights),
            .flat = frame.shading == fabric::Shading::Flat,
            .conformal = conformalScale(fabric::Mat3(worldFromObject)) > 0};
}

void setObject(const effects::ObjectBlock& program, const FrameState& frame,
               const fabric::Mat4& worldFromObject, const fabric::Mat4& objectFromLattice) {
    const fabric::Mat3 linear(worldFromObject);
    const double scale = conformalScale(linear);
    const fabric::Mat3 shadingFromWorld =
        scale > 0 ? glm::transpose(linear / scale) : fabric::Mat3(1.0);
    const lod::LatticeView lattice(frame.view, worldFromObject, objectFromLattice);
    program.clipFromLattice(lattice.clipFromLattice);
    program.metresFromLattice(glm::mat3(shadingFromWorld * lattice.metresFromLattice));
    program.cameraLattice(lattice.cameraLattice);
    program.cameraOffsetMetres(glm::vec3(shadingFromWorld * lattice.cameraOffsetMetres));
    program.worldFromNormal(glm::mat3(glm::inverseTranspose(linear)));
    program.columnStep(static_cast<float>(frame.view.step.x));
    program.rowStep(static_cast<float>(frame.view.step.y));
    setLights(program, frame, shadingFromWorld, frame.view.eye - lattice.cameraOffsetMetres);
}

}  // namespace eyrie::draw
