// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "renderer/effects/language/effect_grammar.h"
#include "renderer/effects/language/effect_model.h"

namespace eyrie::effects {

/// One declaration that C++ relies on, in one spelling however the file lays it out, such as
/// "uniform vec3 lightColours[LIGHTS]".
struct Declaration {
    std::string name;
    std::string text;
    Place place;
};

/// All of an effect's parameters, uniforms, inputs and passes, its blocks' first.
std::vector<Declaration> declarations(const Effect& effect);

/// A value of each parameter of an effect: one of the programs it can become.
struct ParameterValue {
    std::string name;
    int value = 0;
};
using ParameterValues = std::vector<ParameterValue>;

/// Every combination of the parameters' values, in a fixed order; one, empty, without parameters.
std::vector<ParameterValues> allVariants(const Effect& effect);

/// "LIGHTS=2 FLAT=0", for messages.
std::string describe(const ParameterValues& values);

/// What GLSL must see before a stage: the version and a macro for each parameter.
std::string stagePreamble(const ParameterValues& values);

/// Compilers number lines with #line L 0: line L % kLinesPerFile of file L / kLinesPerFile of
/// `sourceFiles`. #line's own number for a file stays 0: Mesa 22 reports 0 for any.
inline constexpr std::size_t kLinesPerFile = 2'000'000;
static_assert(kLinesPerFile > kMaxEffectBytes);

/// One stage without its preamble: each file's declarations, then its GLSL, with #line directives.
/// Empty where the effect has no such stage.
std::string stageText(const Effect& effect, StageKind kind);

/// File names in the order in which #line numbers them.
std::vector<std::string> sourceFiles(const Effect& effect);

}  // namespace eyrie::effects
