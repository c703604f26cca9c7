// SPDX-License-Identifier: Apache-2.0
// CoordinatorService without the network: what REST requests become, and what comes back.
#include "coordinator/api/api.h"

#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/server.h>
#include <grpcpp/support/channel_arguments.h>
#include <gtest/gtest.h>

#include "coordinator/api/coordinator_service.h"
#include "coordinator/api/grpc_service.h"
#include "coordinator/api/openapi.h"
#include "coordinator/api/rest_routes.h"
#include "coordinator/config/default_config.h"
#include "coordinator/frame/active_configuration.h"
#include "fabric/frustum.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/without_rights.h"
#include "wire/jpeg.h"
#include "wire/listen.h"

namespace eyrie::api {
namespace {

using google::protobuf::Value;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// The configuration of two renderers.
class FakeConfiguration : public coordinator::ConfigurationAccess {
public:
    absl::Status withConfiguration(
        const std::function<absl::Status(coordinator::ActiveConfiguration&)>& use) override {
        return use(active_);
    }

private:
    coordinator::ActiveConfiguration active_{config::defaultConfiguration(
        std::vector<config::RendererFacts>{{"a", "", "fake"}, {"b", "", "fake"}})};
};

class Rest : public testing::Test {
protected:
    Rest() {
        std::filesystem::create_directory(folder_.path("data"));
        makeApi(access::DataFolder::open(folder_.path("data")).value());
    }

    void makeApi(std::optional<access::DataFolder> data) {
        api_ = std::make_unique<Api>(ApiParts{frames_, configuration_,
                                              [this](fabric::Scene scene) {
                                                  coordinator::Status status = frames_.status();
                                                  status.scene = std::move(scene);
                                                  frames_.setStatus(status);
                                              },
                                              std::move(data)});
    }

    RestAnswer ask(RestRequest request) const {
        request.target = "/api/v1" + request.target;
        return api_->rest().answer(request);
    }
    RestAnswer get(const std::string& target, const std::string& accept = "") const {
        return ask({"GET", target, "", "", accept});
    }
    RestAnswer send(const std::string& method, const std::string& target, const std::string& body,
                    const std::string& accept = "") const {
        return ask({method, target, body, "application/json", accept});
    }

    static Value json(const RestAnswer& answer) {
        Value value;
        EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(*answer.body, &value).ok())
            << *answer.body;
        return value;
    }
    static Value member(const Value& value, const std::string& name) {
        const auto& fields = value.struct_value().fields();
        EXPECT_TRUE(fields.contains(name)) << name;
        return fields.contains(name) ? fields.at(name) : Value();
    }
    static std::string text(const RestAnswer& answer, const std::string& name) {
        return member(json(answer), name).string_value();
    }
    static std::string header(const RestAnswer& answer, const std::string& name) {
        for (const auto& [key, value] : answer.headers)
            if (key == name)
                return value;
        return "";
    }
    static void expectProblem(const RestAnswer& answer, int status, const std::string& code) {
        EXPECT_EQ(answer.status, status) << *answer.body;
        EXPECT_EQ(answer.contentType, "application/problem+json");
        EXPECT_EQ(text(answer, "code"), code);
        EXPECT_EQ(member(json(answer), "status").number_value(), status);
    }

    test::TemporaryFolder folder_;
    coordinator::FakeFrameSource frames_;
    FakeConfiguration configuration_;
    std::unique_ptr<Api> api_;
};

TEST_F(Rest, TellsWhatThereIs) {
    const RestAnswer answer = get("/status");
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.contentType, "application/json");
    EXPECT_TRUE(member(json(answer), "ready").bool_value());
    EXPECT_THAT(*answer.body, HasSubstr("\"renderer-1\""));

    coordinator::Status status = coordinator::readyStatus();
    status.problem = "no renderer";
    frames_.setStatus(status);
    EXPECT_FALSE(member(json(get("/status")), "ready").bool_value());
}

