// SPDX-License-Identifier: Apache-2.0
#include "tools/effect_compiler/glsl_validator.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/wait.h>

#include "fabric/status.h"
#include "renderer/effects/language/glsl_writer.h"
#include "renderer/effects/language/shader_log.h"

namespace eyrie::effects {
namespace {

constexpr std::array<std::pair<StageKind, const char*>, 3> kStageEndings = {
    {{StageKind::Vertex, "vert"}, {StageKind::Fragment, "frag"}, {StageKind::Compute, "comp"}}};

/// A folder for the stages' files that goes with the object.
class WorkFolder {
public:
    WorkFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "eyrie-glsl-XXXXXX").string();
        if (mkdtemp(name.data()) != nullptr)
            path_ = name;
    }
    ~WorkFolder() {
        std::error_code ignored;
        if (!path_.empty())
            std::filesystem::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    /// Writes a file and returns its path; empty when that fails.
    std::string write(const std::string& name, const std::string& text) const {
        const std::string path = (path_ / name).string();
        return !path_.empty() && (std::ofstream(path) << text).flush() ? path : "";
    }

private:
    std::filesystem::path path_;
};

std::string shellWord(const std::string& argument) {
    std::string text = "'";
    for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

/// `log` without the lines on which the validator names the files it was given.
std::string without(std::string log, const std::vector<std::string>& files) {
    for (const std::string& file : files)
        if (const std::size_t at = log.find(file + "\n"); at != std::string::npos)
            log.erase(at, file.size() + 1);
    return log;
}

struct Outcome {
    bool succeeded = false;
    std::string output;
};

absl::StatusOr<Outcome> runProgram(const std::string& command) {
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr)
        return absl::FailedPreconditionError(fmt::format("{}: cannot be run", command));
    Outcome outcome;
    std::array<char, 4096> block{};
    while (const std::size_t size = std::fread(block.data(), 1, block.size(), pipe))
        outcome.output.append(block.data(), size);
    const int status = pclose(pipe);
    outcome.succeeded = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) >= 126)  // the shell found no program to run
        return absl::FailedPreconditionError(outcome.output);
    return outcome;
}

/// The stages of a variant as files of `folder`, which begin with `number`.
absl::StatusOr<std::vector<std::string>> writeStages(const Effect& effect,
                                                     const ParameterValues& values,
                                                     std::size_t number, const WorkFolder& folder) {
    std::vector<std::string> files;
    for (const auto& [kind, ending] : kStageEndings) {
        if (!effect.has(kind))
            continue;
        files.push_back(folder.write(fmt::format("{}.{}", number, ending),
                                     stagePreamble(values) + stageText(effect, kind)));
        if (files.back().empty())
            return absl::FailedPreconditionError("cannot write GLSL to a temporary folder");
    }
    return files;
}

absl::StatusOr<Outcome> runValidator(std::string command, const std::vector<std::string>& files) {
    for (const std::string& file : files) command += fmt::format(" {}", shellWord(file));
    return runProgram(command + " 2>&1");
}

/// One variant by itself, its stages linked.
absl::Status link(const Effect& effect, const ParameterValues& values,
                  const std::vector<std::string>& files, const std::string& validator) {
    ASSIGN_OR_RETURN(const Outcome outcome,
                     runValidator(fmt::format("{} -l", shellWord(validator)), files));
    if (outcome.succeeded)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("{}\n{}: the GLSL above is refused{}",
                    namedLog(without(outcome.output, files), sourceFiles(effect)),
                    effect.main().name, values.empty() ? "" : " with " + describe(values)));
}

}  // namespace

absl::Status validateGlsl(const Effect& effect, const std::string& validator) {
    const WorkFolder folder;
    const auto variants = allVariants(effect);
    std::vector<std::vector<std::string>> files;
    std::vector<std::string> all;
    for (const ParameterValues& values : variants) {
        ASSIGN_OR_RETURN(std::vector<std::string> stages,
                         writeStages(effect, values, files.size(), folder));
        all.insert(all.end(), stages.begin(), stages.end());
        files.push_back(std::move(stages));
    }
    // At once: starting the validator takes a hundred times as long as a stage does.
    ASSIGN_OR_RETURN(const Outcome outcome, runValidator(shellWord(validator), all));
    std::set<std::pair<std::string, int>> linked;
    for (std::size_t i = 0; i < files.size(); ++i) {
        bool hasNew = i == 0;
        for (const auto& [parameter, value] : variants[i])
            hasNew = linked.emplace(parameter, value).second || hasNew;
        if (hasNew || !outcome.succeeded)
            RETURN_IF_ERROR(link(effect, variants[i], files[i], validator));
    }
    return outcome.succeeded ? absl::OkStatus() : absl::InvalidArgumentError(outcome.output);
}

}  // namespace eyrie::effects
