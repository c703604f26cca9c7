// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/import/mesh_options.h"
#include "cli/import/mesh_report.h"
#include "cli/log.h"
#include "cli/output_reader.h"
#include "cli/progress_bar.h"
#include "cli/several_sources.h"
#include "cli/source_record.h"
#include "cli/stop_signal.h"
#include "cli/tune_mesh.h"
#include "fabric/status.h"
#include "renderer/import/companion_folder.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/output_file.h"

namespace eyrie::cli {
namespace {

absl::StatusOr<import::MeshImportReport> importMeshTo(const std::string& path,
                                                      const MeshImportChoices& choices,
                                                      const import::MeshImportOptions& how,
                                                      const std::stop_token& stop) {
    ProgressBar bar(titleOf(choices.sources), megabytesOf(choices.sources), "MB",
                    progressStyle(choices));
    return import::importMesh(choices.sources, path, how, {bar.callback(), stop});
}

absl::StatusOr<MeshTuning> importTuned(const MeshImportChoices& choices,
                                       const import::MeshImportOptions& how,
                                       const std::stop_token& stop) {
    RETURN_IF_ERROR(mesh::OutputFile::check(choices.out));
    ASSIGN_OR_RETURN(const bench::NamedFlight flight, bench::NamedFlight::read(choices.flight));
    ProgressBar bar(choices.out, 0, "", progressStyle(choices));
    return tuneMesh(
        choices.out, flight,
        [&](std::uint32_t leafTriangles, const std::string& path) {
            import::MeshImportOptions each = how;
            each.leafTriangles = leafTriangles;
            return importMeshTo(path, choices, each, stop);
        },
        bar.callback(), stop);
}

absl::Status importMesh(const MeshImportChoices& choices) {
    StopSignal stop;
    RETURN_IF_ERROR(checkEnding(choices, ".eym"));
    RETURN_IF_ERROR(fabric::withContext(import::keepCompanionsBelow(choices.within), "--within"));
    ASSIGN_OR_RETURN(const import::MeshImportOptions how, importOptions(choices));
    ASSIGN_OR_RETURN(const OutputReader reader, OutputReader::await(choices.out, stop.token()));
    MeshTuning tuning;
    import::MeshImportReport made;
    if (choices.flight.empty()) {
        ASSIGN_OR_RETURN(made, importMeshTo(choices.out, choices, how, stop.token()));
    } else {
        ASSIGN_OR_RETURN(tuning, importTuned(choices, how, stop.token()));
        made = tuning.tried[tuning.best].report;
    }
    RETURN_IF_ERROR(recordSources(choices.out, choices.sources));
    if (choices.json) {
        printJson(choices, made, tuning);
    } else if (!choices.quiet) {
        if (!tuning.tried.empty())
            tell(table(tuning));
        printText(choices, made);
    }
    return absl::OkStatus();
}

}  // namespace

void addImportMesh(CLI::App& parent, Run& run) {
    auto choices = std::make_shared<MeshImportChoices>();
    CLI::App* command = parent.add_subcommand("mesh", "A polygon mesh to .eym");
    command
        ->add_option(
            "sources", choices->sources,
            fmt::format("Mesh files, as many as you like: they become one mesh. Read are {}",
                        import::meshSourceEndings()))
        ->type_name("FILE")
        ->required();
    command
        ->add_option("--normals", choices->normals,
                     "auto: as file, but smooth for PLY and STL; smooth: means around vertices; "
                     "crease=DEGREES: sharper edges stay sharp; file: the source's own, smooth "
                     "where it has none")
        ->type_name("WHICH")
        ->capture_default_str();
    command->add_flag("--orient", choices->how.pack.orients,
                      "Turn faces so that neighbours wind the same way, closed surfaces outward");
    CLI::Option* const leaf =
        command
            ->add_option("--leaf", choices->how.leafTriangles,
                         "Triangles that are drawn, or left out as hidden, at once at most")
            ->check(CLI::Range(std::uint32_t{1}, mesh::kMaxLeafVertices))
            ->capture_default_str();
    command
        ->add_option("--tune", choices->flight,
                     "Choose --leaf by measuring on this machine: import with 4096, 8192, 16384 "
                     "and 32768, play a flight (as for `eyrie bench`) over each, keep the fastest. "
                     "Smaller leaves are drawn together, 8192 triangles at a time")
        ->type_name("NAME|FILE")
        ->excludes(leaf);
    addCommonOptions(*command, *choices);
    command
        ->add_option(
            "--bits", choices->how.pack.latticeBits,
            "Bits of a coordinate: positions are rounded to a power of two, of which the "
            "longest side has 2^(bits-1) or more. Fewer make a smaller file; what they "
            "round is in the error that is promised, but sheets that touch without sharing "
            "points may then gape")
        ->check(CLI::Range(mesh::kMinLatticeBits, mesh::kLatticeBits))
        ->capture_default_str();
    command->add_flag(
        "--raw", choices->how.isRaw,
        "Leave pages uncoded: the file is three times as large, and nothing is decoded");
    command->add_flag("--lossless", choices->how.pack.keepsExact,
                      "Keep the source's own positions, bit for bit, beside those that are drawn");
    command
        ->add_option("--memory", choices->memory,
                     "About as much is used; half of what there is otherwise. A PLY mesh that "
                     "would take more is imported part by part; see below")
        ->type_name("BYTES");
    command
        ->add_option("--within", choices->within,
                     "Read nothing that sources name, such as material files, buffers and images, "
                     "but what lies in this folder or below it: the rest counts as missing. For "
                     "files of strangers, and what imports by the API have")
        ->type_name("FOLDER");
    command->footer(
        "By parts, what does not fit --memory goes to files without a name beside the output:\n"
        "about 150 bytes a triangle, gone when the import ends or is stopped. The .eym is the\n"
        "same for closed surfaces, and of others draws the same within the same bounds; textures\n"
        "are left out, which is said. Faces must be triangles then, and --orient needs all of a\n"
        "mesh at once.\n"
        "Files other than PLY are read as a whole, and refused where that, or their textures,\n"
        "would take more.\n"
        "Examples:\n"
        "  eyrie import mesh scan.ply -o scan.eym\n"
        "  eyrie import mesh huge.ply -o huge.eym --memory 2G\n"
        "  eyrie import mesh scan.ply --bits 17 -o small.eym\n"
        "  eyrie import mesh scan.ply --tune orbit -o scan.eym\n"
        "  eyrie import mesh house.obj garden.glb -o place.eym --orient --normals crease=40");
    command->callback([choices, &run] { run = [choices] { return importMesh(*choices); }; });
}

}  // namespace eyrie::cli
