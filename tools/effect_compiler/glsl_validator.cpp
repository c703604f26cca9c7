// SPDX-License-Identifier: Apache-2.0
#include "tools/effect_compiler/glsl_validator.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/wait.h>

#include "fabric/status.h"
#include "renderer/effects/language/glsl_writer.h"
#include "renderer/effects/language/shader_log.h"

namespace eyrie::effects {
namespace {

constexpr std::array<std::pair<StageKind, const char*>, 3> kStageFiles = {
    {{StageKind::Vertex, "stage.vert"},
     {StageKind::Fragment, "stage.frag"},
     {StageKind::Compute, "stage.comp"}}};

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
    std::string write(const char* name, const std::string& text) const {
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

}  // namespace

absl::Status validateGlsl(const Effect& effect, const std::string& validator) {
    const WorkFolder folder;
    for (const ParameterValues& values : allVariants(effect)) {
        std::vector<std::string> files;
        std::string command = fmt::format("{} -l", shellWord(validator));
        for (const auto& [kind, name] : kStageFiles) {
            if (!effect.has(kind))
                continue;
            files.push_back(folder.write(name, stagePreamble(values) + stageText(effect, kind)));
            if (files.back().empty())
                return absl::FailedPreconditionError("cannot write GLSL to a temporary folder");
            command += fmt::format(" {}", shellWord(files.back()));
        }
        ASSIGN_OR_RETURN(const Outcome outcome, runProgram(command + " 2>&1"));
        if (!outcome.succeeded)
            return absl::InvalidArgumentError(
                fmt::format("{}\n{}: the GLSL above is refused{}",
                            namedLog(without(outcome.output, files), sourceFiles(effect)),
                            effect.main().name, values.empty() ? "" : " with " + describe(values)));
    }
    return absl::OkStatus();
}

}  // namespace eyrie::effects
