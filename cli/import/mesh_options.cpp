// SPDX-License-Identifier: Apache-2.0
#include "cli/import/mesh_options.h"

#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "cli/import_memory.h"
#include "cli/values.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

absl::StatusOr<std::uint64_t> memoryOf(const MeshImportChoices& choices) {
    if (choices.memory.empty())
        return defaultMeshMemory();
    ASSIGN_OR_RETURN(const std::uint64_t bytes, parseBytes(choices.memory, "--memory"));
    if (bytes < import::kLeastMeshMemory)
        return absl::InvalidArgumentError(
            fmt::format("--memory is {}; the import of a mesh takes at least {}M", choices.memory,
                        import::kLeastMeshMemory >> 20));
    return bytes;
}

}  // namespace

absl::StatusOr<import::MeshImportOptions> importOptions(const MeshImportChoices& choices) {
    constexpr std::string_view kCrease = "crease=";
    import::MeshImportOptions result = choices.how;
    ASSIGN_OR_RETURN(result.memoryBytes, memoryOf(choices));
    if (choices.normals == "auto")
        return result;
    if (choices.normals == "smooth") {
        result.pack.normals = import::NormalSource::Smooth;
        return result;
    }
    if (choices.normals == "file") {
        result.pack.normals = import::NormalSource::File;
        return result;
    }
    const std::string_view degrees(choices.normals);
    const char* const end = degrees.data() + degrees.size();
    result.pack.normals = import::NormalSource::Crease;
    if (degrees.starts_with(kCrease)) {
        const auto [rest, error] =
            std::from_chars(degrees.data() + kCrease.size(), end, result.pack.creaseDegrees);
        if (error == std::errc() && rest == end && result.pack.creaseDegrees >= 0 &&
            result.pack.creaseDegrees <= 180)
            return result;
    }
    return absl::InvalidArgumentError(fmt::format(
        "--normals is '{}'; give auto, smooth, file, or crease= and degrees from 0 to 180, "
        "such as crease=40",
        choices.normals));
}

}  // namespace eyrie::cli
