// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/simulator/costs.h"
#include "bench/simulator/events.h"
#include "bench/simulator/frames.h"
#include "bench/simulator/layouts.h"
#include "bench/simulator/text.h"
#include "coordinator/config/eqc_reader.h"

namespace eyrie::simulator {
namespace {

constexpr double kMegapixels = 1280 * 720 / 1e6;

config::Configuration layout(int renderers, const std::string& name) {
    for (const Layout& each : layoutsOf(renderers, 1280, 720)) {
        config::Findings findings;
        config::Configuration configuration = config::readEqc(each.eqc, findings);
        EXPECT_TRUE(findings.all().empty()) << each.name << config::describe(findings, each.name);
        if (each.name == name)
            return configuration;
    }
    ADD_FAILURE() << "no layout " << name;
    return {};
}

Prediction predicted(int renderers, const std::string& name, const Costs& costs,
                     const Machines& machines = {}) {
    const auto prediction = predict(layout(renderers, name), costs, machines, 1e6);
    EXPECT_TRUE(prediction.ok()) << prediction.status();
    return prediction.value_or(Prediction{});
}

Costs trianglesOnly() {
    Costs costs;
    costs.millionTrianglesMs = 64;
    return costs;
}

Machines instantLinks() {
    Machines machines;
    machines.gigabitsPerSecond = 1e12;
    machines.latencyMilliseconds = 0;
    return machines;
}

TEST(Events, ShareWhatTheyUseAtATime) {
    Events events;
    const Id cores = events.addResource(2);
    const Id first = events.addActivity(10, 2, {cores}, {});
    const Id second = events.addActivity(20, 2, {cores}, {});
    const Id third = events.addDelay(5, {first, second});
    ASSERT_TRUE(events.run());
    EXPECT_NEAR(events.doneAt(first), 10, 1e-6);   // one core each
    EXPECT_NEAR(events.doneAt(second), 15, 1e-6);  // then both
    EXPECT_NEAR(events.doneAt(third), 20, 1e-6);
    EXPECT_NEAR(events.busy(cores), 15, 1e-6);
}

TEST(Events, GoAsFastAsTheSlowestThatTheyUse) {
    Events events;
    const Id fast = events.addResource(100);
    const Id slow = events.addResource(10);
    const Id stream = events.addActivity(50, 1000, {fast, slow}, {});
    ASSERT_TRUE(events.run());
    EXPECT_NEAR(events.doneAt(stream), 5, 1e-6);
}

TEST(Events, SayWhenTheyWaitForEachOther) {
    Events events;
    const Id first = events.addDelay(1, {});
    const Id second = events.addDelay(1, {first});
    events.addDependency(first, second);
    EXPECT_FALSE(events.run());
}

TEST(Prediction, OfOneRendererIsTheSumOfItsSteps) {
    Costs costs;
    costs.taskMs = 3;
    costs.millionTrianglesMs = 20;
    costs.megapixelMs = 10;
    costs.readbackMegapixelMs = 2;
    costs.assembleMegapixelMs = 1;
    costs.threads = 2;
    Machines machines;
    machines.cores = 4;
    machines.gigabitsPerSecond = 8;  // 1 MB a millisecond
    machines.latencyMilliseconds = .5;
    const Prediction one = predicted(1, "one", costs, machines);
    const double drawn = (3 + 20 + 10 * kMegapixels) / 2;
    EXPECT_NEAR(one.frameMilliseconds, drawn + (2 + 4 + 1) * kMegapixels + .5, 1e-6);
    EXPECT_NEAR(one.processorMilliseconds, 23 + 13 * kMegapixels, 1e-6);
    EXPECT_NEAR(one.bytes, 4e6 * kMegapixels, 1e-3);
}

TEST(Prediction, IsPerfectWhereNothingButSharedWorkCosts) {
    for (const char* name : {"2D", "DB", "direct send", "binary swap"})
        EXPECT_NEAR(predicted(8, name, trianglesOnly(), instantLinks()).frameMilliseconds, 8, 1e-6)
            << name;
    EXPECT_NEAR(predicted(8, "DPlex", trianglesOnly(), instantLinks()).framesPerSecond,
                8 * 1000. / 64, 1e-3);
}

TEST(Prediction, HasNoMoreFramesUnderWayThanTheProgram) {
    config::Configuration dplex = layout(32, "DPlex");
    dplex.latency = 7;
    const auto most = predict(dplex, trianglesOnly(), instantLinks(), 1e6);
    dplex.latency = 31;
    const auto more = predict(dplex, trianglesOnly(), instantLinks(), 1e6);
    ASSERT_TRUE(most.ok() && more.ok());
    EXPECT_NEAR(most->framesPerSecond, 8 * 1000. / 64, 1e-3);
    EXPECT_NEAR(more->framesPerSecond, most->framesPerSecond, 1e-3);
    EXPECT_NEAR(more->frameMilliseconds, most->frameMilliseconds, 1e-6);
}

TEST(Prediction, HasAsManyFramesUnderWayAsItsRateAndTheirTimesSay) {
    Costs costs = trianglesOnly();
    costs.assembleMegapixelMs = 1;
    for (const int renderers : {8, 10, 12}) {
        const Prediction dplex = predicted(renderers, "DPlex", costs, {});
        EXPECT_NEAR(dplex.framesPerSecond * dplex.frameMilliseconds / 1000, 8, .05) << renderers;
    }
    config::Configuration one = layout(1, "one");
    one.latency = 1;
    Machines far;
    far.latencyMilliseconds = 50;
    const auto late = predict(one, costs, far, 4e5);
    ASSERT_TRUE(late.ok());
    EXPECT_NEAR(late->framesPerSecond * late->frameMilliseconds / 1000, 2, .01);
}

TEST(Prediction, GainsNothingFromRenderersThatShareOneCore) {
    Machines machines = instantLinks();
    machines.isOneMachine = true;
    for (const char* name : {"2D", "DB"})
        EXPECT_NEAR(predicted(4, name, trianglesOnly(), machines).frameMilliseconds, 64, 1e-6)
            << name;
}

TEST(Prediction, DrawsTwiceWhatLiesAcrossCuts) {
    Costs costs = trianglesOnly();
    costs.overlap = .5;  // halves have three quarters each
    EXPECT_NEAR(predicted(2, "2D", costs, instantLinks()).frameMilliseconds, 48, 1e-6);
    EXPECT_NEAR(predicted(2, "DB", costs, instantLinks()).frameMilliseconds, 32, 1e-6);
}

TEST(Prediction, SendsWhatEachWayOfMergingNeeds) {
    const double picture = 4e6 * kMegapixels;
    const auto sent = [](const char* name) { return predicted(8, name, {}).bytes; };
    EXPECT_NEAR(sent("2D"), picture, 1e3);
    EXPECT_NEAR(sent("DB"), 8 * 2 * picture, 1e3);
    EXPECT_NEAR(sent("direct send"), 7 * 2 * picture + picture, 1e3);
    EXPECT_NEAR(sent("binary swap"), 7 * 2 * picture + picture, 1e3);
}

TEST(Prediction, MergesOneLayerAStageInBinarySwap) {
    Costs costs;
    costs.mergeMegapixelMs = 8;
    // Halves, quarters and eighths: 7 eighths of a picture, one after the other.
    EXPECT_NEAR(predicted(8, "binary swap", costs, instantLinks()).frameMilliseconds,
                7 * kMegapixels, 1e-3);
    EXPECT_NEAR(predicted(8, "DB", costs, instantLinks()).frameMilliseconds, 64 * kMegapixels,
                1e-3);
}

/// Of one channel and a view, with a second channel that helps.
absl::StatusOr<Prediction> predictedOf(const std::string& view, const std::string& compound) {
    config::Findings findings;
    const std::string pipe = "pipe { window { viewport [ 0 0 1280 720 ] channel { name \"";
    const config::Configuration configuration = config::readEqc(
        "config { appNode { " + pipe + "a\" } } } " + pipe + "b\" } } } } layout { view { " + view +
            " } } canvas { layout 0 segment { channel \"a\" } } compound { channel ( segment 0 "
            "view "
            "0 ) " +
            compound + " } }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    return predict(configuration, trianglesOnly(), instantLinks(), 1e6);
}

TEST(Prediction, DrawsOnceForEachEye) {
    const auto mono = predictedOf("mode MONO", "");
    const auto stereo = predictedOf("mode STEREO", "");
    const auto left = predictedOf("mode STEREO", "eye [ LEFT ]");
    ASSERT_TRUE(mono.ok() && stereo.ok() && left.ok());
    EXPECT_NEAR(stereo->processorMilliseconds, 2 * mono->processorMilliseconds, 1e-6);
    EXPECT_NEAR(left->processorMilliseconds, mono->processorMilliseconds, 1e-6);
}

TEST(Prediction, IsOverAllThatPeriodsMakeOfOneAnother) {
    const auto prediction =
        predictedOf("",
                    "compound { period 2 } compound { channel \"b\" period 3 outputframe { } } "
                    "inputframe { name \"frame.b\" }");
    ASSERT_TRUE(prediction.ok()) << prediction.status();
    EXPECT_NEAR(prediction->processorMilliseconds, 64 / 2. + 64 / 3., 1e-6);
    // Of six frames the one draws three, and the other two of them meanwhile.
    EXPECT_NEAR(prediction->framesPerSecond, 6 * 1000 / (3 * 64.), 1e-3);
}

/// Two segments of half a canvas, of whose pictures others draw a half and nine tenths.
absl::StatusOr<Prediction> predictedOfTwoTrees(const std::string& first,
                                               const std::string& second) {
    const auto tree = [](int segment, double own, const std::string& helper,
                         const std::string& frame) {
        return fmt::format(
            "compound {{ channel ( segment {0} view 0 ) compound {{ viewport [ 0 0 {1} 1 ] }} "
            "compound {{ viewport [ {1} 0 {2} 1 ] channel \"{3}\" outputframe {{ name "
            "\"{4}\" }} }} inputframe {{ name \"{4}\" }} }} ",
            segment, own, 1 - own, helper, frame);
    };
    std::string pipes;
    for (const char* channel : {"a", "b", "c", "d"})
        pipes += fmt::format(
            "pipe {{ window {{ viewport [ 0 0 640 720 ] channel {{ name \"{}\" }} }} }} ", channel);
    config::Findings findings;
    const config::Configuration configuration =
        config::readEqc("config { appNode { " + pipes +
                            "} layout { view { } } canvas { layout 0 "
                            "segment { channel \"a\" viewport [ 0 0 .5 1 ] } "
                            "segment { channel \"b\" viewport [ .5 0 .5 1 ] } } " +
                            tree(0, .5, "c", first) + tree(1, .1, "d", second) + "}",
                        findings);
    EXPECT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    Costs costs = trianglesOnly();
    costs.readbackMegapixelMs = 100;
    return predict(configuration, costs, {}, 1e6);
}

TEST(Prediction, KeepsFramesOfTreesApartWhateverTheirNames) {
    const auto same = predictedOfTwoTrees("f", "f");
    const auto other = predictedOfTwoTrees("f", "g");
    ASSERT_TRUE(same.ok() && other.ok()) << same.status() << other.status();
    EXPECT_NEAR(same->frameMilliseconds, other->frameMilliseconds, 1e-6);
    EXPECT_NEAR(same->framesPerSecond, other->framesPerSecond, 1e-6);
    EXPECT_NEAR(same->bytes, other->bytes, 1e-3);
}

TEST(Prediction, IsNotOfTilesThatRenderersFetch) {
    const auto tiles = predictedOf(
        "",
        "outputtiles { name \"q\" } compound { inputtiles { name \"q\" } } compound { channel "
        "\"b\" inputtiles { name \"q\" } outputframe { } } inputframe { name \"frame.b\" }");
    EXPECT_THAT(tiles.status().message(), testing::HasSubstr("tile_equalizer and inputtiles"));
}

TEST(Costs, NameTheLineThatTheyCannotTake) {
    const std::string path = testing::TempDir() + "costs.csv";
    std::ofstream(path) << "# what\ntask_ms,3\nspeed,9\n";
    EXPECT_THAT(std::string(readCosts(path).status().ToString()),
                testing::HasSubstr("costs.csv:3: \"speed,9\" is no cost"));
    std::ofstream(path) << "task_ms,-3\n";
    EXPECT_FALSE(readCosts(path).ok());
    EXPECT_FALSE(readTriangles(path).ok());
    EXPECT_EQ(readCosts("no such file").status().code(), absl::StatusCode::kNotFound);
}

TEST(Costs, AreNotTakenToBeNothingWhereTheyAreMissing) {
    const std::string path = testing::TempDir() + "costs.csv";
    std::ofstream(path) << "";
    EXPECT_FALSE(readCosts(path).ok());
    std::ofstream(path) << "task_ms,3\nmillion_triangles_ms,42\nreadback_megapixel_ms,1\n"
                           "merge_megapixel_ms,3\nthreads,2\noverlap,0\npacked,1\n";
    EXPECT_THAT(readCosts(path).status().ToString(),
                testing::HasSubstr("costs.csv: assemble_megapixel_ms, megapixel_ms missing"));
}

TEST(Costs, AreReadWhateverEndsTheirLines) {
    const std::string path = testing::TempDir() + "costs.csv";
    std::ofstream(path) << "# what\r\n\r\ntask_ms,3\r\nmillion_triangles_ms,42\r\n"
                           "megapixel_ms,43\r\nreadback_megapixel_ms,1\r\n"
                           "assemble_megapixel_ms,1\r\nmerge_megapixel_ms,3\r\n"
                           "threads,2\r\noverlap,0\r\npacked,1\r\n";
    const auto costs = readCosts(path);
    ASSERT_TRUE(costs.ok()) << costs.status();
    EXPECT_EQ(costs->taskMs, 3);
    std::ofstream(path) << "renderers,pass,triangles\r\n1,1,5\r\n";
    const auto triangles = readTriangles(path);
    ASSERT_TRUE(triangles.ok()) << triangles.status();
    EXPECT_THAT(*triangles, testing::ElementsAre(5));
}

TEST(Costs, AreNoFolder) {
    for (const absl::Status& status :
         {readCosts(testing::TempDir()).status(), readTriangles(testing::TempDir()).status(),
          textOf(testing::TempDir()).status()})
        EXPECT_THAT(std::string(status.message()),
                    testing::EndsWith("this is a folder, not a file"));
}

TEST(Costs, AreReadFromTheMeasuredOnes) {
    const std::string folder = EYRIE_SOURCE_DIR "/bench/data/";
    const auto costs = readCosts(folder + "costs.csv");
    ASSERT_TRUE(costs.ok()) << costs.status();
    EXPECT_GT(costs->megapixelMs, 0);
    const auto triangles = readTriangles(folder + "dragon_orbit.csv");
    ASSERT_TRUE(triangles.ok()) << triangles.status();
    EXPECT_EQ(triangles->size(), 20U);
}

}  // namespace
}  // namespace eyrie::simulator
