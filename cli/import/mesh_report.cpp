// SPDX-License-Identifier: Apache-2.0
#include "cli/import/mesh_report.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/import_notes.h"
#include "cli/json_object.h"
#include "cli/log.h"
#include "cli/several_sources.h"

namespace eyrie::cli {
namespace {

std::vector<JsonObject> levelsJson(const import::MeshImportReport& made) {
    std::vector<JsonObject> levels;
    for (const mesh::LodLevel& level : made.levels)
        levels.push_back(JsonObject()
                             .count("nodes", level.nodes)
                             .count("triangles", level.trianglesAfter)
                             .number("errorMetres", level.largestErrorMetres)
                             .number("colourReachMetres", level.largestReachMetres)
                             .number("normalErrorDegrees", level.normals.most)
                             .number("normalErrorMeanDegrees", level.normals.mean)
                             .number("borderShare", level.points.borderShare())
                             .number("stayingShare", level.points.stayingShare()));
    return levels;
}

std::vector<JsonObject> tuningJson(const MeshTuning& tuning) {
    std::vector<JsonObject> tried;
    for (const TriedLeaf& one : tuning.tried)
        tried.push_back(JsonObject()
                            .count("leafTriangles", one.leafTriangles)
                            .number("frameMs", one.medianMs)
                            .number("trianglesMean", one.trianglesMean)
                            .number("tauAchievedMax", one.promisedPixels)
                            .count("bytes", one.report.bytes)
                            .text("limitingStage", one.limitingStage));
    return tried;
}

}  // namespace

void printJson(const MeshImportChoices& choices, const import::MeshImportReport& made,
               const MeshTuning& tuning) {
    JsonObject json;
    json.text("file", choices.out)
        .count("triangles", made.triangles)
        .count("vertices", made.vertices)
        .count("droppedFaces", made.droppedFaces)
        .count("degenerateTriangles", made.counts.degenerateTriangles)
        .count("duplicateTriangles", made.counts.duplicateTriangles)
        .count("turnedTriangles", made.counts.orient.turnedTriangles)
        .count("nodes", made.nodes)
        .count("pointNodes", made.pointNodes)
        .count("bytes", made.bytes)
        .number("stepMetres", made.stepMetres)
        .number("errorMetres", made.errorMetres)
        .objects("simplified", levelsJson(made))
        .texts("notes", notesOf(made))
        .number("seconds", made.seconds.total);
    if (!tuning.tried.empty())
        json.objects("tuned", tuningJson(tuning));
    fmt::print("{}\n", json.str());
}

std::string contraryOf(const import::OrientCounts& counts) {
    return counts.contraryEdges == 0
               ? ""
               : fmt::format("; across {} edges, as on a Moebius strip, no winding agrees",
                             counts.contraryEdges);
}

void printText(const MeshImportChoices& choices, const import::MeshImportReport& made) {
    for (const std::string& note : notesOf(made))
        tell(fmt::format("{}: {}", titleOf(choices.sources), note));
    const import::PackCounts& counts = made.counts;
    if (choices.how.pack.orients)
        tell(fmt::format("{}: turned {} triangles of {} surfaces, {} of which are closed{}",
                         titleOf(choices.sources), counts.orient.turnedTriangles,
                         counts.orient.components, counts.orient.closedComponents,
                         contraryOf(counts.orient)));
    const std::string points =
        made.pointNodes > 0 ? fmt::format(", {} nodes as points from afar", made.pointNodes) : "";
    const auto hasNodes = [](const mesh::LodLevel& level) { return level.nodes > 0; };
    tell(fmt::format("{}: {} triangles, {} vertices, {} simpler levels{}, {:.1f} MB, {:.2f} s",
                     choices.out, made.triangles, made.vertices,
                     std::ranges::count_if(made.levels, hasNodes), points,
                     static_cast<double>(made.bytes) / 1e6, made.seconds.total));
    if (const std::string kept = keptLine(made); !kept.empty())
        tell(fmt::format("{}: {}", choices.out, kept));
}

}  // namespace eyrie::cli
