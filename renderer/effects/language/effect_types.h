// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace eyrie::effects {

/// A word of effect files and what stands for it in C++.
struct Word {
    std::string_view effect;
    std::string_view cpp;
};

/// GLSL types of uniforms, and what C++ sets them with. To add one, add a row here and an overload
/// of gl::Program::set.
std::span<const Word> uniformTypes();
/// GLSL types of vertex attributes, and their number of components.
std::span<const Word> inputTypes();
/// The values of a pass's state, and the GL constants they name.
std::span<const Word> depthFunctions();
std::span<const Word> culledFaces();
std::span<const Word> polygonModes();

/// The C++ of `word`; empty when `words` lacks it.
std::string_view cppOf(std::span<const Word> words, std::string_view word);
/// "a, b or c", for messages.
std::string listed(std::span<const Word> words);

}  // namespace eyrie::effects
