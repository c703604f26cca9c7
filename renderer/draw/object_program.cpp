// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/object_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include "eyrie_shaders.h"
#include "fabric/status.h"
#include "renderer/lod/lattice_view.h"

namespace eyrie::draw {
namespace {

/// The GLSL version, what the variant defines, effects/lighting.glsl, then `fragment`.
std::string fragmentText(std::string_view fragment, Variant variant) {
    return fmt::format(
        "#version 450 core\n#define LIGHTS {}\n#define FLAT {}\n#define CONFORMAL {}\n{}{}",
        variant.lights, variant.flat ? 1 : 0, variant.conformal ? 1 : 0, effects::kLightingGlsl,
        fragment);
}

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

}  // namespace

Variant variantFor(const FrameState& frame, const fabric::Mat4& worldFromObject) {
    return {.lights = std::max(static_cast<int>(frame.scene.lights.size()), 1),
            .flat = frame.shading == fabric::Shading::Flat,
            .conformal = conformalScale(fabric::Mat3(worldFromObject)) > 0};
}

absl::StatusOr<ObjectProgram> ObjectProgram::create(const gl::ShaderSource& vertex,
                                                    const gl::ShaderSource& fragment,
                                                    Variant variant) {
    const std::string text = fragmentText(fragment.text, variant);
    const std::string name = fmt::format("lighting.glsl + {}", fragment.name);
    ASSIGN_OR_RETURN(gl::Program program, gl::Program::create(vertex, {name, text}));
    return ObjectProgram(std::move(program));
}

ObjectProgram::ObjectProgram(gl::Program program)
    : program_(std::move(program)),
      clipFromLattice_(uniform("clipFromLattice")),
      metresFromLattice_(uniform("metresFromLattice")),
      worldFromNormal_(uniform("worldFromNormal")),
      cameraLattice_(uniform("cameraLattice")),
      cameraOffsetMetres_(uniform("cameraOffsetMetres")),
      lightDirections_(uniform("lightDirections")),
      lightColours_(uniform("lightColours")),
      ambient_(uniform("ambient")) {}

void ObjectProgram::use(const FrameState& frame, const fabric::Mat4& worldFromObject,
                        const fabric::Mat4& objectFromLattice) const {
    const fabric::Mat3 linear(worldFromObject);
    const double scale = conformalScale(linear);
    const fabric::Mat3 shadingFromWorld =
        scale > 0 ? glm::transpose(linear / scale) : fabric::Mat3(1.0);
    const lod::LatticeView lattice(frame.view, worldFromObject * objectFromLattice);
    const glm::mat3 metresFromLattice(shadingFromWorld * lattice.metresFromLattice);
    const glm::vec3 cameraOffset(shadingFromWorld * lattice.cameraOffsetMetres);
    const glm::mat3 worldFromNormal(glm::inverseTranspose(linear));
    glUseProgram(program_.id());
    glUniformMatrix4fv(clipFromLattice_, 1, GL_FALSE, glm::value_ptr(lattice.clipFromLattice));
    glUniformMatrix3fv(metresFromLattice_, 1, GL_FALSE, glm::value_ptr(metresFromLattice));
    glUniformMatrix3fv(worldFromNormal_, 1, GL_FALSE, glm::value_ptr(worldFromNormal));
    glUniform3iv(cameraLattice_, 1, glm::value_ptr(lattice.cameraLattice));
    glUniform3fv(cameraOffsetMetres_, 1, glm::value_ptr(cameraOffset));
    setLights(frame, shadingFromWorld);
}

void ObjectProgram::setLights(const FrameState& frame, const fabric::Mat3& shadingFromWorld) const {
    std::array<glm::vec3, fabric::kMaxLights> directions{};
    std::array<glm::vec3, fabric::kMaxLights> colours{};
    int count = 0;
    const auto add = [&](const fabric::Vec3& towardsLight, const fabric::Vec3& colour) {
        const auto at = static_cast<std::size_t>(count++);
        directions[at] = glm::vec3(glm::normalize(shadingFromWorld * towardsLight));
        colours[at] = glm::vec3(colour);
    };
    for (const fabric::DirectionalLight& light : frame.scene.lights)
        add(-light.direction, light.colour);
    if (count == 0)
        add(glm::transpose(frame.view.viewFromWorldRotation) * fabric::Vec3(-0.3, 0.4, 1),
            fabric::Vec3(1));
    glUniform3fv(lightDirections_, count, glm::value_ptr(directions[0]));
    glUniform3fv(lightColours_, count, glm::value_ptr(colours[0]));
    glUniform1f(ambient_, static_cast<float>(frame.scene.ambient));
}

}  // namespace eyrie::draw