TEST_F(Rest, AnswersThatHaveNotChangedAreNotSentAgain) {
    const std::string tag = header(get("/status"), "ETag");
    ASSERT_FALSE(tag.empty());
    RestRequest again{"GET", "/status"};
    again.ifNoneMatch = tag;
    EXPECT_EQ(ask(again).status, 304);
    EXPECT_TRUE(ask(again).body->empty());
    coordinator::Status status = coordinator::readyStatus();
    status.problem = "other";
    frames_.setStatus(status);
    EXPECT_EQ(ask(again).status, 200);
}

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
}

TEST_F(Rest, SaysWhichFieldIsWrongAndWhatToDo) {
    const RestAnswer tau = send("POST", "/image", R"({"tauPixels":0})");
    expectProblem(tau, 400, "INVALID_ARGUMENT");
    EXPECT_EQ(text(tau, "field"), "tauPixels");
    const RestAnswer width = send("POST", "/image", R"({"width":8193})");
    expectProblem(width, 400, "INVALID_ARGUMENT");
    EXPECT_EQ(text(width, "field"), "width");
    EXPECT_EQ(text(width, "remedy"), "it must be from 1 to 8192");
    expectProblem(send("POST", "/image", R"({"width":8192,"height":8192})"), 400,
                  "INVALID_ARGUMENT");
    expectProblem(send("POST", "/image", R"({"camera":{"eye":[0,0]}})"), 400, "INVALID_ARGUMENT");
    expectProblem(send("POST", "/image", R"({"format":99})"), 400, "INVALID_ARGUMENT");
    EXPECT_THAT(frames_.requests(), IsEmpty());
}

