// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/effect_source.h"

#include <fmt/format.h>

#include "renderer/effects/language/glsl_writer.h"
#include "renderer/effects/language/shader_log.h"

namespace eyrie::effects {

absl::StatusOr<gl::Program> compile(const EffectSource& source,
                                    std::span<const VariantValue> variant) {
    ParameterValues values;
    for (const VariantValue& parameter : variant) {
        if (parameter.value < parameter.low || parameter.value > parameter.high)
            return absl::InvalidArgumentError(
                fmt::format("{}: {} is {}; it must be from {} to {}", source.name, parameter.name,
                            parameter.value, parameter.low, parameter.high));
        values.push_back({std::string(parameter.name), parameter.value});
    }
    const std::string preamble = stagePreamble(values);
    const std::string of = values.empty() ? "" : " with " + describe(values);
    const std::string vertexName = fmt::format("{}, vertex stage{}", source.name, of);
    const std::string fragmentName = fmt::format("{}, fragment stage{}", source.name, of);
    const std::string vertexText = preamble + source.vertex;
    const std::string fragmentText = preamble + source.fragment;
    absl::StatusOr<gl::Program> program =
        gl::Program::create({vertexName, vertexText}, {fragmentName, fragmentText});
    if (program.ok())
        return program;
    const auto message = program.status().message();
    return absl::InternalError(
        namedLog(std::string_view(message.data(), message.size()), source.files));
}

}  // namespace eyrie::effects
