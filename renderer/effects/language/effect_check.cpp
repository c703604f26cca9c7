// SPDX-License-Identifier: Apache-2.0
#include "renderer/effects/language/effect_check.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/effects/language/cpp_words.h"
#include "renderer/effects/language/effect_types.h"

namespace eyrie::effects {
namespace {

constexpr int kMaxUnitsOrLocations = 16;  // what OpenGL 4.5 promises of either

absl::Status errorAt(const Place& place, std::string_view message) {
    return absl::InvalidArgumentError(messageAt(place, message));
}

absl::Status checkWord(std::span<const Word> words, std::string_view word, std::string_view what,
                       const Place& place) {
    if (!cppOf(words, word).empty())
        return absl::OkStatus();
    return errorAt(place, fmt::format("{} is '{}'; it must be {}", what, word, listed(words)));
}

absl::Status checkParameter(const Parameter& parameter) {
    if (parameter.name.starts_with("GL_") || parameter.name.find("__") != std::string::npos)
        return errorAt(parameter.place,
                       fmt::format("GLSL keeps names like {} for itself", parameter.name));
    if (parameter.low <= parameter.high)
        return absl::OkStatus();
    return errorAt(parameter.place,
                   fmt::format("{} ranges from {} down to {}; the lower comes first",
                               parameter.name, parameter.low, parameter.high));
}

absl::Status checkUniform(const Uniform& uniform) {
    const std::string what = "the type of uniform " + uniform.name;
    RETURN_IF_ERROR(checkWord(uniformTypes(), uniform.type, what, uniform.place));
    const bool isSampler = uniform.type == "sampler2D";
    if (isSampler && !uniform.length.empty())
        return errorAt(uniform.place, fmt::format("{} is a sampler and an array; give each sampler "
                                                  "a name of its own",
                                                  uniform.name));
    if (isSampler && uniform.unit < 0)
        return errorAt(uniform.place, fmt::format("{} is a sampler; say which texture unit it has, "
                                                  "as in 'at 0'",
                                                  uniform.name));
    if (!isSampler && uniform.unit >= 0)
        return errorAt(uniform.place,
                       fmt::format("{} is no sampler and has no texture unit", uniform.name));
    if (uniform.unit >= kMaxUnitsOrLocations)
        return errorAt(uniform.place,
                       fmt::format("{} has texture unit {}; it must be from 0 to {}", uniform.name,
                                   uniform.unit, kMaxUnitsOrLocations - 1));
    return absl::OkStatus();
}

absl::Status checkInput(const Input& input) {
    const std::string what = "the type of input " + input.name;
    RETURN_IF_ERROR(checkWord(inputTypes(), input.type, what, input.place));
    if (input.location >= kMaxUnitsOrLocations)
        return errorAt(input.place,
                       fmt::format("{} has location {}; it must be from 0 to {}", input.name,
                                   input.location, kMaxUnitsOrLocations - 1));
    const int components = cppOf(inputTypes(), input.type)[0] - '0';
    std::set<int> seen;
    for (const int words : input.sources) {
        if (words < 1 || words > components)
            return errorAt(input.place,
                           fmt::format("{} is fed from uint32[{}]; a {} takes from 1 to {} words",
                                       input.name, words, input.type, components));
        if (!seen.insert(words).second)
            return errorAt(input.place, fmt::format("{} names the same source twice", input.name));
    }
    return absl::OkStatus();
}

absl::Status checkPass(const Pass& pass) {
    const auto check = [&](std::span<const Word> words, std::string_view state,
                           std::string_view value) {
        if (value.empty())
            return errorAt(pass.place, fmt::format("pass {} does not set {}", pass.name, state));
        return checkWord(words, value, fmt::format("{} of pass {}", state, pass.name), pass.place);
    };
    RETURN_IF_ERROR(check(depthFunctions(), "depth", pass.depth));
    RETURN_IF_ERROR(check(culledFaces(), "cull", pass.cull));
    return check(polygonModes(), "polygon", pass.polygon);
}

const char* nameOf(StageKind kind) {
    return kind == StageKind::Vertex     ? "vertex"
           : kind == StageKind::Fragment ? "fragment"
           : kind == StageKind::Shared   ? "shared"
                                         : "compute";
}

bool renumbersLines(std::string_view line) {
    constexpr std::string_view kBlanks = " \t\r";
    constexpr std::string_view kDirective = "line";
    const auto skipBlanks = [&] {
        line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    };
    skipBlanks();
    if (!line.starts_with('#'))
        return false;
    line.remove_prefix(1);
    skipBlanks();
    return line.starts_with(kDirective);
}

/// The compiler's errors come back to files and lines by directives that are put in later.
absl::Status checkLineNumbers(const Stage& stage) {
    Place place = stage.bodyPlace;
    std::string_view left = stage.body;
    while (!left.empty()) {
        const std::string_view line = left.substr(0, left.find('\n'));
        if (renumbersLines(line))
            return errorAt(place, "#line would have errors name other lines; leave it out");
        left.remove_prefix(std::min(line.size() + 1, left.size()));
        ++place.line;
        place.column = 1;
    }
    return absl::OkStatus();
}

/// What holds in each file by itself.
absl::Status checkFile(const EffectFile& file) {
    for (const Parameter& parameter : file.parameters) RETURN_IF_ERROR(checkParameter(parameter));
    for (const Uniform& uniform : file.uniforms) RETURN_IF_ERROR(checkUniform(uniform));
    for (const Input& input : file.inputs) RETURN_IF_ERROR(checkInput(input));
    for (const Pass& pass : file.passes) RETURN_IF_ERROR(checkPass(pass));
    for (const Stage& stage : file.stages) RETURN_IF_ERROR(checkLineNumbers(stage));
    for (std::size_t i = 0; i < file.stages.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (file.stages[i].kind == file.stages[j].kind)
                return errorAt(file.stages[i].place,
                               fmt::format("a second {} stage; the first is in line {}",
                                           nameOf(file.stages[i].kind), file.stages[j].place.line));
    return absl::OkStatus();
}

/// Every name of an effect and where it was first used.
class Names {
public:
    absl::Status add(const std::string& name, const Place& place) {
        if (isTakenInCpp(name))
            return errorAt(
                place, fmt::format("'{}' means something else in C++; choose another name", name));
        const auto [first, isNew] = places_.emplace(name, place);
        if (isNew)
            return absl::OkStatus();
        return errorAt(place, fmt::format("'{}' is already the name of something else, in {}:{}",
                                          name, first->second.file, first->second.line));
    }

private:
    std::map<std::string, Place> places_;
};

absl::Status addNames(const EffectFile& file, Names& names) {
    for (const Parameter& p : file.parameters) RETURN_IF_ERROR(names.add(memberName(p), p.place));
    for (const Uniform& uniform : file.uniforms)
        RETURN_IF_ERROR(names.add(uniform.name, uniform.place));
    for (const Input& input : file.inputs) RETURN_IF_ERROR(names.add(input.name, input.place));
    for (const Pass& pass : file.passes) RETURN_IF_ERROR(names.add(pass.name, pass.place));
    return absl::OkStatus();
}

/// Array lengths are parameters of the files read so far.
absl::Status checkLengths(const EffectFile& file, std::vector<Parameter>& parameters) {
    parameters.insert(parameters.end(), file.parameters.begin(), file.parameters.end());
    for (const Uniform& uniform : file.uniforms) {
        if (uniform.length.empty())
            continue;
        const auto length = std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) {
            return p.name == uniform.length && !p.isBool && p.low > 0;
        });
        if (length == parameters.end())
            return errorAt(uniform.place,
                           fmt::format("the length of {} is {}, which is no 'variant int' of 1 or "
                                       "more declared here or in a block that is included",
                                       uniform.name, uniform.length));
    }
    return absl::OkStatus();
}

absl::Status checkVariants(const std::vector<Parameter>& parameters) {
    std::int64_t variants = 1;
    for (const Parameter& parameter : parameters) {
        variants *= parameter.high - parameter.low + 1;
        if (variants > kMaxVariants)
            return errorAt(parameter.place,
                           fmt::format("{} makes more than {} variants of an effect",
                                       parameter.name, kMaxVariants));
    }
    return absl::OkStatus();
}

absl::Status checkTogether(const std::vector<EffectFile>& files) {
    Names names;
    std::vector<Parameter> parameters;
    for (const EffectFile& file : files) {
        RETURN_IF_ERROR(checkFile(file));
        RETURN_IF_ERROR(addNames(file, names));
        RETURN_IF_ERROR(checkLengths(file, parameters));
    }
    std::set<int> places;
    for (const Input& input : files.back().inputs)
        if (!places.insert(input.location).second)
            return errorAt(input.place,
                           fmt::format("location {} is already another input's", input.location));
    std::set<int> units;
    for (const EffectFile& file : files)
        for (const Uniform& uniform : file.uniforms)
            if (uniform.unit >= 0 && !units.insert(uniform.unit).second)
                return errorAt(uniform.place, fmt::format("texture unit {} is already another "
                                                          "sampler's",
                                                          uniform.unit));
    return checkVariants(parameters);
}

/// An effect with a compute stage draws nothing: it has nothing else that drawing needs.
absl::Status checkComputes(const Effect& effect) {
    for (const Stage& stage : effect.main().stages)
        if (stage.kind != StageKind::Compute)
            return errorAt(stage.place, fmt::format("a {} stage beside a compute stage; an effect "
                                                    "draws or computes",
                                                    nameOf(stage.kind)));
    for (const Input& input : effect.main().inputs)
        return errorAt(input.place, fmt::format("{} is an input of an effect that computes; its "
                                                "GLSL reads buffers instead",
                                                input.name));
    for (const Pass& pass : effect.main().passes)
        return errorAt(
            pass.place,
            fmt::format("pass {} is of an effect that computes and draws nothing", pass.name));
    return absl::OkStatus();
}

}  // namespace

