// SPDX-License-Identifier: Apache-2.0
// Pictures, depths, picks and profiles by REST.
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/frustum.h"
#include "tests/coordinator/rest_fixture.h"
#include "wire/jpeg.h"

namespace eyrie::api {
namespace {

using testing::IsEmpty;
using testing::StartsWith;

TEST_F(Rest, PicturesComeAsTheyAreAskedFor) {
    const RestAnswer png = send("POST", "/image", R"({"width":20,"height":10,"tauPixels":2})");
    ASSERT_EQ(png.status, 200) << *png.body;
    EXPECT_EQ(png.contentType, "image/png");
    EXPECT_THAT(*png.body, StartsWith("\x89PNG"));
    EXPECT_EQ(header(png, "Eyrie-Tau-Achieved"), "2");
    EXPECT_EQ(frames_.requests().back().width, 20);
    EXPECT_EQ(frames_.requests().back().tauPixels, 2);
    EXPECT_EQ(frames_.requests().back().completeness, fabric::Completeness::Complete);

    const RestAnswer jpeg =
        get("/image?width=20&height=10&format=IMAGE_FORMAT_JPEG&jpegQuality=50");
    EXPECT_EQ(jpeg.contentType, "image/jpeg");
    const auto decoded =
        wire::decodeJpeg(std::as_bytes(std::span(jpeg.body->data(), jpeg.body->size())));
    ASSERT_TRUE(decoded.ok());
    EXPECT_EQ(decoded->area.width, 20);

    const RestAnswer raw = get("/image?width=2&height=1&format=IMAGE_FORMAT_RAW");
    EXPECT_EQ(raw.contentType, "application/octet-stream");
    EXPECT_EQ(*raw.body, std::string("\x5A\x78\x3C\xFF\x5A\x78\x3C\xFF", 8));
}

TEST_F(Rest, AnErrorWithoutBoundIsInTheHeaderAsInJson) {
    frames_.setDraw([](const coordinator::FrameRequest& request) {
        auto frame = coordinator::plainFrame(request, {90, 120, 60, 255});
        frame.statistics.tauAchievedPixels = std::numeric_limits<double>::infinity();
        return frame;
    });
    EXPECT_EQ(
        header(get("/image?width=20&height=10&format=IMAGE_FORMAT_PNG"), "Eyrie-Tau-Achieved"),
        "Infinity");
}

TEST_F(Rest, PicturesSayOfWhichRevisionTheyAre) {
    std::uint64_t revision = 0xfedcba9876543210;
    frames_.setDraw([&](const coordinator::FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {1, 2, 3, 255});
        frame.revision = revision++;
        return frame;
    });
    EXPECT_EQ(header(get("/image?width=20&format=IMAGE_FORMAT_RAW"), "Eyrie-Revision"),
              "18364758544493064720");
    EXPECT_EQ(header(get("/image?width=20"), "Eyrie-Revision"), "18364758544493064721");
    EXPECT_EQ(text(get("/image?width=20", "application/json"), "revision"), "18364758544493064722");
}

TEST_F(Rest, PicturesWithoutACameraShowHeightsAsTheyAreExaggerated) {
    coordinator::Status status = frames_.status();
    fabric::GroundGrid grid;
    grid.worldFromGrid[0] *= 50;
    grid.worldFromGrid[1] *= 50;
    status.sceneInfo.ground = std::make_shared<const std::vector<fabric::GroundGrid>>(1, grid);
    frames_.setStatus(status);
    ASSERT_EQ(send("POST", "/image", R"({"width":20,"height":10})").status, 200);
    const double low = frames_.requests().back().camera.eye.z;
    ASSERT_EQ(
        send("POST", "/image", R"({"width":20,"height":10,"look":{"exaggeration":50}})").status,
        200);
    EXPECT_GT(frames_.requests().back().camera.eye.z, 400) << "the highest is drawn at 500";
    EXPECT_LT(low, 200);
    frames_.setPick([&](const fabric::PickRequest& request) -> absl::StatusOr<fabric::Picked> {
        EXPECT_GT(request.camera.eye.z, 400);
        return fabric::Picked{};
    });
    EXPECT_EQ(send("POST", "/pick", R"({"x":640,"y":360,"exaggeration":50})").status, 200);
}

TEST_F(Rest, DepthComesInMetresAndItsTopRowFirst) {
    frames_.setDraw([](const coordinator::FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {1, 2, 3, 255});
        frame.image = fabric::makeImage({0, 0, 1, 2}, {}, true);
        frame.image.depth = {static_cast<float>(fabric::kNearMetres / 5), 0};  // below, above
        return frame;
    });
    const RestAnswer answer =
        send("POST", "/image", R"({"width":1,"height":2,"withDepth":true})", "application/json");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    v1::RenderImageResponse response;
    ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(*answer.body, &response).ok());
    ASSERT_EQ(response.depth().size(), 8U);
    float metres[2];
    std::memcpy(metres, response.depth().data(), 8);
    EXPECT_TRUE(std::isinf(metres[0]));
    EXPECT_NEAR(metres[1], 5, 1e-5);
    EXPECT_TRUE(frames_.requests().back().wantsDepth);
}

