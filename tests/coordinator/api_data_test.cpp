// SPDX-License-Identifier: Apache-2.0
// What operations do with the data folder; programs are played by functions.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <future>
#include <mutex>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "coordinator/api/api.h"
#include "coordinator/api/data_sets.h"
#include "eyrie/v1/operation.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/service/eventually.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(DataSet, IsWhatTheProgramTellsOfIt) {
    const auto set = dataSetOf(
        R"({"kind": "terrain", "bounds": {"min": [1, 2, 3], "max": [4, 5, 6.5]}, "samples": 100,)"
        R"( "triangles": 162, "levels": 3, "crs": "", "bytes": 4711,)"
        R"( "errorMetres": {"coarsest": 9.5, "finest": 0.25}})");
    ASSERT_TRUE(set.ok()) << set.status();
    EXPECT_EQ(set->kind(), v1::DATA_SET_KIND_TERRAIN);
    EXPECT_EQ(set->bounds().max().z(), 6.5);
    EXPECT_EQ(set->samples(), 100);
    EXPECT_EQ(set->triangles(), 162);
    EXPECT_EQ(set->bytes(), 4711);
    EXPECT_EQ(set->finest_error_metres(), 0.25);
    for (const char* wrong : {"", "[]", "{}", "{\"kind\": \"scene\"}", "{\"kind\": 5}"})
        EXPECT_TRUE(absl::IsDataLoss(dataSetOf(wrong).status())) << wrong;
    EXPECT_TRUE(dataSetOf(R"({"kind":"mesh","bytes":-5,"bounds":7,"levels":1e300})").ok());
}

class NoConfiguration : public coordinator::ConfigurationAccess {
public:
    absl::Status withConfiguration(
        const std::function<absl::Status(coordinator::ActiveConfiguration&)>&) override {
        return absl::FailedPreconditionError("there is none");
    }
};

/// The data folder over REST.
class RestData : public testing::Test {
protected:
    RestData() {
        fs::create_directories(data() / "survey");
        std::ofstream(data() / "survey/dem.tif") << "heights";
        std::ofstream(folder_.path("secret.tif")) << "heights";
        fs::create_symlink(folder_.path("secret.tif"), data() / "link.tif");
        makeApi(1);
    }

    void makeApi(std::size_t imports) {
        Programs programs;
        programs.importsAtOnce = imports;
        programs.run = [this](const auto& arguments, const auto& folder, const auto& heard,
                              const auto& stop) {
            const std::lock_guard lock(mutex_);
            commands_.push_back(arguments);
            EXPECT_EQ(folder, fs::canonical(data()));
            return run_(arguments, heard, stop);
        };
        api_ = std::make_unique<Api>(ApiParts{frames_, configuration_, [](fabric::Scene) {},
                                              access::DataFolder::open(data()).value(), programs});
    }

    fs::path data() const { return folder_.path("data"); }

    RestAnswer ask(const std::string& method, const std::string& target,
                   const std::string& body = "", const std::string& key = "") const {
        RestRequest request{method, "/api/v1" + target, body, "application/json"};
        request.idempotencyKey = key;
        return api_->rest().answer(request);
    }
    static std::string member(const RestAnswer& answer, const std::string& name) {
        google::protobuf::Struct json;
        EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(*answer.body, &json).ok());
        return json.fields().contains(name) ? json.fields().at(name).string_value() : "";
    }
    std::string import(const std::string& more = "") const {
        return fmt::format(R"({{"sources":["survey/dem.tif"],"output":"survey/dem.eyt"{}}})", more);
    }
    std::string endOf(const std::string& id) const {
        const auto state = [&] { return member(ask("GET", "/operations/" + id), "state"); };
        EXPECT_TRUE(eventually([&] {
            return state() != "OPERATION_STATE_WAITING" && state() != "OPERATION_STATE_RUNNING";
        }));
        return state();
    }
    std::vector<std::string> filesOf(const fs::path& folder) const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder))
            names.push_back(entry.path().filename().string());
        std::ranges::sort(names);
        return names;
    }
    static absl::StatusOr<ProgramEnd> writeOutput(const std::vector<std::string>& arguments) {
        constexpr std::string_view kOutput = "--output=";
        const std::string path = arguments.back().substr(kOutput.size());
        EXPECT_TRUE(arguments.back().starts_with(kOutput));
        std::ofstream(path) << "terrain";
        std::ofstream(path + ".source") << "dem.tif";
        return ProgramEnd();
    }

    using Heard = std::function<void(std::string_view)>;
    test::TemporaryFolder folder_;
    coordinator::FakeFrameSource frames_;
    NoConfiguration configuration_;
    std::mutex mutex_;
    std::vector<std::vector<std::string>> commands_;
    std::function<absl::StatusOr<ProgramEnd>(const std::vector<std::string>&, const Heard&,
                                             const std::stop_token&)>
        run_ =
            [](const auto& arguments, const auto&, const auto&) { return writeOutput(arguments); };
    std::unique_ptr<Api> api_;
};

