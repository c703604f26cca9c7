// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/glsl_writer.h"

#include <fmt/format.h>

namespace eyrie::effects {
namespace {

std::string declarationText(const Parameter& parameter) {
    if (parameter.isBool)
        return fmt::format("variant bool {}", parameter.name);
    return fmt::format("variant int {} {}..{}", parameter.name, parameter.low, parameter.high);
}

std::string typedName(const Uniform& uniform) {
    const std::string length = uniform.length.empty() ? "" : fmt::format("[{}]", uniform.length);
    return fmt::format("{} {}{}", uniform.type, uniform.name, length);
}

std::string declarationText(const Uniform& uniform) {
    const std::string unit = uniform.unit < 0 ? "" : fmt::format(" at {}", uniform.unit);
    return fmt::format("uniform {}{}", typedName(uniform), unit);
}

std::string declarationText(const Input& input) {
    std::string sources;
    for (const int words : input.sources)
        sources += fmt::format("{} uint32[{}]", sources.empty() ? "from" : " or", words);
    return fmt::format("input {} {} at {} {}", input.type, input.name, input.location, sources);
}

std::string declarationText(const Pass& pass) {
    return fmt::format("pass {} {{ depth {}; cull {}; polygon {}; }}", pass.name, pass.depth,
                       pass.cull, pass.polygon);
}

template <typename Statements>
void append(std::vector<Declaration>& list, const Statements& statements) {
    for (const auto& statement : statements)
        list.push_back({statement.name, declarationText(statement), statement.place});
}

/// The next line of GLSL is line `line` of file `file`.
std::string lineDirective(std::size_t line, std::size_t file) {
    return fmt::format("#line {} 0\n", file * kLinesPerFile + line);
}

std::string glslOf(const Uniform& uniform) {
    const std::string unit =
        uniform.unit < 0 ? "" : fmt::format("layout(binding = {}) ", uniform.unit);
    return fmt::format("{}uniform {};\n", unit, typedName(uniform));
}

}  // namespace

std::vector<Declaration> declarations(const Effect& effect) {
    std::vector<Declaration> list;
    for (const EffectFile& file : effect.files) {
        append(list, file.parameters);
        append(list, file.uniforms);
        append(list, file.inputs);
        append(list, file.passes);
    }
    return list;
}

std::vector<ParameterValues> allVariants(const Effect& effect) {
    std::vector<ParameterValues> variants{{}};
    for (const EffectFile& file : effect.files)
        for (const Parameter& parameter : file.parameters) {
            std::vector<ParameterValues> longer;
            for (const ParameterValues& values : variants)
                for (int value = parameter.low; value <= parameter.high; ++value) {
                    longer.push_back(values);
                    longer.back().push_back({parameter.name, value});
                }
            variants = std::move(longer);
        }
    return variants;
}

std::string describe(const ParameterValues& values) {
    std::string text;
    for (const ParameterValue& parameter : values)
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", parameter.name, parameter.value);
    return text;
}

std::string stagePreamble(const ParameterValues& values) {
    std::string text = "#version 450 core\n";
    for (const ParameterValue& parameter : values)
        text += fmt::format("#define {} {}\n", parameter.name, parameter.value);
    return text;
}

std::string stageText(const Effect& effect, StageKind kind) {
    std::string text;
    if (!effect.has(kind))
        return text;
    for (std::size_t i = 0; i < effect.files.size(); ++i) {
        const EffectFile& file = effect.files[i];
        if (kind == StageKind::Vertex)
            for (const Input& input : file.inputs)
                text += lineDirective(input.place.line, i) +
                        fmt::format("layout(location = {}) in {} {};\n", input.location, input.type,
                                    input.name);
        for (const Uniform& uniform : file.uniforms)
            text += lineDirective(uniform.place.line, i) + glslOf(uniform);
        for (const Stage& stage : file.stages)
            if (stage.kind == kind ||
                (stage.kind == StageKind::Shared && kind != StageKind::Compute))
                text += lineDirective(stage.bodyPlace.line, i) + stage.body + "\n";
    }
    return text;
}

std::vector<std::string> sourceFiles(const Effect& effect) {
    std::vector<std::string> names;
    for (const EffectFile& file : effect.files) names.push_back(file.name);
    return names;
}

}  // namespace eyrie::effects