TEST_F(Rest, PicturesComeInJsonWhereThatTypeIsAccepted) {
    for (const char* json : {"application/json", "image/png;q=.5, Application/JSON ; q=0.5",
                             "application/json;charset=utf-8"})
        EXPECT_EQ(get("/image?width=20", json).contentType, "application/json") << json;
    for (const char* other : {"", "*/*", "image/png", "application/json-seq", "x/application/json",
                              "image/png, application/json;q=0", "application/json; q=0.000"})
        EXPECT_EQ(get("/image?width=20", other).contentType, "image/png") << other;
}

TEST_F(Rest, DepthComesAsAFloatMap) {
    frames_.setDraw([](const coordinator::FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {1, 2, 3, 255});
        frame.image = fabric::makeImage({0, 0, 1, 2}, {}, request.wantsDepth);
        if (request.wantsDepth)
            frame.image.depth = {static_cast<float>(fabric::kNearMetres / 5), 0};  // below, above
        return frame;
    });
    const RestAnswer answer = get("/image?width=1&height=2&format=IMAGE_FORMAT_DEPTH");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    EXPECT_EQ(answer.contentType, "image/x-portable-floatmap");
    const std::string head = "Pf\n1 2\n-1.0\n";
    ASSERT_THAT(*answer.body, StartsWith(head));
    ASSERT_EQ(answer.body->size(), head.size() + 8);
    float metres[2];
    std::memcpy(metres, answer.body->data() + head.size(), 8);
    EXPECT_NEAR(metres[0], 5, 1e-5) << "the lowest row is first";
    EXPECT_TRUE(std::isinf(metres[1]));

    frames_.setDraw([](const coordinator::FrameRequest& request) {
        return coordinator::plainFrame(request, {1, 2, 3, 255});
    });
    const RestAnswer without = get("/image?width=1&height=2&format=IMAGE_FORMAT_DEPTH");
    expectProblem(without, 409, "FAILED_PRECONDITION");
    EXPECT_EQ(text(without, "field"), "format");
    const RestAnswer noDepths =
        send("POST", "/image", R"({"width":1,"height":2,"withDepth":true})");
    expectProblem(noDepths, 409, "FAILED_PRECONDITION");
    EXPECT_EQ(text(noDepths, "field"), "withDepth");
}