TEST_F(RestData, ScenesOfDamagedFilesAreRefused) {
    std::ofstream(data() / "survey/dem.eyt") << "no terrain";
    run_ = [](const auto&, const Heard& heard, const auto&) {
        heard("eyrie: ./survey/dem.eyt: this is no .eyt file; import it again");
        return ProgramEnd{false, 2, ""};
    };
    const RestAnswer answer = ask("PUT", "/scene", R"({"objects":[{"terrain":"survey/dem.eyt"}]})");
    EXPECT_EQ(answer.status, 409) << *answer.body;
    EXPECT_THAT(member(answer, "detail"),
                testing::AllOf(HasSubstr("scene.objects[0]: 'survey/dem.eyt' cannot be opened: "),
                               HasSubstr("this is no .eyt file")));
}

TEST_F(RestData, ScenesThatReachFartherThanCamerasAreRefused) {
    std::ofstream(data() / "survey/dem.eyt") << "a terrain";
    run_ = [](const auto&, const auto&, const auto&) {
        return ProgramEnd{false, 0,
                          R"({"kind":"terrain","bounds":{"min":[0,0,0],"max":[1000,900,10]}})"};
    };
    const auto show = [&](const std::string& transform) {
        return ask("PUT", "/scene",
                   R"({"objects":[{"terrain":"survey/dem.eyt","transform":)" + transform + "}]}");
    };
    EXPECT_EQ(show(R"({"translation":[1e13,0,0],"scale":1e10})").status, 200);
    for (const char* far : {R"({"translation":[0,-1.1e14,0]})", R"({"scale":1e307})",
                            R"({"translation":[1e14,0,0]})", R"({"scale":1.1e11})"}) {
        const RestAnswer answer = show(far);
        EXPECT_EQ(answer.status, 400) << far;
        EXPECT_THAT(member(answer, "detail"),
                    testing::AllOf(HasSubstr("'dem.eyt'"), HasSubstr("1e+14")));
        EXPECT_EQ(member(answer, "field"), "scene.objects[0]") << far;
    }
}

TEST_F(RestData, WhatWentWrongOnceIsNotHeldAgainstAFile) {
    std::ofstream(data() / "survey/dem.eyt") << "a terrain";
    const char* scene = R"({"objects":[{"terrain":"survey/dem.eyt"}]})";
    run_ = [](const auto&, const auto&, const auto&) { return ProgramEnd{true, 9, ""}; };
    EXPECT_EQ(ask("PUT", "/scene", scene).status, 409);
    run_ = [](const auto&, const auto&, const auto&) {
        return ProgramEnd{false, 0, R"({"kind":"terrain","samples":9})"};
    };
    EXPECT_EQ(ask("PUT", "/scene", scene).status, 200);
}

