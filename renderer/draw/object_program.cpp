// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/object_program.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

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
    return fmt::format("#version 450 core\n#define LIGHTS {}\n#define FLAT {}\n{}{}",
                       variant.lights, variant.flat ? 1 : 0, effects::kLightingGlsl, fragment);
}

}  // namespace

Variant variantFor(const FrameState& frame) {
    return {.lights = std::max(static_cast<int>(frame.scene.lights.size()), 1),
            .flat = frame.shading == fabric::Shading::Flat};
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
    const lod::LatticeView lattice(frame.view, worldFromObject * objectFromLattice);
    const glm::mat3 normalMatrix(glm::inverseTranspose(fabric::Mat3(worldFromObject)));
    glUseProgram(program_.id());
    glUniformMatrix4fv(clipFromLattice_, 1, GL_FALSE, glm::value_ptr(lattice.clipFromLattice));
    glUniformMatrix3fv(metresFromLattice_, 1, GL_FALSE, glm::value_ptr(lattice.metresFromLattice));
    glUniformMatrix3fv(worldFromNormal_, 1, GL_FALSE, glm::value_ptr(normalMatrix));
    glUniform3iv(cameraLattice_, 1, glm::value_ptr(lattice.cameraLattice));
    glUniform3fv(cameraOffsetMetres_, 1, glm::value_ptr(lattice.cameraOffsetMetres));
    setLights(frame);
}

void ObjectProgram::setLights(const FrameState& frame) const {
    const std::vector<fabric::DirectionalLight>& lights = frame.scene.lights;
    std::array<glm::vec3, fabric::kMaxLights> directions{};
    std::array<glm::vec3, fabric::kMaxLights> colours{};
    for (std::size_t i = 0; i < lights.size(); ++i) {
        directions[i] = glm::vec3(-glm::normalize(lights[i].direction));
        colours[i] = glm::vec3(lights[i].colour);
    }
    if (lights.empty()) {
        const fabric::Mat3 worldFromView = glm::transpose(frame.view.viewFromWorldRotation);
        directions[0] = glm::vec3(glm::normalize(worldFromView * fabric::Vec3(-0.3, 0.4, 1)));
        colours[0] = glm::vec3(1.0F);
    }
    const int count = variantFor(frame).lights;
    glUniform3fv(lightDirections_, count, glm::value_ptr(directions[0]));
    glUniform3fv(lightColours_, count, glm::value_ptr(colours[0]));
    glUniform1f(ambient_, static_cast<float>(frame.scene.ambient));
}

}  // namespace eyrie::draw
