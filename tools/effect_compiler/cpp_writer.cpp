// SPDX-License-Identifier: Apache-2.0
#include "tools/effect_compiler/cpp_writer.h"

#include <cctype>

#include <fmt/format.h>

#include "renderer/effects/language/effect_check.h"
#include "renderer/effects/language/effect_types.h"
#include "renderer/effects/language/glsl_writer.h"

namespace eyrie::effects {
namespace {

std::string capitalised(std::string name) {
    name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    return name;
}

/// terrain.effect is TerrainEffect, hill_shade.block is HillShadeBlock.
std::string className(std::string_view file) {
    std::string name;
    bool capital = true;
    for (const char c : file) {
        const bool joins = c == '_' || c == '.';
        if (!joins)
            name += capital ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        capital = joins;
    }
    return name;
}

std::string headerName(std::string_view file) {
    const std::size_t dot = file.find('.');
    return fmt::format("effects/{}_{}.h", file.substr(0, dot), file.substr(dot + 1));
}

/// A C++ string literal. Bytes outside ASCII are octal: such an escape ends after three digits.
std::string literal(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\n')
            out += "\\n";
        else if (c == '"' || c == '\\')
            out += fmt::format("\\{}", c);
        else if (byte < 0x20 || byte > 0x7E)
            out += fmt::format("\\{:03o}", byte);
        else
            out += c;
    }
    return out + '"';
}

/// One literal for each line of `text`.
std::string literalLines(std::string_view text, std::string_view indent) {
    std::string out;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        out += fmt::format("\n{}{}", indent, literal(text.substr(0, end)));
        text.remove_prefix(end);
    }
    return out.empty() ? "\"\"" : out;
}

std::string doc(std::string_view comment, std::string_view indent = "    ") {
    return comment.empty() ? "" : fmt::format("{}/// {}\n", indent, comment);
}

/// `bases` are the classes whose parameters come before this one's.
std::string variantStruct(const EffectFile& file, const std::vector<std::string>& bases) {
    if (file.parameters.empty() && bases.size() == 1)
        return fmt::format("    using Variant = {}::Variant;\n", bases[0]);
    std::string inherited;
    std::string body;
    std::string append;
    for (const std::string& base : bases) {
        inherited += fmt::format("{}{}::Variant", inherited.empty() ? " : " : ", ", base);
        append += fmt::format("            {}::Variant::appendTo(values);\n", base);
    }
    for (const Parameter& p : file.parameters) {
        const std::string member = memberName(p);
        if (!p.isBool)
            body += fmt::format("        static constexpr int kMax{} = {};\n", capitalised(member),
                                p.high);
        body += doc(p.comment, "        ");
        body += p.isBool ? fmt::format("        bool {} = false;\n", member)
                         : fmt::format("        int {} = {};\n", member, p.low);
        append += fmt::format("            values.push_back({{\"{}\", {}, {}, {}}});\n", p.name,
                              p.isBool ? member + " ? 1 : 0" : member, p.low, p.high);
    }
    return fmt::format(
        "    /// What a program is compiled for.\n"
        "    struct Variant{} {{\n{}"
        "        auto operator<=>(const Variant&) const = default;\n"
        "        void appendTo([[maybe_unused]] std::vector<VariantValue>& values) const {{\n{}"
        "        }}\n    }};\n",
        inherited, body, append);
}

std::string constants(const EffectFile& file) {
    std::string text;
    for (const Input& input : file.inputs)
        for (const int words : input.sources) {
            const std::string source =
                input.sources.size() == 1 ? "" : fmt::format("FromUint32x{}", words);
            text += doc(input.comment);
            text += fmt::format(
                "    static constexpr gl::VertexInput k{}{}{{.location = {}, "
                ".words = {}}};\n",
                capitalised(input.name), source, input.location, words);
        }
    for (const Pass& pass : file.passes) {
        text += doc(pass.comment);
        text += fmt::format(
            "    static constexpr gl::PassState k{}{{.depthFunction = {},\n"
            "        .culledFace = {}, .polygonMode = {}}};\n",
            capitalised(pass.name), cppOf(depthFunctions(), pass.depth),
            cppOf(culledFaces(), pass.cull), cppOf(polygonModes(), pass.polygon));
    }
    return text.empty() ? text : text + "\n";
}

std::string setter(const Uniform& uniform, std::string_view id) {
    const std::string_view type = cppOf(uniformTypes(), uniform.type);
    if (uniform.unit >= 0)
        return fmt::format(
            "    void {}(const {}& texture) const {{ glBindTextureUnit({}, "
            "texture.id()); }}\n",
            uniform.name, type, uniform.unit);
    const bool isNumber = type == "float" || type == "int";
    const std::string parameter = !uniform.length.empty()
                                      ? fmt::format("std::span<const {}> value", type)
                                  : isNumber ? fmt::format("std::same_as<{}> auto value", type)
                                             : fmt::format("const {}& value", type);
    return fmt::format("    void {}({}) const {{ gl::setUniform({}, {}_, value); }}\n",
                       uniform.name, parameter, id, uniform.name);
}