TEST_F(RestData, ImportsIntoTheDataFolder) {
    const RestAnswer answer = ask("POST", "/imports", import(R"(,"errorMetres":0.5)"), "one");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    EXPECT_EQ(member(answer, "id"), "one");
    EXPECT_EQ(member(answer, "kind"), "OPERATION_KIND_IMPORT_TERRAIN");
    EXPECT_EQ(endOf("one"), "OPERATION_STATE_DONE");
    EXPECT_THAT(filesOf(data() / "survey"), ElementsAre("dem.eyt", "dem.eyt.source", "dem.tif"));
    ASSERT_EQ(commands_.size(), 1U);
    EXPECT_EQ(commands_[0][1], "terrain");
    EXPECT_THAT(commands_[0], Contains("--error=0.5"));
    EXPECT_EQ(commands_[0][2], "./survey/dem.tif");
    EXPECT_THAT(*ask("GET", "/operations").body, HasSubstr("\"one\""));
    EXPECT_EQ(ask("DELETE", "/operations/one").status, 200);
    EXPECT_EQ(ask("GET", "/operations/one").status, 404);
}

TEST_F(RestData, ImportsOnceForOneKey) {
    ASSERT_EQ(ask("POST", "/imports", import(), "key").status, 200);
    endOf("key");
    EXPECT_EQ(member(ask("POST", "/imports", import(), "key"), "state"), "OPERATION_STATE_DONE");
    EXPECT_EQ(member(ask("POST", "/imports", import(R"(,"requestId":"key")")), "id"), "key");
    EXPECT_EQ(commands_.size(), 1U);
    EXPECT_EQ(ask("POST", "/imports", import(R"(,"replace":true)"), "key").status, 409);
    EXPECT_EQ(ask("POST", "/imports", import(R"(,"requestId":"other")"), "key").status, 400);
    const RestAnswer ofBytes = ask("POST", "/imports", import(), "key\xff");
    EXPECT_EQ(ofBytes.status, 400);
    EXPECT_THAT(member(ofBytes, "detail"),
                HasSubstr("requestId is 'key\\xff', which is not UTF-8"));
}

TEST_F(RestData, ReplacesNothingUnlessToldTo) {
    std::ofstream(data() / "survey/dem.eyt") << "old";
    const RestAnswer refused = ask("POST", "/imports", import());
    EXPECT_EQ(refused.status, 409);
    EXPECT_THAT(*refused.body, HasSubstr("set replace"));
    ASSERT_EQ(ask("POST", "/imports", import(R"(,"replace":true)"), "a").status, 200);
    EXPECT_EQ(endOf("a"), "OPERATION_STATE_DONE");
    EXPECT_EQ(fs::file_size(data() / "survey/dem.eyt"), 7U);
}

TEST_F(RestData, LeavesNothingOfWhatFailed) {
    const std::vector<std::string> before = filesOf(data() / "survey");
    const auto fails = [&](const std::string& id, const ProgramEnd& end, const std::string& line) {
        run_ = [end, line](const auto& arguments, const auto& heard, const auto&) {
            EXPECT_TRUE(writeOutput(arguments).ok());
            heard(R"({"stage": "reading", "fraction": 0.5})");
            heard(line);
            return end;
        };
        ASSERT_EQ(ask("POST", "/imports", import(), id).status, 200);
        EXPECT_EQ(endOf(id), "OPERATION_STATE_FAILED");
        EXPECT_EQ(filesOf(data() / "survey"), before);
    };
    fails("wrong", {false, 2, ""}, "eyrie: ./survey/dem.tif: is no raster");
    EXPECT_EQ(member(ask("GET", "/operations/wrong"), "problem"), "./survey/dem.tif: is no raster");
    fails("json", {false, 1, ""}, R"({"level":"error","message":"the disk is full"})");
    EXPECT_EQ(member(ask("GET", "/operations/json"), "problem"), "the disk is full");
    fails("crash", {true, 11, ""}, "");
    EXPECT_THAT(member(ask("GET", "/operations/crash"), "problem"), HasSubstr("signal 11"));
}