TEST_F(Rest, PicturesTooLargeForOneAnswerComeInParts) {
    const RestAnswer part = send("POST", "/image",
                                 R"({"width":16384,"height":9216,"format":"IMAGE_FORMAT_RAW",
                                     "part":{"x":8,"y":9000,"width":20,"height":10}})");
    ASSERT_EQ(part.status, 200) << *part.body;
    const coordinator::FrameRequest asked = frames_.requests().back();
    EXPECT_EQ(asked.width, 16384);
    EXPECT_EQ(asked.part, (fabric::PixelViewport{8, 9000, 20, 10}));
    EXPECT_EQ(part.body->size(), 4U * 20 * 10);
    for (const char* bad : {
             R"({"width":16385,"height":10,"part":{"width":1,"height":1}})",
             R"({"width":100,"height":100,"part":{}})",
             R"({"width":100,"height":100,"part":{"x":99,"width":2,"height":1}})",
             R"({"width":100,"height":100,"part":{"x":-1,"width":2,"height":1}})",
             R"({"width":100,"height":100,"part":{"x":2147483647,"width":1,"height":1}})",
             R"({"width":16384,"height":16384,"part":{"width":8193,"height":1}})",
             R"({"width":16384,"height":16384,"part":{"width":8192,"height":8192}})",
         }) {
        const RestAnswer refused = send("POST", "/image", bad);
        expectProblem(refused, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(refused, "field"), "part") << bad;
    }
    EXPECT_EQ(frames_.requests().size(), 1U);
}

TEST_F(Rest, APartBesideAllThatIsSeenIsBackgroundUnlessTheWholePictureIs) {
    frames_.setDraw([](const coordinator::FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {1, 2, 3, 255});
        frame.pictures.front().seen = std::vector<fabric::SeenArea>();
        return frame;
    });
    absl::StatusOr<std::vector<fabric::SeenArea>> areas = std::vector<fabric::SeenArea>(1);
    frames_.setSeen(
        [&](const coordinator::FrameRequest& request) -> absl::StatusOr<fabric::SeenAreas> {
            EXPECT_TRUE(request.part.isEmpty());
            EXPECT_EQ(request.width, 200);
            if (!areas.ok())
                return areas.status();
            return fabric::SeenAreas(*areas);
        });
    const std::string part =
        R"({"width":200,"height":100,"format":"IMAGE_FORMAT_RAW","part":{"x":100,"width":1,"height":1}})";
    const RestAnswer beside = send("POST", "/image", part);
    ASSERT_EQ(beside.status, 200) << *beside.body;
    EXPECT_EQ(*beside.body, std::string("\1\2\3\xFF", 4));
    expectProblem(send("POST", "/image", R"({"width":200,"height":100})"), 409,
                  "FAILED_PRECONDITION");
    areas->clear();
    expectProblem(send("POST", "/image", part), 409, "FAILED_PRECONDITION");
    areas = absl::InvalidArgumentError("the eye is not before the wall");  // of frames put together
    EXPECT_EQ(send("POST", "/image", part).status, 200);
}

TEST_F(Rest, EyesAndStereoThatAreNotKnownAreRefused) {
    for (const char* path : {"/image", "/pick"}) {
        const RestAnswer eye = send("POST", path, R"({"shown":{"eye":9}})");
        expectProblem(eye, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(eye, "field"), "shown.eye");
        const RestAnswer stereo = send("POST", path, R"({"shown":{"stereo":-1}})");
        expectProblem(stereo, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(stereo, "field"), "shown.stereo");
    }
    EXPECT_THAT(frames_.requests(), IsEmpty());
}

TEST_F(Rest, PicksAndProfilesLookThroughWhatIsHidden) {
    ASSERT_EQ(send("POST", "/pick", R"({"x":1,"y":1,"hiddenObjects":[2,0]})").status, 200);
    EXPECT_EQ(frames_.picks().back().hidden.positions, (std::vector<std::int32_t>{0, 2}));
    ASSERT_EQ(send("POST", "/profile", R"({"to":{"x":2},"samples":2,"hiddenObjects":[1]})").status,
              200);
    EXPECT_EQ(frames_.picks().back().hidden.positions, (std::vector<std::int32_t>{1}));
    expectProblem(send("POST", "/pick", R"({"x":1,"y":1,"hiddenObjects":[-1]})"), 400,
                  "INVALID_ARGUMENT");
}

TEST_F(Rest, ErrorsOfFramesHaveTheirStatus) {
    frames_.setDraw([](const coordinator::FrameRequest&) {
        return absl::UnavailableError("no renderer; start one");
    });
    const RestAnswer answer = get("/image");
    expectProblem(answer, 503, "UNAVAILABLE");
    EXPECT_EQ(header(answer, "Retry-After"), "1");
    EXPECT_EQ(text(answer, "remedy"), "start one");
}

