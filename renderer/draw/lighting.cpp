// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/lighting.h"

#include <array>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include "eyrie_shaders.h"

namespace eyrie::draw {

std::string fragmentSource(std::string_view fragment) {
    std::string source = "#version 450 core\n";
    source += effects::kLightingGlsl;
    source += fragment;
    return source;
}

LightingUniforms::LightingUniforms(const gl::Program& program)
    : lightDirections_(program.uniform("lightDirections")),
      lightColours_(program.uniform("lightColours")),
      ambient_(program.uniform("ambient")) {}

void LightingUniforms::set(const FrameState& frame) const {
    std::array<glm::vec3, fabric::kMaxLights> directions{};
    std::array<glm::vec3, fabric::kMaxLights> colours{};
    for (std::size_t i = 0; i < frame.scene.lights.size(); ++i) {
        directions[i] = glm::vec3(-glm::normalize(frame.scene.lights[i].direction));
        colours[i] = glm::vec3(frame.scene.lights[i].colour);
    }
    if (frame.scene.lights.empty()) {
        const fabric::Mat3 worldFromView = glm::transpose(frame.view.viewFromWorldRotation);
        directions[0] = glm::vec3(glm::normalize(worldFromView * fabric::Vec3(-0.3, 0.4, 1)));
        colours[0] = glm::vec3(1.0F);
    }
    glUniform3fv(lightDirections_, fabric::kMaxLights, glm::value_ptr(directions[0]));
    glUniform3fv(lightColours_, fabric::kMaxLights, glm::value_ptr(colours[0]));
    glUniform1f(ambient_, static_cast<float>(frame.scene.ambient));
}

}  // namespace eyrie::draw