TEST_F(RestData, SaysWhatCouldNotBeMadeByItsNameInTheFolder) {
    run_ = [](const auto& arguments, const auto& heard, const auto&) {
        const std::string made = arguments.back().substr(std::string("--output=").size());
        heard(fmt::format("eyrie: {0}: write failed: No space left on device; see {0}", made));
        return ProgramEnd{false, 1, ""};
    };
    ASSERT_EQ(ask("POST", "/imports", import(), "full").status, 200);
    EXPECT_EQ(endOf("full"), "OPERATION_STATE_FAILED");
    EXPECT_EQ(member(ask("GET", "/operations/full"), "problem"),
              "survey/dem.eyt: write failed: No space left on device; see survey/dem.eyt");
}

TEST_F(RestData, SaysWhatIsWrongAndNotWhichHelpToRead) {
    run_ = [](const auto&, const auto& heard, const auto&) {
        heard("eyrie: --error: Value 2 not in range 0 to 1");
        heard("`eyrie import terrain --help` explains it");
        return ProgramEnd{false, 2, ""};
    };
    ASSERT_EQ(ask("POST", "/imports", import(), "refused").status, 200);
    EXPECT_EQ(endOf("refused"), "OPERATION_STATE_FAILED");
    EXPECT_EQ(member(ask("GET", "/operations/refused"), "problem"),
              "--error: Value 2 not in range 0 to 1");
}

TEST_F(RestData, TellsWhatAnImportLeftOut) {
    run_ = [](const auto& arguments, const auto&, const auto&) {
        EXPECT_TRUE(writeOutput(arguments).ok());
        const std::string made = arguments.back().substr(std::string("--output=").size());
        return ProgramEnd{
            false, 0,
            fmt::format(R"({{"levels": 3, "notes": ["12 posts are void", "see {}"]}})", made)};
    };
    const auto notes = [&](const std::string& id) {
        EXPECT_EQ(endOf(id), "OPERATION_STATE_DONE");
        v1::Operation operation;
        EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(
                        *ask("GET", "/operations/" + id).body, &operation)
                        .ok());
        return std::vector<std::string>(operation.notes().begin(), operation.notes().end());
    };
    ASSERT_EQ(ask("POST", "/imports", import(), "one").status, 200);
    EXPECT_THAT(notes("one"), ElementsAre("12 posts are void", "see survey/dem.eyt"));

    // What tells none, or nothing that can be read, has none.
    for (const char* output : {"", "no JSON", "[]", "{}", R"({"notes": 5})"}) {
        run_ = [output](const auto& arguments, const auto&, const auto&) {
            EXPECT_TRUE(writeOutput(arguments).ok());
            return ProgramEnd{false, 0, output};
        };
        const RestAnswer begun = ask("POST", "/imports", import(R"(,"replace":true)"));
        ASSERT_EQ(begun.status, 200) << *begun.body;
        EXPECT_THAT(notes(member(begun, "id")), IsEmpty()) << output;
    }
}

TEST_F(RestData, SaysThatWhatIsOnShowIsShownAnewOnceItIsSetAgain) {
    coordinator::Status status = frames_.status();
    status.scene.objects[0].path = fs::canonical(data()) / "survey/dem.eyt";
    frames_.setStatus(status);
    ASSERT_EQ(ask("POST", "/imports", import(), "one").status, 200);
    EXPECT_EQ(endOf("one"), "OPERATION_STATE_DONE");
    EXPECT_THAT(*ask("GET", "/operations/one").body, HasSubstr("set the scene again"));
    status.scene.objects[0].path = fs::canonical(data()) / "survey/dem.tif";
    frames_.setStatus(status);
    ASSERT_EQ(ask("POST", "/imports", import(R"(,"replace":true)"), "two").status, 200);
    EXPECT_EQ(endOf("two"), "OPERATION_STATE_DONE");
    EXPECT_THAT(*ask("GET", "/operations/two").body, Not(HasSubstr("set the scene again")));
}

