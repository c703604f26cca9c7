// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/lighting.h"

#include <vector>

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
    : lightCount_(program.uniform("lightCount")),
      lightDirections_(program.uniform("lightDirections")),
      lightColours_(program.uniform("lightColours")),
      ambient_(program.uniform("ambient")) {}

void LightingUniforms::set(const FrameState& frame) const {
    std::vector<glm::vec3> directions;
    std::vector<glm::vec3> colours;
    for (const fabric::DirectionalLight& light : frame.scene.lights) {
        directions.emplace_back(-glm::normalize(light.direction));
        colours.emplace_back(light.colour);
    }
    if (directions.empty()) {
        const fabric::Mat3 worldFromView = glm::transpose(frame.view.viewFromWorldRotation);
        directions.emplace_back(glm::normalize(worldFromView * fabric::Vec3(-0.3, 0.4, 1)));
        colours.emplace_back(1.0F);
    }
    glUniform1i(lightCount_, static_cast<GLint>(directions.size()));
    glUniform3fv(lightDirections_, static_cast<GLsizei>(directions.size()),
                 glm::value_ptr(directions.front()));
    glUniform3fv(lightColours_, static_cast<GLsizei>(colours.size()),
                 glm::value_ptr(colours.front()));
    glUniform1f(ambient_, static_cast<float>(frame.scene.ambient));
}

}  // namespace eyrie::draw
