// SPDX-License-Identifier: Apache-2.0
#include "cli/import_notes.h"

#include <gmock/gmock.h>

#include "cli/import/mesh_report.h"

namespace eyrie::cli {
namespace {

using import::MeshImportReport;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// With a level for each pair: of 1,000 vertices those on borders, and those that stay for others'
/// sake.
MeshImportReport reportOf(const std::vector<std::pair<int, int>>& levels) {
    MeshImportReport made;
    for (const auto& [onBorder, staying] : levels) {
        mesh::LodLevel level;
        level.nodes = 1;
        level.points.all = 1000;
        level.points.onBorder = static_cast<std::uint64_t>(onBorder);
        level.points.staying = static_cast<std::uint64_t>(staying);
        made.levels.push_back(level);
    }
    return made;
}

TEST(ImportNotes, TellBordersOfNodesFromOpenEdgesLevelByLevel) {
    EXPECT_EQ(keptLine(reportOf({{51, 0}, {124, 6}, {0, 830}})),
              "of the vertices, by level from the finest, stay 5, 12, 0 % where nodes meet, and 0, "
              "1, 83 % at open edges or where sheets touch");
    EXPECT_EQ(keptLine({}), "");
}

TEST(ImportNotes, WarnOfBordersBeyondFourTenthsAndOfNothingElse) {
    EXPECT_THAT(notesOf(reportOf({})), IsEmpty());
    EXPECT_THAT(notesOf(reportOf({{400, 0}, {0, 830}})), IsEmpty());
    EXPECT_THAT(notesOf(reportOf({{120, 0}, {437, 0}, {410, 0}})),
                ElementsAre(HasSubstr("44 % of the vertices of level 2 stay because nodes meet")));
}

TEST(ImportNotes, TellTheLatticesStepWhereManyTrianglesAreSmaller) {
    MeshImportReport made;
    made.triangles = 1000;
    made.stepMetres = 953.7;
    made.counts.degenerateTriangles = 10;
    EXPECT_THAT(notesOf(made), ElementsAre(HasSubstr("10 triangles without area")));
    made.counts.degenerateTriangles = 11;
    EXPECT_THAT(notesOf(made),
                Contains(AllOf(HasSubstr("rounded to 954 m"), HasSubstr("far from all others"))));
    made.counts.emptyTriangles = 1;  // in the source, which a finer lattice would not change
    EXPECT_THAT(notesOf(made), ElementsAre(HasSubstr("11 triangles without area")));
}

TEST(ImportNotes, TellOfWhatWasLeftOutAndNothingElse) {
    MeshImportReport made;
    made.triangles = 1000;
    made.counts.duplicateTriangles = 122;
    EXPECT_THAT(notesOf(made), ElementsAre("left out 122 triangles that were there already"));
    made.droppedFaces = 3;
    EXPECT_THAT(notesOf(made), ElementsAre("left out 3 faces of fewer than three corners, 122 "
                                           "triangles that were there already"));
    made.counts.degenerateTriangles = 1;
    made.counts.duplicateTriangles = 0;
    EXPECT_THAT(notesOf(made), ElementsAre("left out 3 faces of fewer than three corners, 1 "
                                           "triangles without area"));
}

TEST(ImportNotes, AreInTheJsonOfAnImport) {
    MeshImportReport made;
    made.notes = {"1 of 1 textures cannot be read"};
    testing::internal::CaptureStdout();
    printJson({}, made, {});
    EXPECT_THAT(testing::internal::GetCapturedStdout(),
                HasSubstr(R"("notes": ["1 of 1 textures cannot be read"])"));
}

}  // namespace
}  // namespace eyrie::cli
