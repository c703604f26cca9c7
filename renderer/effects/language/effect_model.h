// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace eyrie::effects {

/// Where something stands. `line` and `column` count from 1, columns in bytes.
struct Place {
    std::string file;
    std::size_t line = 1;
    std::size_t column = 1;
};

/// `place` as people and editors read it, before a message: "terrain.effect:12:5: message".
std::string messageAt(const Place& place, std::string_view message);

/// `variant int LIGHTS 1..4;` or `variant bool FLAT;`: what an effect is compiled for. GLSL sees
/// each as a macro, C++ as a member of the effect's Variant. A bool is an int from 0 to 1.
struct Parameter {
    std::string name;
    bool isBool = false;
    int low = 0;
    int high = 1;
    std::string comment;
    Place place;
};

/// `uniform vec3 lightColours[LIGHTS];` or `uniform sampler2D normalMap at 0;`.
struct Uniform {
    std::string type;
    std::string name;
    std::string length;  ///< the parameter that is the array's length; empty: no array
    int unit = -1;       ///< of a sampler
    std::string comment;
    Place place;
};

/// `input uvec2 packedVertex at 0 from uint32 or uint32[2];`: a vertex attribute. Components that
/// the source lacks read as 0. Each attribute has a buffer binding of its own, numbered as it is.
struct Input {
    std::string type;
    std::string name;
    int location = 0;
    std::vector<int> sources;  ///< words of 32 bits a vertex, one for each way to feed it
    std::string comment;
    Place place;
};

/// `pass solid { depth greater; cull none; polygon fill; }`: GL state to draw with. The values are
/// GL's own words in lowerCamelCase.
struct Pass {
    std::string name;
    std::string depth;
    std::string cull;
    std::string polygon;
    std::string comment;
    Place place;
};

enum class StageKind { Vertex, Fragment, Shared, Compute };

/// `stage vertex { GLSL }`. What is shared is part of both the vertex and the fragment stage.
struct Stage {
    StageKind kind = StageKind::Fragment;
    std::string body;
    Place place;      ///< of the statement
    Place bodyPlace;  ///< of the first byte of the body
};

struct Include {
    std::string file;
    Place place;
};

/// One file as it is written: NAME.effect, or NAME.block, which effects include.
struct EffectFile {
    std::string name;
    std::vector<Include> includes;
    std::vector<Parameter> parameters;
    std::vector<Uniform> uniforms;
    std::vector<Input> inputs;
    std::vector<Pass> passes;
    std::vector<Stage> stages;

    bool isBlock() const { return name.ends_with(".block"); }
};

/// The files that make one effect, checked: the blocks in the order in which they are included,
/// then the effect itself.
struct Effect {
    std::vector<EffectFile> files;

    const EffectFile& main() const { return files.back(); }
    /// Whether the effect itself has that stage. It has vertex and fragment, or compute alone.
    bool has(StageKind kind) const;
};

}  // namespace eyrie::effects