TEST_F(Rest, NamesTheFieldThatIsOfAnotherKindOrNotThere) {
    const auto expectField = [&](const RestAnswer& refused, const std::string& field) {
        expectProblem(refused, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(refused, "field"), field) << *refused.body;
        EXPECT_THAT(text(refused, "remedy"), StartsWith("see /api")) << *refused.body;
    };
    expectField(send("POST", "/image", R"({"width":"wide"})"), "width");
    expectField(send("POST", "/image", R"({"withDepth":3})"), "withDepth");
    expectField(send("POST", "/image", R"({"camera":{"eye":[1,"x",2]}})"), "camera.eye[1]");
    expectField(send("POST", "/image", R"({"witdh":20})"), "witdh");
    expectField(send("POST", "/image", R"({"camera":{"eyes":1}})"), "camera.eyes");
    expectField(get("/image?witdh=20"), "witdh");
    expectField(send("PUT", "/scene", R"({"objects":[{"terrain":"a.eyt","x":1}]})"),
                "scene.objects[0].x");
    const RestAnswer neither = send("POST", "/image", R"({"a b":1})");
    expectProblem(neither, 400, "INVALID_ARGUMENT");
    EXPECT_FALSE(json(neither).struct_value().fields().contains("field"));
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

TEST_F(Rest, PicksAndProfilesLookThroughWhatIsHidden) {
    ASSERT_EQ(send("POST", "/pick", R"({"x":1,"y":1,"hiddenObjects":[2,0]})").status, 200);
    EXPECT_EQ(frames_.picks().back().hidden.positions, (std::vector<std::int32_t>{0, 2}));
    ASSERT_EQ(send("POST", "/profile", R"({"to":{"x":2},"samples":2,"hiddenObjects":[1]})").status,
              200);
    EXPECT_EQ(frames_.picks().back().hidden.positions, (std::vector<std::int32_t>{1}));
    expectProblem(send("POST", "/pick", R"({"x":1,"y":1,"hiddenObjects":[-1]})"), 400,
                  "INVALID_ARGUMENT");
}

TEST_F(Rest, RefusesWhatItDoesNotKnow) {
    expectProblem(send("POST", "/image", R"({"witdh":20})"), 400, "INVALID_ARGUMENT");
    expectProblem(send("POST", "/image", "{"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?witdh=20"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?width=a"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?width=20&width=30"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?width=%2"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?camera=1"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/nothing"), 404, "NOT_FOUND");
    expectProblem(get("/status/more"), 404, "NOT_FOUND");
    expectProblem(ask({"GET", "/status", "{}", "application/json"}), 400, "INVALID_ARGUMENT");
    const RestAnswer method = send("DELETE", "/image", "");
    expectProblem(method, 405, "UNIMPLEMENTED");
    EXPECT_EQ(header(method, "Allow"), "POST, GET");
    EXPECT_THAT(frames_.requests(), IsEmpty());
}

TEST_F(Rest, TakesNoFormsOfOtherSitesPages) {
    expectProblem(ask({"POST", "/image", R"({"width":20})", "text/plain"}), 400,
                  "INVALID_ARGUMENT");
    EXPECT_THAT(frames_.requests(), IsEmpty());
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
    expectProblem(send("POST", "/profile", R"({"samples":513})"), 400, "INVALID_ARGUMENT");
}

TEST_F(Rest, ConfigurationsChangeWhollyOrNotAtAll) {
    const RestAnswer before = get("/configuration");
    ASSERT_EQ(before.status, 200) << *before.body;
    EXPECT_THAT(*before.body, HasSubstr("\"compounds\""));

    const RestAnswer switched =
        send("PATCH", "/configuration", R"({"layouts":[{"canvas":"0","layout":"OFF"}]})");
    if (switched.status != 200)  // not all canvases can show nothing
        expectProblem(switched, 404, "NOT_FOUND");
    const std::string now = *get("/configuration").body;
    expectProblem(send("PATCH", "/configuration",
                       R"({"layouts":[{"canvas":"0","layout":"1"}],)"
                       R"("equalizers":[{"equalizer":999}]})"),
                  404, "NOT_FOUND");
    EXPECT_EQ(*get("/configuration").body, now);
    expectProblem(send("PATCH", "/configuration", R"({"heads":[{"roomFromHead":[1]}]})"), 400,
                  "INVALID_ARGUMENT");

    const RestAnswer layout =
        send("PATCH", "/configuration", R"({"layouts":[{"canvas":"0","layout":"1"}]})");
    ASSERT_EQ(layout.status, 200) << *layout.body;
    EXPECT_NE(*get("/configuration").body, now);
}

TEST_F(Rest, AWallBehindAnEyeIsRefusedAndNothingOfTheChangeIsDone) {
    const std::string before = *get("/configuration").body;
    expectProblem(
        send("PATCH", "/configuration",
             R"({"layouts":[{"canvas":"0","layout":"1"}],"views":[{"layout":"0","view":"0",)"
             R"("wall":{"bottomLeft":[-1,-1,1],"bottomRight":[1,-1,1],"topLeft":[-1,1,1]}}]})"),
        400, "INVALID_ARGUMENT");
    EXPECT_EQ(*get("/configuration").body, before);
}

/// So that a change that is held to what somebody has seen is not refused for each frame since.
TEST_F(Rest, ConfigurationsHaveWhatFramesChangeOnlyWhereItIsAskedFor) {
    const std::string tag = header(get("/configuration"), "ETag");
    ASSERT_TRUE(configuration_
                    .withConfiguration([](coordinator::ActiveConfiguration& active) {
                        const compound::Plan plan = active.plan({}, 1, {}).value();
                        std::vector<coordinator::ActiveConfiguration::Taken> taken;
                        for (const compound::PlannedDraw& draw : plan.draws) {
                            auto& one = taken.emplace_back();
                            one.covered = draw.task.pixelViewport;
                            one.milliseconds = one.stages.total =
                                static_cast<double>(10 * taken.size());
                        }
                        active.record(plan, 1, taken);
                        return absl::OkStatus();
                    })
                    .ok());
    EXPECT_EQ(header(get("/configuration"), "ETag"), tag);
    EXPECT_THAT(*get("/configuration").body, testing::Not(HasSubstr("imbalance")));
    EXPECT_THAT(*get("/configuration?measured=true").body, HasSubstr("imbalance"));
}

TEST_F(Rest, EqualizersAreFrozenAndSwitchedOff) {
    const RestAnswer answer =
        send("PATCH", "/configuration", R"({"equalizers":[{"equalizer":0,"frozen":true}]})");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    const Value now = json(get("/configuration"));
    const Value first = member(now, "equalizers").list_value().values(0);
    EXPECT_TRUE(member(first, "frozen").bool_value());
    EXPECT_TRUE(member(first, "on").bool_value());
}

TEST_F(Rest, ScenesThatWereAnsweredCanBeShownAgain) {
    api_->begin(frames_.status().scene);
    std::ofstream(folder_.path("data/other.eyt")) << "x";
    const RestAnswer scene = get("/scene");
    ASSERT_EQ(scene.status, 200);
    EXPECT_EQ(send("PUT", "/scene", *scene.body).status, 200);

    const RestAnswer other = send("PUT", "/scene", R"({"objects":[{"terrain":"other.eyt"}]})");
    ASSERT_EQ(other.status, 200) << *other.body;
    EXPECT_EQ(frames_.status().scene.objects[0].path,
              std::filesystem::canonical(folder_.path("data/other.eyt")).string());
    EXPECT_THAT(*other.body, HasSubstr("\"other.eyt\""));
    EXPECT_EQ(send("PUT", "/scene", *scene.body).status, 200);
}

TEST_F(Rest, ScenesNameNothingOutsideTheDataFolder) {
    std::ofstream(folder_.path("secret.eyt")) << "x";
    std::ofstream(folder_.path("data/source.tif")) << "x";
    std::filesystem::create_symlink(folder_.path("secret.eyt"), folder_.path("data/link.eyt"));
    for (const std::string name : {"../secret.eyt", "link.eyt", "none.eyt", "source.tif", "", "/",
                                   "a/../../secret.eyt", "https://host/a.eyt"}) {
        const RestAnswer answer =
            send("PUT", "/scene", R"({"objects":[{"terrain":")" + name + "\"}]}");
        EXPECT_GE(answer.status, 400) << name;
        EXPECT_LT(answer.status, 500) << name;
    }
    const RestAnswer whole =
        send("PUT", "/scene", R"({"objects":[{"terrain":")" + folder_.path("secret.eyt") + "\"}]}");
    EXPECT_EQ(whole.status, 400);
    expectProblem(send("PUT", "/scene", "{}"), 400, "INVALID_ARGUMENT");
    EXPECT_EQ(frames_.status().scene, coordinator::readyStatus().scene);
}