/// The uniforms of one file in its class. Samplers have a fixed unit and need no location.
struct UniformCode {
    std::string setters;
    std::string locations;     ///< members
    std::string initialisers;  ///< ", name_(program.uniform("name"))" each
};

UniformCode uniformCode(const EffectFile& file, std::string_view id, std::string_view program) {
    UniformCode code;
    for (const Uniform& uniform : file.uniforms) {
        code.setters += doc(uniform.comment) + setter(uniform, id);
        if (uniform.unit >= 0)
            continue;
        code.locations += fmt::format("    GLint {}_;\n", uniform.name);
        code.initialisers +=
            fmt::format(",\n          {0}_({1}.uniform(\"{0}\"))", uniform.name, program);
    }
    return code;
}

std::string builtIn(const Effect& effect) {
    std::string files;
    for (const std::string& file : sourceFiles(effect)) files += literal(file) + ", ";
    std::string list;
    for (const Declaration& d : declarations(effect))
        list += fmt::format("\n                {{{}, {}}},", literal(d.name), literal(d.text));
    std::string stages;
    for (const auto& [name, kind] : {std::pair("vertex", StageKind::Vertex),
                                     {"fragment", StageKind::Fragment},
                                     {"compute", StageKind::Compute}})
        if (const std::string text = stageText(effect, kind); !text.empty())
            stages +=
                fmt::format(",\n            .{} ={}", name, literalLines(text, "                "));
    return fmt::format(
        "    /// The GLSL that was built into the program.\n"
        "    static const EffectSource& builtIn() {{\n"
        "        static const EffectSource source{{\n"
        "            .name = {},\n            .files = {{{}}},\n            .declarations = "
        "{{{}}}{}}};\n"
        "        return source;\n    }}\n",
        literal(effect.main().name), files, list, stages);
}

std::string opening(std::string_view file, std::string_view includes) {
    return fmt::format(
        "// SPDX-License-Identifier: Apache-2.0\n"
        "// Generated from {} by effect_compiler; docs/effects.md says how to use it.\n"
        "#pragma once\n\n#include <compare>\n#include <concepts>\n#include <span>\n"
        "#include <utility>\n#include <vector>\n\n#include <glm/glm.hpp>\n\n{}"
        "#include \"renderer/effects/effect_source.h\"\n#include \"renderer/gl/pass_state.h\"\n"
        "#include \"renderer/gl/vertex_input.h\"\n\nnamespace eyrie::effects {{\n\n",
        file, includes);
}

}  // namespace

std::string blockHeader(const EffectFile& block) {
    const std::string name = className(block.name);
    const UniformCode uniforms = uniformCode(block, "id_", "program");
    std::string text = opening(block.name, "");
    text += fmt::format("/// What effects that include {} share.\nclass {} {{\npublic:\n",
                        block.name, name);
    text += variantStruct(block, {}) + "\n" + constants(block) + uniforms.setters;
    text += fmt::format(
        "\nprotected:\n    explicit {}(const gl::Program& program)\n"
        "        : id_(program.id()){} {{}}\n\nprivate:\n    GLuint id_;\n{}}};\n",
        name, uniforms.initialisers, uniforms.locations);
    return text + "\n}  // namespace eyrie::effects\n";
}

std::string effectHeader(const Effect& effect) {
    const EffectFile& main = effect.main();
    const std::string name = className(main.name);
    std::string includes;
    std::string inherited;
    std::string initialisers;
    std::vector<std::string> bases;
    for (const Include& include : main.includes) {
        bases.push_back(className(include.file));
        includes += fmt::format("#include \"{}\"\n", headerName(include.file));
        inherited += fmt::format("{}public {}", inherited.empty() ? " : " : ", ", bases.back());
        initialisers += fmt::format("{}(program),\n          ", bases.back());
    }
    const UniformCode uniforms = uniformCode(main, "program_.id()", "program_");
    std::string text = opening(main.name, includes);
    text += fmt::format(
        "/// One variant of {}, compiled. Its uniforms may be set whether or not it "
        "is in use.\nclass {}{} {{\npublic:\n",
        main.name, name, inherited);
    text += variantStruct(main, bases) + "\n" + constants(main) + builtIn(effect);
    text += fmt::format(
        "\n    /// Internal, with the driver's log by file and line, when it does not compile.\n"
        "    static absl::StatusOr<{0}> create(const Variant& variant,\n"
        "        const EffectSource& source = builtIn()) {{\n"
        "        std::vector<VariantValue> values;\n        variant.appendTo(values);\n"
        "        absl::StatusOr<gl::Program> program = compile(source, values);\n"
        "        if (!program.ok())\n            return program.status();\n"
        "        return {0}(*std::move(program));\n    }}\n\n"
        "    void use() const {{ program_.use(); }}\n\n{1}"
        "\nprivate:\n    explicit {0}(gl::Program program)\n"
        "        : {2}program_(std::move(program)){3} {{}}\n\n    gl::Program program_;\n{4}}};\n",
        name, uniforms.setters, initialisers, uniforms.initialisers, uniforms.locations);
    return text + "\n}  // namespace eyrie::effects\n";
}

}  // namespace eyrie::effects
