// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/effect_source.h"

#include <fmt/format.h>

#include "renderer/effects/language/glsl_writer.h"
#include "renderer/effects/language/shader_log.h"

namespace eyrie::effects {
namespace {

/// `of` names the variant in messages.
absl::StatusOr<gl::Program> link(const EffectSource& source, const std::string& preamble,
                                 const std::string& of) {
    const auto nameOf = [&](const char* stage) {
        return fmt::format("{}, {} stage{}", source.name, stage, of);
    };
    if (!source.compute.empty())
        return gl::Program::create({nameOf("compute"), preamble + source.compute});
    return gl::Program::create({nameOf("vertex"), preamble + source.vertex},
                               {nameOf("fragment"), preamble + source.fragment});
}

}  // namespace

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
    absl::StatusOr<gl::Program> program = link(source, preamble, of);
    if (program.ok())
        return program;
    const auto message = program.status().message();
    return absl::InternalError(
        namedLog(std::string_view(message.data(), message.size()), source.files));
}

}  // namespace eyrie::effects
