// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/effect_types.h"

#include <algorithm>
#include <array>

namespace eyrie::effects {

std::span<const Word> uniformTypes() {
    static constexpr std::array words{
        Word{"float", "float"},      Word{"int", "int"},
        Word{"vec3", "glm::vec3"},   Word{"ivec2", "glm::ivec2"},
        Word{"ivec3", "glm::ivec3"}, Word{"mat3", "glm::mat3"},
        Word{"mat4", "glm::mat4"},   Word{"sampler2D", "gl::Texture2D"},
    };
    return words;
}

std::span<const Word> inputTypes() {
    static constexpr std::array words{Word{"uint", "1"}, Word{"uvec2", "2"}, Word{"uvec3", "3"},
                                      Word{"uvec4", "4"}};
    return words;
}

std::span<const Word> depthFunctions() {
    static constexpr std::array words{
        Word{"less", "GL_LESS"},           Word{"lessEqual", "GL_LEQUAL"},
        Word{"equal", "GL_EQUAL"},         Word{"greater", "GL_GREATER"},
        Word{"greaterEqual", "GL_GEQUAL"}, Word{"always", "GL_ALWAYS"},
    };
    return words;
}

std::span<const Word> culledFaces() {
    static constexpr std::array words{Word{"none", "GL_NONE"}, Word{"back", "GL_BACK"},
                                      Word{"front", "GL_FRONT"}};
    return words;
}

std::span<const Word> polygonModes() {
    static constexpr std::array words{Word{"fill", "GL_FILL"}, Word{"line", "GL_LINE"}};
    return words;
}

std::string_view cppOf(std::span<const Word> words, std::string_view word) {
    const auto found =
        std::find_if(words.begin(), words.end(), [&](const Word& w) { return w.effect == word; });
    return found == words.end() ? std::string_view() : found->cpp;
}

std::string listed(std::span<const Word> words) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0)
            list += i + 1 == words.size() ? " or " : ", ";
        list += words[i].effect;
    }
    return list;
}

}  // namespace eyrie::effects
