// SPDX-License-Identifier: Apache-2.0
// effect_compiler FILE.effect|FILE.block HEADER [VALIDATOR]
//
// Writes the typed C++ header of an effect file, and HEADER.d, the files it depends on, for the
// build. VALIDATOR is glslangValidator; without it the GLSL is not looked at. Exit status: 0 done,
// 1 cannot write, 2 the effect is wrong.
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/effects/language/effect_loader.h"
#include "renderer/effects/language/glsl_writer.h"
#include "tools/effect_compiler/cpp_writer.h"
#include "tools/effect_compiler/glsl_validator.h"

namespace {

using namespace eyrie::effects;

struct Compiled {
    std::string header;
    std::vector<std::string> files;
};

absl::StatusOr<Compiled> compileFile(const std::filesystem::path& path,
                                     const std::string& validator) {
    const ReadEffectFile read = effectFolder(path.parent_path());
    const std::string name = path.filename().string();
    if (path.extension() == ".block") {
        ASSIGN_OR_RETURN(const EffectFile block, loadBlock(name, read));
        return Compiled{blockHeader(block), {name}};
    }
    ASSIGN_OR_RETURN(const Effect effect, loadEffect(name, read));
    if (!validator.empty())
        RETURN_IF_ERROR(validateGlsl(effect, validator));
    return Compiled{effectHeader(effect), sourceFiles(effect)};
}

/// As make and Ninja read file names.
std::string escaped(const std::string& path) {
    std::string text;
    for (const char c : path) {
        if (c == ' ')
            text += '\\';
        text += c;
    }
    return text;
}

bool write(const std::filesystem::path& path, const std::string& text) {
    std::error_code ignored;
    std::filesystem::create_directories(path.parent_path(), ignored);
    if ((std::ofstream(path) << text).flush())
        return true;
    fmt::print(stderr, "{}: cannot be written\n", path.string());
    return false;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3 && argc != 4) {
        fmt::print(stderr, "usage: effect_compiler FILE.effect|FILE.block HEADER [VALIDATOR]\n");
        return 2;
    }
    const std::filesystem::path path = argv[1];
    const std::string header = argv[2];
    const absl::StatusOr<Compiled> compiled = compileFile(path, argc == 4 ? argv[3] : "");
    if (!compiled.ok()) {
        const auto message = compiled.status().message();
        fmt::print(stderr, "{}\n", std::string_view(message.data(), message.size()));
        return 2;
    }
    std::string dependencies = fmt::format("{}:", escaped(header));
    for (const std::string& file : compiled->files)
        dependencies += fmt::format(" {}", escaped((path.parent_path() / file).string()));
    return write(header, compiled->header) && write(header + ".d", dependencies + "\n") ? 0 : 1;
}