TEST_F(Rest, NothingIsDrawnForAClientThatHasGone) {
    RestRequest request{"GET", "/image"};
    std::stop_source gone;
    gone.request_stop();
    request.stop = gone.get_token();
    EXPECT_EQ(ask(request).status, 499);
    EXPECT_THAT(frames_.requests(), IsEmpty());
}

TEST_F(Rest, PicksCountTheirRowsFromTheTop) {
    const RestAnswer answer =
        send("POST", "/pick", R"({"width":100,"height":50,"x":10.5,"y":0.5})");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    EXPECT_EQ(frames_.picks().back().place.x, 10.5);
    EXPECT_EQ(frames_.picks().back().place.y, 49.5);
}

TEST_F(Rest, PicksAreOfTheEyeThatIsNamed) {
    const std::string pick = R"({"x":1,"y":1,"shown":{"stereo":"SHOWN_STEREO_SIDE_BY_SIDE")";
    expectProblem(send("POST", "/pick", pick + "}}"), 400, "INVALID_ARGUMENT");
    EXPECT_EQ(send("POST", "/pick", pick + R"(,"eye":"SHOWN_EYE_LEFT"}})").status, 200);
}

TEST_F(Rest, PicksAndProfilesAreNotOfTwoScenes) {
    const auto pick = [&](bool isReplaced) {
        frames_.setPick([this, isReplaced](const auto&) {
            coordinator::Status status = frames_.status();
            status.scene.objects[0].name = "valley";
            status.sceneRevision += isReplaced ? 1 : 0;
            frames_.setStatus(status);
            return fabric::Picked(fabric::PickedPoint());
        });
        return send("POST", "/pick", R"({"x":1,"y":1})");
    };
    EXPECT_EQ(text(pick(false), "objectName"), "hill");
    const RestAnswer refused = pick(true);
    expectProblem(refused, 409, "ABORTED");
    EXPECT_EQ(text(refused, "remedy"), "ask again");
    expectProblem(send("POST", "/profile", R"({"to":{"x":2},"samples":2})"), 409, "ABORTED");
    EXPECT_EQ(frames_.picks().size(), 4U);
}

TEST_F(Rest, PicksOutsideThePictureAreToldInTheirOwnTerms) {
    const auto expectRefused = [&](const char* pick, const std::string& field,
                                   const std::string& detail) {
        const RestAnswer refused = send("POST", "/pick", pick);
        expectProblem(refused, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(refused, "field"), field) << pick;
        EXPECT_EQ(text(refused, "detail"), detail) << pick;
    };
    expectRefused(R"({"x":-5,"y":0})", "x", "x is -5; it must be from 0 to 1280");
    expectRefused(R"({"width":100,"height":50,"x":101,"y":0})", "x",
                  "x is 101; it must be from 0 to 100");
    expectRefused(R"({"width":100,"height":50,"x":1,"y":50.5})", "y",
                  "y is 50.5; it must be from 0 to 50");
    expectRefused(R"({"x":1,"y":"NaN"})", "y", "y is nan; it must be from 0 to 720");
    expectRefused(R"({"width":0,"x":0,"y":0})", "width", "width is 0; it must be from 1 to 16384");
    EXPECT_THAT(frames_.picks(), IsEmpty());
}

TEST_F(Rest, ProfilesHaveTheirSamples) {
    const RestAnswer answer =
        send("POST", "/profile", R"({"from":{"x":1},"to":{"x":2},"samples":5})");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    EXPECT_EQ(member(json(answer), "samples").list_value().values_size(), 5);
    for (const auto& [body, field] : {std::pair(R"({"samples":513})", "samples"),
                                      std::pair(R"({"to":{"y":1e16},"samples":2})", "to.y"),
                                      std::pair(R"({"from":{"x":"NaN"},"samples":2})", "from.x")}) {
        const RestAnswer refused = send("POST", "/profile", body);
        expectProblem(refused, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(refused, "field"), field);
    }
}

}  // namespace
}  // namespace eyrie::api