TEST_F(Rest, FlightsAreKept) {
    constexpr const char* kFlight =
        R"({"name":"round","keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})";
    EXPECT_THAT(*get("/flights").body, HasSubstr("\"names\": []"));
    const RestAnswer put = send("PUT", "/flights/a-b_1", kFlight);
    ASSERT_EQ(put.status, 200) << *put.body;
    const RestAnswer kept = get("/flights/a-b_1");
    ASSERT_EQ(kept.status, 200);
    EXPECT_EQ(*kept.body, *put.body);
    EXPECT_THAT(*get("/flights").body, HasSubstr("\"a-b_1\""));
    makeApi(access::DataFolder::open(folder_.path("data")).value());
    EXPECT_EQ(*get("/flights/a-b_1").body, *put.body);
    EXPECT_EQ(send("DELETE", "/flights/a-b_1", "").status, 200);
    expectProblem(get("/flights/a-b_1"), 404, "NOT_FOUND");
    expectProblem(send("DELETE", "/flights/a-b_1", ""), 404, "NOT_FOUND");
}

TEST_F(Rest, ChangesAreMadeToWhatTheyWereMeantForOrNotAtAll) {
    const auto flight = [](const std::string& name) {
        return R"({"name":")" + name +
               R"(","keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})";
    };
    const auto put = [&](const std::string& name, const std::string& ifMatch,
                         const std::string& ifNoneMatch = "") {
        RestRequest request{"PUT", "/flights/a", flight(name), "application/json"};
        request.ifMatch = ifMatch;
        request.ifNoneMatch = ifNoneMatch;
        return ask(request);
    };
    EXPECT_EQ(put("none", "*").status, 412);
    EXPECT_EQ(put("none", "\"0123456789abcdef\"").status, 412);
    const RestAnswer first = put("first", "", "*");
    ASSERT_EQ(first.status, 200) << *first.body;
    const std::string tag = header(first, "ETag");
    EXPECT_EQ(tag, header(get("/flights/a"), "ETag"));
    expectProblem(put("again", "", "*"), 412, "FAILED_PRECONDITION");
    EXPECT_EQ(put("second", "\"0123456789abcdef\", " + tag).status, 200);
    const RestAnswer stale = put("third", tag);
    expectProblem(stale, 412, "FAILED_PRECONDITION");
    EXPECT_THAT(text(stale, "remedy"), StartsWith("ask for it again"));
    EXPECT_THAT(*get("/flights/a").body, HasSubstr("second"));
    EXPECT_EQ(put("weak", "W/" + header(get("/flights/a"), "ETag")).status, 412);
    RestRequest remove{"DELETE", "/flights/a"};
    remove.ifMatch = tag;
    EXPECT_EQ(ask(remove).status, 412);
    remove.ifMatch = "*";
    EXPECT_EQ(ask(remove).status, 200);
}

