// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_import.h"

#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "renderer/import/mesh_synth.h"
#include "renderer/import/ply_writer.h"
#include "renderer/mesh/eym_format.h"
#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(MeshImport, WritesTheMeshThatTheReportTellsOf) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(synthesizeMesh(30000, 1), folder.file("m.ply")).ok());
    const auto report = importMesh({folder.file("m.ply")}, folder.file("m.eym"));
    ASSERT_TRUE(report.ok()) << report.status();
    const auto file = mesh::EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->triangleCount(), report->triangles);
    EXPECT_EQ(file->vertexCount(), report->vertices);
    EXPECT_EQ(file->nodes().size(), report->nodes);
    EXPECT_EQ(file->fileBytes(), report->bytes);
    EXPECT_EQ(file->sourceHash(), *mesh::contentHash(folder.file("m.ply")));
    EXPECT_TRUE(report->counts.normalsComputed);
    EXPECT_EQ(report->triangles, report->vertices * 2 - 4);  // closed, so nothing was lost
    for (const mesh::Node& node : file->nodes())
        EXPECT_TRUE(!node.isLeaf() || node.triangleEnd - node.triangleBegin <= 8192U);
    EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("m.ply", "m.eym"));
}

TEST(MeshImport, OfAddressesIsRefusedWithWhatToDo) {
    const test::TemporaryFolder folder;
    for (const char* address :
         {"s3://bucket/m.ply", "https://h/m.obj", "/vsis3/bucket/m.ply", "/vsizip/m.zip/m.ply"}) {
        const absl::Status status = importMesh({address}, folder.file("m.eym")).status();
        EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
        EXPECT_THAT(status.ToString(),
                    HasSubstr(std::string(address) + ": a mesh is read from a file of"));
    }
    EXPECT_THAT(folder.names(), testing::IsEmpty());
}

TEST(MeshImport, GivesTheSameBytesForAnyNumberOfThreadsAndEitherWay) {
    const test::TemporaryFolder folder;
    const TriangleMesh source = synthesizeMesh(100000, 2);
    ASSERT_TRUE(writePly(source, folder.file("m.ply")).ok());
    ASSERT_TRUE(importMesh({folder.file("m.ply")}, folder.file("a.eym")).ok());
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    ASSERT_TRUE(
        importMesh(source, folder.file("b.eym"), {}, {}, *mesh::contentHash(folder.file("m.ply")))
            .ok());
    EXPECT_EQ(test::readFile(folder.file("a.eym")), test::readFile(folder.file("b.eym")));
}

TEST(MeshImport, ReportsItsStagesInOrder) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(test::tetrahedron(), folder.file("m.ply")).ok());
    std::vector<std::string> stages;
    double last = 0;
    const ImportControl control{[&](std::string_view stage, double fraction) {
                                    if (stages.empty() || stages.back() != stage) {
                                        stages.emplace_back(stage);
                                        last = 0;
                                    }
                                    EXPECT_GE(fraction, last);
                                    EXPECT_LE(fraction, 1);
                                    last = fraction;
                                },
                                {}};
    ASSERT_TRUE(importMesh({folder.file("m.ply")}, folder.file("m.eym"), {}, control).ok());
    EXPECT_THAT(stages, ElementsAre("reading", "welding", "normals", "tree", "levels", "writing"));
}

class MeshImportStopped : public testing::TestWithParam<const char*> {};

TEST_P(MeshImportStopped, LeavesNothingBehindAndTheOldFileAsItWas) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(synthesizeMesh(20000, 1), folder.file("m.ply")).ok());
    test::writeFile(folder.file("m.eym"), "old");
    std::stop_source stop;
    const ImportControl control{[&](std::string_view stage, double) {
                                    if (stage == GetParam())
                                        stop.request_stop();
                                },
                                stop.get_token()};
    const auto report = importMesh({folder.file("m.ply")}, folder.file("m.eym"), {}, control);
    EXPECT_EQ(report.status().code(), absl::StatusCode::kCancelled);
    EXPECT_EQ(test::readFile(folder.file("m.eym")), "old");
    EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("m.ply", "m.eym"));
}

INSTANTIATE_TEST_SUITE_P(Stages, MeshImportStopped,
                         testing::Values("reading", "welding", "normals", "tree", "levels",
                                         "writing"));

TEST(MeshImport, LeavesNothingBehindWhenTheSourceIsBad) {
    const test::TemporaryFolder folder;
    const std::string whole = test::plyOf(test::tetrahedron(), test::Encoding::LittleEndian);
    for (const std::string& text : {std::string(), whole.substr(0, whole.size() - 2)}) {
        test::writeFile(folder.file("m.ply"), text);
        const auto report = importMesh({folder.file("m.ply")}, folder.file("m.eym"));
        EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(report.status().message()), HasSubstr(folder.file("m.ply")));
        EXPECT_THAT(folder.names(), ElementsAre("m.ply"));
    }
}

TEST(MeshImport, NamesTheFileWhoseMeshCannotBeStored) {
    const test::TemporaryFolder folder;
    TriangleMesh source = test::tetrahedron();
    source.positions[3].z = 1e20;
    ASSERT_TRUE(writePly(source, folder.file("m.ply")).ok());
    const auto report = importMesh({folder.file("m.ply")}, folder.file("m.eym"));
    EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(HasSubstr("m.ply"), HasSubstr("z 0 to"), HasSubstr("units")));
    EXPECT_THAT(folder.names(), ElementsAre("m.ply"));
}

TEST(MeshImport, SaysWhichFormatsItReads) {
    const test::TemporaryFolder folder;
    const auto report = importMesh({folder.file("bunny.max")}, folder.file("m.eym"));
    EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(report.status().message()),
                testing::AllOf(HasSubstr("bunny.max"), HasSubstr("'.max'"), HasSubstr(".ply"),
                               HasSubstr(".obj")));
}

TEST(MeshImport, RefusesToReplaceItsOwnSource) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writePly(test::tetrahedron(), folder.file("m.ply")).ok());
    EXPECT_EQ(importMesh({folder.file("m.ply")}, folder.file("m.ply")).status().code(),
              absl::StatusCode::kInvalidArgument);
    EXPECT_GT(test::readFile(folder.file("m.ply")).size(), 100U);
}

TEST(MeshImport, TellsMissingSourcesAndFoldersApart) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(importMesh({folder.file("no.ply")}, folder.file("m.eym")).status().code(),
              absl::StatusCode::kNotFound);
    EXPECT_THAT(folder.names(), testing::IsEmpty());
    const auto report = importMesh(test::tetrahedron(), folder.file("none/m.eym"));
    EXPECT_EQ(report.status().code(), absl::StatusCode::kNotFound);
    EXPECT_THAT(std::string(report.status().message()), HasSubstr("create the folder"));
}

TEST(MeshImport, RefusesLeavesThat16BitsCannotIndex) {
    const test::TemporaryFolder folder;
    for (const std::uint32_t leafTriangles : {0U, 65536U})
        EXPECT_EQ(
            importMesh(test::tetrahedron(), folder.file("m.eym"), {leafTriangles}).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyrie::import