TEST_F(RestData, LeavesNothingOfWhatIsCalledOff) {
    std::promise<void> begun;
    run_ = [&](const auto& arguments, const auto& heard, const auto& stop) {
        EXPECT_TRUE(writeOutput(arguments).ok());
        heard(R"({"stage": "reading", "fraction": 0.5})");
        begun.set_value();
        EXPECT_TRUE(eventually([&] { return stop.stop_requested(); }));
        return absl::CancelledError("stopped");
    };
    ASSERT_EQ(ask("POST", "/imports", import(), "a").status, 200);
    begun.get_future().wait();
    EXPECT_EQ(member(ask("GET", "/operations/a"), "stage"), "reading");
    EXPECT_EQ(ask("POST", "/operations/a/cancel", "{}").status, 200);
    EXPECT_EQ(endOf("a"), "OPERATION_STATE_CANCELLED");
    EXPECT_THAT(filesOf(data() / "survey"), ElementsAre("dem.tif"));
}

TEST_F(RestData, NamesNothingOutsideTheFolder) {
    for (const char* source :
         {"../secret.tif", "/etc/passwd", "link.tif", "survey/../../secret.tif",
          "https://evil.example/dem.tif", "survey", "nowhere.tif", ""}) {
        const RestAnswer answer = ask(
            "POST", "/imports", fmt::format(R"({{"sources":["{}"],"output":"a.eyt"}})", source));
        EXPECT_TRUE(answer.status >= 400 && answer.status < 500) << source << *answer.body;
        EXPECT_THAT(*answer.body, HasSubstr("sources[0]")) << source;
    }
    for (const char* output : {"../a.eyt", "/tmp/a.eyt", "a.tif", "survey", "none/a.eyt", ""})
        EXPECT_GE(ask("POST", "/imports",
                      fmt::format(R"({{"sources":["survey/dem.tif"],"output":"{}"}})", output))
                      .status,
                  400)
            << output;
    EXPECT_THAT(commands_, IsEmpty());
}

TEST_F(RestData, ImportsNothingThatItWouldNotList) {
    fs::create_directories(data() / ".work/deeper");
    fs::create_directory_symlink(data() / ".work", data() / "link");
    std::string deep = "1";
    for (int i = 2; i <= 16; ++i) deep += fmt::format("/{}", i);
    fs::create_directories(data() / deep);
    const auto importTo = [&](const std::string& output) {
        return ask("POST", "/imports",
                   fmt::format(R"({{"sources":["survey/dem.tif"],"output":"{}"}})", output));
    };
    for (const std::string output : {".hidden.eyt", "survey/.hidden.eym", ".work/a.eyt",
                                     ".work/deeper/a.eyt", "link/a.eyt", "..a.eyt"}) {
        const RestAnswer answer = importTo(output);
        EXPECT_EQ(answer.status, 400) << output;
        EXPECT_EQ(member(answer, "code"), "INVALID_ARGUMENT") << output;
        EXPECT_EQ(member(answer, "field"), "output") << output;
        EXPECT_THAT(member(answer, "remedy"), HasSubstr("choose a name without")) << output;
    }
    EXPECT_EQ(member(importTo(deep + "/a.eyt"), "remedy"), "choose a folder further up");
    EXPECT_THAT(commands_, IsEmpty());

    // And the next best are listed.
    run_ = [](const auto& arguments, const auto&, const auto&) {
        return arguments[0] == "import" ? writeOutput(arguments)
                                        : ProgramEnd{false, 0, R"({"kind":"terrain","samples":9})"};
    };
    const std::string deepest = fs::path(deep).parent_path() / "a.eyt";
    for (const std::string& output : {deepest, std::string("survey/a.hidden.eyt")}) {
        const RestAnswer answer = importTo(output);
        ASSERT_EQ(answer.status, 200) << *answer.body;
        EXPECT_EQ(endOf(member(answer, "id")), "OPERATION_STATE_DONE");
        EXPECT_THAT(*ask("GET", "/data-sets").body, HasSubstr(output));
    }
}