TEST_F(Rest, OfManyChangesOfTheSameOnlyOneIsMade) {
    ASSERT_EQ(
        send("PATCH", "/configuration", R"({"layouts":[{"canvas":"0","layout":"1"}]})").status,
        200);
    const std::string tag = header(get("/configuration"), "ETag");
    std::atomic<int> made{0};
    std::vector<std::jthread> clients;
    for (int i = 0; i < 4; ++i)
        clients.emplace_back([&, i] {
            RestRequest change{"PATCH", "/configuration",
                               fmt::format(R"({{"layouts":[{{"canvas":"0","layout":"{}"}}]}})",
                                           i % 2 == 0 ? 0 : 2),
                               "application/json"};
            change.ifMatch = tag;
            const RestAnswer answer = ask(change);
            EXPECT_TRUE(answer.status == 200 || answer.status == 412) << *answer.body;
            EXPECT_TRUE(answer.status == 412 || header(answer, "ETag") != tag);
            made += answer.status == 200;
        });
    clients.clear();
    EXPECT_EQ(made, 1);
}

TEST_F(Rest, AFlightThatManyWriteIsAlwaysOneOfTheirs) {
    const auto flight = [](int writer) {
        return fmt::format(
            R"({{"name":"{:0>2000}","keys":[{{"camera":{{"eye":[0,-10,3],"target":[0,0,0]}}}}]}})",
            writer);
    };
    ASSERT_EQ(send("PUT", "/flights/race", flight(0)).status, 200);
    std::vector<std::jthread> clients;
    for (int writer = 0; writer < 4; ++writer)
        clients.emplace_back([this, &flight, writer] {
            for (int i = 0; i < 25; ++i) {
                const RestAnswer put = send("PUT", "/flights/race", flight(writer));
                EXPECT_EQ(put.status, 200) << *put.body;
                const RestAnswer got = get("/flights/race");
                EXPECT_EQ(got.status, 200) << *got.body;
            }
        });
    clients.clear();
    EXPECT_THAT(*get("/flights").body, HasSubstr("\"race\""));
    std::vector<std::string> left;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path("data/flights")))
        left.push_back(entry.path().filename().string());
    EXPECT_THAT(left, ElementsAre("race.json"));
}

