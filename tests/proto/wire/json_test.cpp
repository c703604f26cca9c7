// SPDX-License-Identifier: Apache-2.0
#include "wire/json.h"

#include <limits>

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "eyrie/v1/scene.pb.h"
#include "wire/scene.h"

namespace eyrie::wire {
namespace {

TEST(CameraJson, TheShortFormOfTheDesignIsRead) {
    const fabric::Camera camera =
        cameraFromJson(R"({"eye":[1,2,3],"target":[4,5,6],"up":[0,1,0],"fovyDegrees":30})",
                       "c.json")
            .value();
    EXPECT_EQ(camera, (fabric::Camera{{1, 2, 3}, {4, 5, 6}, {0, 1, 0}, 30}));
}

TEST(CameraJson, ARefusalNamesFileAndField) {
    const auto refusal = [](const char* text) {
        return std::string(cameraFromJson(text, "c.json").status().message());
    };
    EXPECT_THAT(refusal(R"({"eye":[1,2,3]})"), testing::HasSubstr("c.json: camera.target"));
    EXPECT_THAT(refusal(R"({"eyes":[1,2,3]})"),
                testing::AllOf(testing::HasSubstr("c.json"), testing::HasSubstr("eyes")));
    EXPECT_THAT(refusal("{"), testing::HasSubstr("c.json: this is no camera file"));
    EXPECT_THAT(refusal(""), testing::HasSubstr("c.json: this is no camera file"));
}

TEST(CameraJson, ARefusalSaysWhatWouldBeRight) {
    const auto refusal = [](const char* text) {
        const std::string message(cameraFromJson(text, "c.json").status().message());
        return message.substr(std::string_view("c.json: this is no camera file: ").size());
    };
    EXPECT_EQ(refusal(R"({"eye":[0,1,"x"]})"), R"(eye[2] is "x"; it must be a number)");
    EXPECT_EQ(refusal(R"({"fovyDegrees":"wide"})"),
              R"(fovyDegrees is "wide"; it must be a number)");
    EXPECT_EQ(refusal(R"({"fovyDegrees":[1]})"),
              "fovyDegrees is a list; it must be a single value");
    EXPECT_EQ(refusal(R"({"fovyDegrees":{}})"),
              "fovyDegrees is an object; it must be a single value");
    EXPECT_EQ(refusal(R"({"targt":[0,0,0]})"),
              "there is no field 'targt'; there is eye, target, up, fovyDegrees");
    EXPECT_EQ(refusal("[1]"), "the whole must be an object in braces");
    EXPECT_EQ(refusal("{\"eye\":[0"),
              "Unexpected end of string. Expected , or ] after array value.");
}

TEST(FlightJson, ARefusalNamesTheFieldFromTheTop) {
    const auto refusal = [](const char* text) {
        const std::string message(flightFromJson(text, "f.json").status().message());
        return message.substr(std::string_view("f.json: this is no flight file: ").size());
    };
    EXPECT_EQ(refusal(R"({"keys":[{"camera":5}]})"),
              "keys[0].camera is 5; it must be an object in braces");
    EXPECT_EQ(refusal(R"({"keys":[{"camera":{"ey":[0]}}]})"),
              "there is no field 'keys[0].camera.ey'; there is eye, target, up, fovyDegrees");
}

TEST(SceneJson, TwoFilesOfAnObjectAreAnErrorThatNamesTheSecond) {
    const auto scene =
        sceneMessageFromJson(R"({"objects":[{"terrain":"a","mesh":"b"}]})", "s.json");
    EXPECT_THAT(std::string(scene.status().message()),
                testing::HasSubstr("objects[0].mesh is beside another that stands for the same"));
}

TEST(LookJson, AWrongNameIsAnErrorThatNamesTheRightOnes) {
    const auto refusal = [](const char* text) {
        return std::string(lookFromJson(text, "l.json").status().message());
    };
    constexpr auto kRight =
        "it must be one of SHADING_SMOOTH, SHADING_FLAT, SHADING_WIREFRAME, SHADING_GOURAUD in "
        "quotes";
    EXPECT_THAT(refusal(R"({"objects":[{"shading":"flat"}]})"),
                testing::AllOf(testing::HasSubstr(R"(objects[0].shading is "flat"; )"),
                               testing::EndsWith(kRight)));
    EXPECT_THAT(refusal(R"({"objects":[{"shading":2.5}]})"), testing::EndsWith(kRight));
    EXPECT_THAT(refusal(R"({"contours":"fine"})"),
                testing::EndsWith("contours is \"fine\"; it must be an object in braces"));
}

TEST(FlightJson, TheFormOfTheDesignIsRead) {
    const fabric::Flight flight =
        flightFromJson(R"({"keys":[{"seconds":0,"camera":{"eye":[0,0,0],"target":[1,0,0]}},
                                   {"seconds":2.5,"camera":{"eye":[0,1,0],"target":[1,0,0]}}]})",
                       "f.json")
            .value();
    ASSERT_EQ(flight.keys.size(), 2u);
    EXPECT_EQ(flight.keys[1].seconds, 2.5);
    EXPECT_EQ(flight.keys[1].camera.eye, fabric::Vec3(0, 1, 0));
}