TEST_F(RestData, ImportsNothingIntoReports) {
    fs::create_directories(data() / "one.bench/deeper");
    fs::create_directory_symlink(data() / "one.bench", data() / "link");
    for (const char* output : {"one.bench/a.eyt", "one.bench/deeper/a.eyt", "link/a.eyt"}) {
        const RestAnswer answer =
            ask("POST", "/imports",
                fmt::format(R"({{"sources":["survey/dem.tif"],"output":"{}"}})", output));
        EXPECT_EQ(answer.status, 400) << output;
        EXPECT_EQ(member(answer, "field"), "output") << output;
        EXPECT_THAT(member(answer, "detail"), HasSubstr("'one.bench'")) << output;
    }
    EXPECT_THAT(commands_, IsEmpty());
}

TEST_F(RestData, RefusesWhatIsNotOfTheKind) {
    const auto isRefused = [&](const std::string& output, const std::string& more) {
        return ask("POST", "/imports",
                   fmt::format(R"({{"sources":["survey/dem.tif"],"output":"{}",{}}})", output,
                               more))
                   .status == 400;
    };
    EXPECT_TRUE(isRefused("a.eyt", R"("orient":true)"));
    EXPECT_TRUE(isRefused("a.eyt", R"("normals":"smooth")"));
    EXPECT_TRUE(isRefused("a.eym", R"("subdataset":"1")"));
    EXPECT_TRUE(isRefused("a.eym", R"("imagery":["survey/dem.tif"])"));
    EXPECT_TRUE(isRefused("a.eym", R"("errorMetres":1)"));
    EXPECT_TRUE(isRefused("a.eyt", R"("errorMetres":-1)"));
    for (const char* error : {"\"NaN\"", "\"Infinity\"", "0", "1e-7", "1.1e6"})
        EXPECT_TRUE(isRefused("a.eyt", fmt::format("\"errorMetres\":{}", error))) << error;
    EXPECT_EQ(ask("POST", "/imports", R"({"output":"a.eyt"})").status, 400);
}

TEST_F(RestData, ImportsOfMeshesReadNothingThatTheyNameBeyondTheDataFolder) {
    std::ofstream(data() / "house.obj") << "mtllib ../secret.mtl\n";
    const RestAnswer answer =
        ask("POST", "/imports", R"({"sources":["house.obj"],"output":"house.eym"})");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    EXPECT_EQ(endOf(member(answer, "id")), "OPERATION_STATE_DONE");
    EXPECT_THAT(commands_.back(), Contains("--within=."));
}

TEST_F(RestData, ImportsMeshesWithTheNormalsThatAreAskedFor) {
    std::ofstream(data() / "house.obj") << "v 0 0 0\n";
    const auto importWith = [&](const std::string& normals) {
        return ask("POST", "/imports",
                   fmt::format(R"({{"sources":["house.obj"],"output":"house.eym","replace":true,)"
                               R"("normals":"{}"}})",
                               normals));
    };
    for (const char* normals : {"auto", "smooth", "file", "crease=40", "crease=0.5"}) {
        const RestAnswer answer = importWith(normals);
        ASSERT_EQ(answer.status, 200) << *answer.body;
        EXPECT_EQ(endOf(member(answer, "id")), "OPERATION_STATE_DONE");
        EXPECT_EQ(commands_.back()[1], "mesh");
        EXPECT_THAT(commands_.back(), Contains(std::string("--normals=") + normals));
    }
    for (const char* normals : {"flat", "crease", "crease=", "crease=181", "crease=-1",
                                "crease=nan", "crease=4 --raw", "Smooth"}) {
        const RestAnswer answer = importWith(normals);
        EXPECT_EQ(answer.status, 400) << normals;
        EXPECT_THAT(*answer.body, HasSubstr("such as crease=40")) << normals;
    }
    EXPECT_EQ(commands_.size(), 5U);
    EXPECT_EQ(endOf(member(importWith(""), "id")), "OPERATION_STATE_DONE");
    EXPECT_THAT(commands_.back(), testing::Each(testing::Not(HasSubstr("--normals"))));
}