bool Effect::has(StageKind kind) const {
    return std::any_of(main().stages.begin(), main().stages.end(),
                       [&](const Stage& stage) { return stage.kind == kind; });
}

bool isEffectFileName(std::string_view name) {
    const std::size_t dot = name.find('.');
    const std::string_view stem = name.substr(0, dot);
    const bool isStem = !stem.empty() && stem.size() <= 64 && stem[0] >= 'a' && stem[0] <= 'z' &&
                        std::all_of(stem.begin(), stem.end(), [](char c) {
                            return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
                        });
    return isStem && dot != std::string_view::npos &&
           (name.substr(dot) == ".effect" || name.substr(dot) == ".block");
}

absl::Status checkBlock(const EffectFile& block) {
    if (!block.includes.empty())
        return errorAt(block.includes[0].place, "a block includes nothing; only effects do");
    if (!block.inputs.empty())
        return errorAt(block.inputs[0].place, "a block has no inputs; each effect has its own");
    return checkTogether({block});
}

absl::Status checkEffect(const Effect& effect) {
    for (std::size_t i = 0; i + 1 < effect.files.size(); ++i)
        RETURN_IF_ERROR(checkBlock(effect.files[i]));
    RETURN_IF_ERROR(checkTogether(effect.files));
    if (effect.has(StageKind::Compute))
        return checkComputes(effect);
    for (const StageKind kind : {StageKind::Vertex, StageKind::Fragment})
        if (!effect.has(kind))
            return errorAt({effect.main().name},
                           fmt::format("the effect has no {} stage", nameOf(kind)));
    return absl::OkStatus();
}

std::string memberName(const Parameter& parameter) {
    std::string name;
    bool capital = false;
    for (const char c : parameter.name) {
        if (c == '_') {
            capital = true;
            continue;
        }
        name += capital ? c : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        capital = false;
    }
    return name;
}

}  // namespace eyrie::effects
