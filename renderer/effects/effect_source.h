// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/gl/program.h"

namespace eyrie::effects {

/// What C++ was built to know of an effect, one uniform, input, parameter or pass each; `text` is
/// in the one spelling of language/glsl_writer.h.
struct BuiltDeclaration {
    std::string name;
    std::string text;
};

/// An effect's GLSL: what the build put into the program, or what a folder holds at run time.
struct EffectSource {
    std::string name;                ///< "terrain.effect"
    std::vector<std::string> files;  ///< by their number in line numbers: language/glsl_writer.h
    std::vector<BuiltDeclaration> declarations;
    std::string vertex = {};  ///< without version and parameters, as are the others
    std::string fragment = {};
    std::string compute = {};  ///< empty: the effect draws; otherwise the other two are
};

/// The value that a variant gives to a parameter, and the range that the effect file allows.
struct VariantValue {
    std::string_view name;
    int value = 0;
    int low = 0;
    int high = 0;
};

/// Compiles and links one variant. Errors: InvalidArgument (a value out of its range), and Internal
/// with the driver's log, each line of it beginning with the effect file and line it is about.
absl::StatusOr<gl::Program> compile(const EffectSource& source,
                                    std::span<const VariantValue> variant);

}  // namespace eyrie::effects