TEST_F(Rest, ADataFolderThatHasGoneDoesNotLookEmpty) {
    constexpr const char* kFlight = R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})";
    ASSERT_EQ(send("PUT", "/flights/a", kFlight).status, 200);
    std::filesystem::rename(folder_.path("data"), folder_.path("elsewhere"));
    for (const char* path : {"/flights", "/flights/a", "/reports/a.bench"}) {
        const RestAnswer answer = get(path);
        expectProblem(answer, 503, "UNAVAILABLE");
        EXPECT_THAT(text(answer, "remedy"), StartsWith("see that it is mounted")) << path;
    }
    expectProblem(send("PUT", "/flights/b", kFlight), 503, "UNAVAILABLE");
    expectProblem(send("DELETE", "/flights/a", ""), 503, "UNAVAILABLE");
    expectProblem(send("PUT", "/scene", R"({"objects":[{"terrain":"a.eyt"}]})"), 503,
                  "UNAVAILABLE");
    std::filesystem::rename(folder_.path("elsewhere"), folder_.path("data"));
    EXPECT_EQ(get("/flights/a").status, 200);
}

TEST_F(Rest, AFolderThatCannotBeWrittenIsNamedAsTheCause) {
    using std::filesystem::perms;
    constexpr perms kReadOnly = perms::owner_read | perms::owner_exec | perms::group_read |
                                perms::group_exec | perms::others_read | perms::others_exec;
    std::filesystem::permissions(folder_.path(), kReadOnly);
    std::filesystem::permissions(folder_.path("data"), kReadOnly);
    {
        const test::WithoutRights other;
        const RestAnswer put = send("PUT", "/flights/a",
                                    R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})");
        expectProblem(put, 503, "UNAVAILABLE");
        EXPECT_EQ(text(put, "remedy"), "see that the data folder is writable and not full");
        expectProblem(get("/flights/a"), 404, "NOT_FOUND");
        EXPECT_THAT(*get("/flights").body, HasSubstr("\"names\": []"));
    }
    std::filesystem::permissions(folder_.path(), perms::owner_all);
    std::filesystem::permissions(folder_.path("data"), perms::owner_all);
}

TEST_F(Rest, AFlightThatIsDamagedOnTheServerIsNotTheCallersFault) {
    std::filesystem::create_directory(folder_.path("data/flights"));
    std::ofstream(folder_.path("data/flights/a.json")) << R"({"keys":[{"cam)";
    expectProblem(get("/flights/a"), 500, "DATA_LOSS");
    std::filesystem::remove_all(folder_.path("data/flights"));
    std::ofstream(folder_.path("data/flights")) << "no folder";
    expectProblem(get("/flights"), 503, "UNAVAILABLE");
}

TEST_F(Rest, FlightsThatCannotBeFlownAreNotKept) {
    expectProblem(send("PUT", "/flights/a", R"({"keys":[]})"), 400, "INVALID_ARGUMENT");
    for (const char* name : {"..%2fa", "a%00", "a.b", "%", "a%2Fb"})
        EXPECT_EQ(send("PUT", "/flights/" + std::string(name),
                       R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})")
                          .status /
                      100,
                  4)
            << name;
    EXPECT_THAT(*get("/flights").body, HasSubstr("\"names\": []"));
}

TEST_F(Rest, WithoutADataFolderNothingIsKept) {
    makeApi(std::nullopt);
    expectProblem(get("/flights"), 409, "FAILED_PRECONDITION");
    EXPECT_EQ(text(get("/flights"), "remedy"), "start it with --data DIR");
}

TEST_F(Rest, ThePageFindsItsStyleBelowAnyPathOfAProxy) {
    const auto has = [&](std::string path) { return *api_->rest().answer({"GET", path}).body; };
    EXPECT_THAT(has("/api"), HasSubstr("href=\"api/style.css\""));
    EXPECT_THAT(has("/api/"), HasSubstr("href=\"style.css\""));
    EXPECT_THAT(has("/api"), Not(HasSubstr("href=\"/")));
}