TEST(FlightJson, ARefusalNamesFileKeyAndField) {
    const auto refusal = [](const char* text) {
        return std::string(flightFromJson(text, "f.json").status().message());
    };
    EXPECT_THAT(refusal(R"({"keys":[{"camera":{"eye":[1,2,3]}}]})"),
                testing::HasSubstr("f.json: keys[0]: camera.target"));
    EXPECT_THAT(refusal(R"({"keys":[]})"), testing::HasSubstr("f.json: the flight has no keys"));
    EXPECT_THAT(refusal(R"({"cameras":[]})"), testing::HasSubstr("f.json: this is no flight file"));
}

TEST(SceneJson, AnUnknownFieldIsAnErrorThatNamesTheFile) {
    const auto scene = sceneMessageFromJson(R"({"objekts":[]})", "s.json");
    EXPECT_THAT(std::string(scene.status().message()),
                testing::AllOf(testing::HasSubstr("s.json"), testing::HasSubstr("objekts")));
}

TEST(SceneJson, DeepNestingIsAnErrorAndNoCrash) {
    const std::string deep = "{\"objects\":" + std::string(100'000, '[');
    EXPECT_EQ(sceneMessageFromJson(deep, "s.json").status().code(),
              absl::StatusCode::kInvalidArgument);
}

TEST(SceneJson, WhatIsWrittenIsRead) {
    fabric::Scene scene;
    scene.objects.push_back(
        {"peak", fabric::ObjectKind::Terrain, "peak.eyt", fabric::Mat4(2.0), {}});
    scene.objects[0].worldFromObject[3][3] = 1;
    const v1::Scene message = sceneMessageFromJson(toJson(toMessage(scene)), "s.json").value();
    EXPECT_EQ(fromMessage(message).value(), scene);
}

/// What any JSON reader makes of the text, through protobuf's own.
google::protobuf::Struct parsed(const std::string& json) {
    google::protobuf::Struct value;
    const auto status = google::protobuf::util::JsonStringToMessage(json, &value);
    EXPECT_TRUE(status.ok()) << status.ToString() << "\n" << json;
    return value;
}

TEST(StatisticsJson, HasTheDesignsFieldsAsPlainNumbers) {
    fabric::FrameStatistics statistics;
    statistics.tauAskedPixels = 1;
    statistics.tauAchievedPixels = 0.75;
    statistics.memoryRaisedTau = true;
    statistics.triangles = 1'234'567'890'123;
    statistics.pagesMissing = 3;
    statistics.pagesFailed = 2;
    statistics.tilesDecodedOnGpu = 9;
    statistics.normalErrorDegrees = 31.5;
    statistics.normalErrorMeanDegrees = 2.25;
    statistics.milliseconds = {0.5, 20, 1, 0, 21.5, 7, 13};
    const auto json = parsed(statisticsJson(
        statistics, 1280, 720, {"Mesa \"x\"", "llvmpipe", "4.5", "surfaceless", true}));
    const auto number = [&](const char* name) { return json.fields().at(name).number_value(); };
    EXPECT_EQ(number("width"), 1280);
    EXPECT_EQ(number("height"), 720);
    EXPECT_EQ(number("tauAsked"), 1);
    EXPECT_EQ(number("tauAchieved"), 0.75);
    EXPECT_EQ(number("triangles"), 1'234'567'890'123);
    EXPECT_EQ(number("points"), 0);
    EXPECT_EQ(number("nodes"), 0);
    EXPECT_EQ(number("nodesHidden"), 0);
    EXPECT_EQ(number("pagesLoaded"), 0);
    EXPECT_EQ(number("bytesLoaded"), 0);
    EXPECT_EQ(number("pagesMissing"), 3);
    EXPECT_EQ(number("pagesFailed"), 2);
    EXPECT_EQ(number("tilesDecodedOnGpu"), 9);
    EXPECT_EQ(number("normalErrorDegrees"), 31.5);
    EXPECT_EQ(number("normalErrorMeanDegrees"), 2.25);
    EXPECT_TRUE(json.fields().at("complete").bool_value());
    EXPECT_TRUE(json.fields().at("memoryRaisedTau").bool_value());
    const auto& milliseconds = json.fields().at("milliseconds").struct_value().fields();
    EXPECT_EQ(milliseconds.at("draw").number_value(), 20);
    EXPECT_EQ(milliseconds.at("vertices").number_value(), 7);
    EXPECT_EQ(milliseconds.at("fill").number_value(), 13);
    EXPECT_EQ(json.fields().at("limitingStage").string_value(), "fill");
    EXPECT_EQ(milliseconds.at("total").number_value(), 21.5);
    const auto& renderer = json.fields().at("renderer").struct_value().fields();
    EXPECT_EQ(renderer.at("vendor").string_value(), "Mesa \"x\"");
    EXPECT_EQ(renderer.at("device").string_value(), "llvmpipe");
    EXPECT_TRUE(renderer.at("software").bool_value());
}

TEST(StatisticsJson, AnErrorWithoutBoundIsInfinityAsInProtobufsJson) {
    fabric::FrameStatistics statistics;
    statistics.tauAchievedPixels = std::numeric_limits<double>::infinity();
    const auto json = parsed(statisticsJson(statistics, 1, 1, {}));
    EXPECT_EQ(json.fields().at("tauAchieved").string_value(), "Infinity");
}

}  // namespace
}  // namespace eyrie::wire