TEST_F(RestData, ImportsOneOfSeveralRastersOfAFile) {
    const auto importOf = [&](const std::string& source, const std::string& part) {
        std::ofstream(data() / source) << "some";
        return ask("POST", "/imports",
                   fmt::format(R"({{"sources":["{}"],"output":"a.eyt","replace":true,)"
                               R"("subdataset":"{}"}})",
                               source, part));
    };
    const auto named = [&](const std::string& source, const std::string& part) {
        const RestAnswer answer = importOf(source, part);
        EXPECT_EQ(answer.status, 200) << *answer.body;
        EXPECT_EQ(endOf(member(answer, "id")), "OPERATION_STATE_DONE");
        return commands_.back().at(2);
    };
    EXPECT_EQ(named("two.gpkg", "alps"), "GPKG:./two.gpkg:alps");
    EXPECT_EQ(named("two.TIF", "20"), "GTIFF_DIR:20:./two.TIF");
    EXPECT_EQ(named("two.nc", "z"), "NETCDF:\"./two.nc\":z");
    EXPECT_EQ(named("two.h5", "/group/z"), "HDF5:\"./two.h5\"://group/z");
    const std::size_t begun = commands_.size();
    for (const char* part : {"a:b", R"(a\":b)", R"(\n)", "/etc/passwd:x"})
        EXPECT_EQ(importOf("two.gpkg", part).status, 400) << part;
    for (const char* part : {"0", "00", "-1", "one", "1:./other.tif", "1 "})
        EXPECT_EQ(importOf("two.tif", part).status, 400) << part;
    EXPECT_EQ(importOf("x:y.nc", "z").status, 400);
    EXPECT_EQ(importOf("two.vrt", "z").status, 400);
    EXPECT_THAT(*ask("POST", "/imports",
                     R"({"sources":["../secret.tif"],"output":"b.eyt","subdataset":"1"})")
                     .body,
                HasSubstr("sources[0]"));
    EXPECT_EQ(commands_.size(), begun);
}

TEST_F(RestData, SaysWhereImportsAreOff) {
    makeApi(0);
    const RestAnswer answer = ask("POST", "/imports", import());
    EXPECT_EQ(answer.status, 409);
    EXPECT_THAT(member(answer, "remedy"), HasSubstr("--imports"));
}

TEST_F(RestData, ListsDataSetsAndAsksOnceAboutEach) {
    std::ofstream(data() / "survey/a.eyt") << "a";
    std::ofstream(data() / "b.eym") << "bb";
    fs::create_directory(data() / ".hidden");
    std::ofstream(data() / ".hidden/c.eym") << "c";
    fs::create_symlink(folder_.path("secret.tif"), data() / "d.eym");
    run_ = [](const auto& arguments, const auto& heard, const auto&) {
        if (arguments.back() == "./b.eym") {
            heard("eyrie: ./b.eym: is damaged");
            return ProgramEnd{false, 2, ""};
        }
        return ProgramEnd{false, 0, R"({"kind":"terrain","samples":9})"};
    };
    const RestAnswer answer = ask("GET", "/data-sets");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    EXPECT_THAT(*answer.body, HasSubstr("survey/a.eyt"));
    EXPECT_THAT(*answer.body, HasSubstr("./b.eym: is damaged"));
    EXPECT_EQ(commands_.size(), 2U);
    EXPECT_EQ(*ask("GET", "/data-sets").body, *answer.body);
    EXPECT_EQ(commands_.size(), 2U);
    std::ofstream(data() / "survey/a.eyt") << "longer";
    ask("GET", "/data-sets");
    EXPECT_EQ(commands_.size(), 3U);
    fs::rename(data(), folder_.path("elsewhere"));
    EXPECT_EQ(ask("GET", "/data-sets").status, 503);
    EXPECT_EQ(ask("POST", "/imports", import()).status, 503);
}

}  // namespace
}  // namespace eyrie::api