TEST_F(Rest, ThePageAndTheDocumentHaveEveryCall) {
    const RestAnswer page = api_->rest().answer({"GET", "/api"});
    EXPECT_EQ(page.contentType, "text/html; charset=utf-8");
    EXPECT_EQ(api_->rest().answer({"GET", "/api/style.css"}).status, 200);
    EXPECT_EQ(api_->rest().answer({"GET", "/api/else"}).status, 404);
    const Value document = json(get("/openapi.json"));
    EXPECT_EQ(member(document, "openapi").string_value(), "3.1.0");
    for (const Route& route : restRoutes()) {
        EXPECT_THAT(*page.body, HasSubstr("id=\"" + route.call->name() + "\""));
        const Value path = member(member(document, "paths"), route.rest.path());
        std::string method = route.rest.method();
        std::ranges::transform(method, method.begin(),
                               [](char c) { return static_cast<char>(c - 'A' + 'a'); });
        EXPECT_TRUE(path.struct_value().fields().contains(method)) << route.rest.path();
    }
}

TEST_F(Rest, TheDocumentTellsOfTokensAndHeaders) {
    const Value document = json(get("/openapi.json"));
    const Value token = member(member(member(document, "components"), "securitySchemes"), "token");
    EXPECT_EQ(member(token, "scheme").string_value(), "bearer");
    const Value uses = member(document, "security").list_value().values(0);
    EXPECT_TRUE(uses.struct_value().fields().contains("token"));
    const auto operation = [&](const std::string& path, const std::string& method) {
        return member(member(member(document, "paths"), path), method);
    };
    const auto parameters = [&](const std::string& path, const std::string& method) {
        std::vector<std::string> names;
        const Value all = member(operation(path, method), "parameters");
        for (const Value& parameter : all.list_value().values())
            if (member(parameter, "in").string_value() == "header")
                names.push_back(member(parameter, "name").string_value());
        return names;
    };
    EXPECT_THAT(parameters("/scene", "get"), ElementsAre("If-None-Match"));
    EXPECT_THAT(parameters("/flights/{name}", "put"), ElementsAre("If-Match", "If-None-Match"));
    EXPECT_THAT(parameters("/configuration", "patch"), ElementsAre("If-Match"));
    EXPECT_THAT(parameters("/imports", "post"), ElementsAre("Idempotency-Key"));
    const Value responses = member(operation("/image", "post"), "responses");
    const Value headers = member(member(responses, "200"), "headers");
    EXPECT_TRUE(headers.struct_value().fields().contains("Eyrie-Tau-Achieved"));
    EXPECT_TRUE(headers.struct_value().fields().contains("Eyrie-Complete"));
    EXPECT_TRUE(member(member(responses, "default"), "headers")
                    .struct_value()
                    .fields()
                    .contains("Retry-After"));
    EXPECT_THAT(member(operation("/scene", "put"), "description").string_value(),
                HasSubstr("For tokens of role control."));
    EXPECT_THAT(*api_->rest().answer({"GET", "/api"}).body,
                HasSubstr("Authorization: Bearer TOKEN"));
}

TEST(OpenApi, LeavesNothingUndocumented) { EXPECT_THAT(undocumented(), IsEmpty()); }

TEST(OpenApi, RefersOnlyToWhatItHas) {
    const std::string& document = openApiJson();
    constexpr std::string_view kRef = "\"$ref\":\"#/components/schemas/";
    int found = 0;
    for (std::size_t at = document.find(kRef); at != std::string::npos;
         at = document.find(kRef, at + 1)) {
        const std::size_t from = at + kRef.size();
        const std::string name = document.substr(from, document.find('"', from) - from);
        EXPECT_THAT(document, HasSubstr("\"" + name + "\":{\"type\":")) << name;
        ++found;
    }
    EXPECT_GT(found, 50);
}

TEST_F(Rest, IsTheSameOverGrpc) {
    CoordinatorService service;
    const auto listening =
        wire::listen({"unix:" + folder_.path("s")}, std::vector<grpc::Service*>{&service}).value();
    auto stub = v1::CoordinatorService::NewStub(
        grpc::CreateChannel("unix:" + folder_.path("s"), grpc::InsecureChannelCredentials()));
    const auto status = [&](auto&& call) {
        grpc::ClientContext context;
        context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
        return call(context);
    };
    v1::RenderImageRequest request;
    request.set_width(20);
    request.set_height(10);
    v1::RenderImageResponse response;
    const auto render = [&](grpc::ClientContext& context) {
        return stub->RenderImage(&context, request, &response);
    };
    EXPECT_EQ(status(render).error_code(), grpc::StatusCode::UNAVAILABLE);  // still starting
    service.use(api_->handlers());
    ASSERT_TRUE(status(render).ok());
    EXPECT_EQ(response.image(), *get("/image?width=20&height=10").body);
    request.set_width(0);
    EXPECT_EQ(status(render).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    listening.server->Shutdown();
    service.stop();
}

TEST_F(Rest, PicturesAreAsLargeOverGrpc) {
    frames_.setDraw([](const coordinator::FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {1, 2, 3, 255});
        frame.image = fabric::makeImage(request.drawnPart(), {1, 2, 3, 255}, true);
        return frame;
    });
    coordinator::Registry registry;
    const auto door =
        coordinator::GrpcService::start({"unix:" + folder_.path("s")}, registry).value();
    door->use(api_->handlers());
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(-1);
    auto stub = v1::CoordinatorService::NewStub(grpc::CreateCustomChannel(
        "unix:" + folder_.path("s"), grpc::InsecureChannelCredentials(), arguments));
    v1::RenderImageRequest request;
    request.set_width(1920);
    request.set_height(1080);
    request.set_format(v1::IMAGE_FORMAT_RAW);
    request.set_with_depth(true);
    v1::RenderImageResponse response;
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
    const grpc::Status status = stub->RenderImage(&context, request, &response);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(response.image().size(), 4U * 1920 * 1080);
    EXPECT_EQ(response.depth().size(), 4U * 1920 * 1080);
}

TEST_F(Rest, GrpcCallsInProgressAreAnsweredByAServerThatStops) {
    coordinator::Registry registry;
    const auto door =
        coordinator::GrpcService::start({"unix:" + folder_.path("s")}, registry).value();
    door->use(api_->handlers());
    auto stub = v1::CoordinatorService::NewStub(
        grpc::CreateChannel("unix:" + folder_.path("s"), grpc::InsecureChannelCredentials()));
    const auto render = [&] {
        grpc::ClientContext context;
        context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
        v1::RenderImageRequest request;
        request.set_width(20);
        request.set_height(10);
        v1::RenderImageResponse response;
        return stub->RenderImage(&context, request, &response).error_code();
    };
    frames_.hold(true);
    auto picture = std::async(std::launch::async, render);
    ASSERT_TRUE(frames_.waitForRequests(1));
    door->drain();
    EXPECT_EQ(render(), grpc::StatusCode::UNAVAILABLE);
    std::jthread stopping([&] { door->stop(); });
    frames_.hold(false);
    EXPECT_EQ(picture.get(), grpc::StatusCode::OK);
}

TEST_F(Rest, TellsTheHandlerThatAGrpcCallerHasGone) {
    CoordinatorService service;
    service.use(api_->handlers());
    const auto listening =
        wire::listen({"unix:" + folder_.path("s")}, std::vector<grpc::Service*>{&service}).value();
    auto stub = v1::CoordinatorService::NewStub(
        grpc::CreateChannel("unix:" + folder_.path("s"), grpc::InsecureChannelCredentials()));
    frames_.setPick([](const fabric::PickRequest&) {  // 512 of them take longer than anybody waits
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return fabric::Picked();
    });
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(1));
    v1::MeasureProfileRequest request;
    request.set_samples(512);
    v1::MeasureProfileResponse response;
    EXPECT_EQ(stub->MeasureProfile(&context, request, &response).error_code(),
              grpc::StatusCode::DEADLINE_EXCEEDED);
    listening.server->Shutdown();
    service.stop();
    EXPECT_LT(frames_.picks().size(), 512U);
}

}  // namespace
}  // namespace eyrie::api
