// SPDX-License-Identifier: Apache-2.0
// Bench runs and their reports; the program is played by a function.
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/coordinator/api_fixture.h"
#include "tests/service/eventually.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ApiBench : public BothDoors {
protected:
    ApiBench() {
        Programs programs;
        programs.importsAtOnce = 1;
        programs.run = [this](const auto& arguments, const auto& folder, const auto& heard,
                              const auto& stop) {
            if (arguments[0] == "info")
                return absl::StatusOr<ProgramEnd>(ProgramEnd{false, 0, R"({"kind":"terrain"})"});
            commands_.push_back(arguments);
            scene_ = textOf(folder / "scene.json");
            return run_(folder, heard, stop);
        };
        makeApi({}, programs);
        std::ofstream(data() / "a.eyt") << "x";
    }

    using Heard = std::function<void(std::string_view)>;
    static absl::StatusOr<ProgramEnd> writeReport(const fs::path& folder, const Heard& heard,
                                                  const std::stop_token&) {
        heard(R"({"stage":"1 px, one process","fraction":0.5})");
        std::ofstream(folder / "summary.json") << R"({"runs":[]})";
        std::ofstream(folder / "frames.csv") << "asked\n";
        std::ofstream(folder / "index.html") << "<!doctype html>";
        return ProgramEnd();
    }

    static std::string textOf(const fs::path& path) {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    v1::Operation ended(const std::string& id) const {
        v1::Operation operation;
        EXPECT_TRUE(eventually([&] {
            operation = parsed<v1::Operation>(ask("GET", "/operations/" + id));
            return operation.state() != v1::OPERATION_STATE_WAITING &&
                   operation.state() != v1::OPERATION_STATE_RUNNING;
        }));
        return operation;
    }
    v1::OperationState run(const std::string& id, const std::string& more = "") const {
        const RestAnswer begun =
            ask("POST", "/bench-runs",
                fmt::format(R"({{"output":"one.bench","requestId":"{}"{}}})", id, more));
        EXPECT_EQ(begun.status, 200) << *begun.body;
        return ended(id).state();
    }
    int statusOf(const std::string& body) const { return ask("POST", "/bench-runs", body).status; }
    std::set<std::string> names() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(data()))
            names.insert(entry.path().filename().string());
        return names;
    }

    std::vector<std::vector<std::string>> commands_;
    std::string scene_;
    std::function<absl::StatusOr<ProgramEnd>(const fs::path&, const Heard&, const std::stop_token&)>
        run_ = writeReport;
};

TEST_F(ApiBench, MakesAReportThatCanBeFetched) {
    EXPECT_EQ(run("one", R"(,"tauPixels":[1,4],"frames":10,"width":320,"height":180)"),
              v1::OPERATION_STATE_DONE);
    EXPECT_EQ(ended("one").kind(), v1::OPERATION_KIND_BENCH);
    EXPECT_EQ(ended("one").output(), "one.bench");
    ASSERT_EQ(commands_.size(), 1U);
    EXPECT_THAT(commands_[0][0], "bench");
    for (const char* argument : {"--tau=1,4", "--frames=10", "--size=320x180", "--flight=orbit",
                                 "--repeats=5", "--renderers=0", "--progress-json"})
        EXPECT_THAT(commands_[0], Contains(argument));
    EXPECT_THAT(scene_, HasSubstr("hill.eyt")) << "what is drawn now";
    EXPECT_EQ(fs::status(data() / "one.bench/scene.json").permissions(),
              fs::perms::owner_read | fs::perms::owner_write)
        << "addresses in it are whole";
    EXPECT_THAT(names(), ElementsAre("a.eyt", "one.bench"));

    const RestAnswer summary = ask("GET", "/reports/one.bench");
    EXPECT_EQ(*summary.body, R"({"runs":[]})");
    EXPECT_EQ(summary.contentType, "application/vnd.eyrie.summary+json");
    const RestAnswer page = ask("GET", "/reports/one.bench?file=REPORT_FILE_PAGE");
    EXPECT_EQ(page.contentType, "text/html");
    EXPECT_THAT(page.headers, Contains(testing::Pair("Content-Disposition",
                                                     "attachment; filename=\"index.html\"")))
        << "a page that somebody made is not shown as this server's own";
    v1::GetReportRequest request;
    v1::GetReportResponse response;
    request.set_name("one.bench");
    request.set_file(v1::REPORT_FILE_FRAMES);
    EXPECT_TRUE(
        call([&](auto& context) { return stub_->GetReport(&context, request, &response); }).ok());
    EXPECT_EQ(response.content(), "asked\n");
}

TEST_F(ApiBench, DrawsDataOfTheFolderAlongAFlightThatIsKeptThere) {
    ASSERT_EQ(
        ask("PUT", "/flights/round", R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})")
            .status,
        200);
    run_ = [](const fs::path& folder, const Heard& heard, const std::stop_token& stop) {
        EXPECT_THAT(textOf(folder / "flight-round.json"), HasSubstr("-10"));
        return writeReport(folder, heard, stop);
    };
    EXPECT_EQ(run("a", R"(,"flight":"round","scene":{"objects":[{"terrain":"a.eyt"}]})"),
              v1::OPERATION_STATE_DONE);
    EXPECT_THAT(commands_.back(), Contains("--flight=flight-round.json"));
    EXPECT_THAT(scene_, HasSubstr(fs::canonical(data() / "a.eyt").string()));
}

TEST_F(ApiBench, MeasuresErrorsWhereTheyAreAskedFor) {
    run_ = [](const fs::path& folder, const Heard& heard, const std::stop_token& stop) {
        std::ofstream(folder / "errors.csv") << "asked,max\n";
        return writeReport(folder, heard, stop);
    };
    EXPECT_EQ(run("one", R"(,"withReference":true,"referenceFrames":3)"), v1::OPERATION_STATE_DONE);
    for (const char* argument :
         {"--reference", "--reference-frames=3", "--reference-memory=536870912"})
        EXPECT_THAT(commands_[0], Contains(argument));
    const RestAnswer errors = ask("GET", "/reports/one.bench?file=REPORT_FILE_ERRORS");
    EXPECT_EQ(*errors.body, "asked,max\n");
    EXPECT_EQ(errors.contentType, "text/csv");

    run_ = writeReport;
    EXPECT_EQ(run("two", R"(,"replace":true)"), v1::OPERATION_STATE_DONE);
    EXPECT_THAT(commands_[1], Not(Contains(StartsWith("--reference"))));
    const RestAnswer none = ask("GET", "/reports/one.bench?file=REPORT_FILE_ERRORS");
    EXPECT_EQ(none.status, 404);
    EXPECT_THAT(*none.body, HasSubstr("errors.csv"));
    EXPECT_EQ(run("three", R"(,"replace":true,"withReference":true,"budgetMilliseconds":[33])"),
              v1::OPERATION_STATE_DONE);
    for (const char* argument : {"--reference", "--budget-ms=33"})
        EXPECT_THAT(commands_[2], Contains(argument));
    for (const char* wrong :
         {R"("referenceFrames":0)", R"("withReference":true,"referenceFrames":1001)"})
        EXPECT_EQ(statusOf(fmt::format(R"({{"output":"o.bench",{}}})", wrong)), 400) << wrong;
}

TEST_F(ApiBench, ABrokenPromiseFailsAndLeavesItsReport) {
    const auto end = [](const fs::path& folder, const Heard& heard, const std::stop_token& stop) {
        EXPECT_TRUE(writeReport(folder, heard, stop).ok());
        heard("eyrie: tau 1: a surface is 1.5 px from where the source has it, and 1 was promised");
        return absl::StatusOr<ProgramEnd>(ProgramEnd{false, 1, ""});
    };
    run_ = end;
    EXPECT_EQ(run("one", R"(,"withReference":true)"), v1::OPERATION_STATE_FAILED);
    EXPECT_THAT(ended("one").problem(), HasSubstr("1.5 px from where the source has it"));
    EXPECT_EQ(ask("GET", "/reports/one.bench").status, 200);

    // Without one, what a program that failed has left is no report.
    EXPECT_EQ(run("two", R"(,"replace":true)"), v1::OPERATION_STATE_FAILED);
    EXPECT_THAT(names(), ElementsAre("a.eyt", "one.bench"));
    // Nor is what it has left before it came to the end.
    run_ = [](const fs::path& folder, const Heard&, const std::stop_token&) {
        std::ofstream(folder / "frames.csv") << "asked\n";
        return absl::StatusOr<ProgramEnd>(ProgramEnd{false, 1, ""});
    };
    fs::remove_all(data() / "one.bench");
    EXPECT_EQ(run("three", R"(,"withReference":true)"), v1::OPERATION_STATE_FAILED);
    EXPECT_THAT(names(), ElementsAre("a.eyt"));
}

TEST_F(ApiBench, NamesNothingOutsideTheDataFolder) {
    std::ofstream(folder_.path("secret.eyt")) << "x";
    fs::create_symlink(folder_.path("secret.eyt"), data() / "link.eyt");
    fs::create_directory(folder_.path("out.bench"));
    std::ofstream(folder_.path("out.bench") + "/summary.json") << "secret";
    fs::create_directory_symlink(folder_.path("out.bench"), data() / "link.bench");
    std::ofstream(data() / "summary.json") << "other";
    for (const std::string output :
         {"../out.bench", "/tmp/out.bench", "link.bench", "out", "", "none/a.bench", "a.eyt"}) {
        const int status = statusOf(fmt::format(R"({{"output":"{}","replace":true}})", output));
        EXPECT_EQ(status / 100, 4) << output;
    }
    for (const std::string file : {"../secret.eyt", "link.eyt", "/etc/passwd", "summary.json"})
        EXPECT_EQ(
            statusOf(fmt::format(
                R"({{"output":"o.bench","scene":{{"objects":[{{"terrain":"{}"}}]}}}})", file)) /
                100,
            4)
            << file;
    for (const char* flight : {"../a", "none", "--config", "a b"})
        EXPECT_EQ(statusOf(fmt::format(R"({{"output":"o.bench","flight":"{}"}})", flight)) / 100, 4)
            << flight;
    for (const char* report : {"../out.bench", "link.bench", "..%2fout.bench", "", ".", "%2e"}) {
        const RestAnswer answer = ask("GET", std::string("/reports/") + report);
        EXPECT_EQ(answer.status / 100, 4) << report;
        EXPECT_THAT(*answer.body, Not(HasSubstr("secret\""))) << report;
    }
    EXPECT_TRUE(commands_.empty());
}

TEST_F(ApiBench, AsksForNothingThatIsBeyondWhatItTakes) {
    for (const char* wrong :
         {R"("tauPixels":[0])", R"("tauPixels":["NaN"])", R"("frames":0)", R"("frames":10001)",
          R"("repeats":101)", R"("width":15)", R"("height":4097)", R"("renderers":9)",
          R"("renderers":-1)", R"("budgetMilliseconds":[0.5])",
          R"("tauPixels":[1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1])"}) {
        EXPECT_EQ(statusOf(fmt::format(R"({{"output":"o.bench",{}}})", wrong)), 400) << wrong;
    }
    EXPECT_TRUE(commands_.empty());
}

TEST_F(ApiBench, ReplacesAReportOnlyWhenToldTo) {
    ASSERT_EQ(run("a"), v1::OPERATION_STATE_DONE);
    EXPECT_EQ(statusOf(R"({"output":"one.bench","requestId":"b"})"), 409);
    std::ofstream(data() / "one.bench/errors.csv") << "of the first";
    std::ofstream(data() / "one.bench/flight-round.json") << "of the first";
    ASSERT_EQ(run("c", R"(,"replace":true)"), v1::OPERATION_STATE_DONE);
    EXPECT_FALSE(fs::exists(data() / "one.bench/errors.csv"));
    EXPECT_FALSE(fs::exists(data() / "one.bench/flight-round.json"));
    EXPECT_TRUE(fs::exists(data() / "one.bench/summary.json"));
    EXPECT_THAT(names(), ElementsAre("a.eyt", "one.bench"));
    std::ofstream(data() / "file.bench") << "x";
    EXPECT_EQ(statusOf(R"({"output":"file.bench","requestId":"d"})"), 409);
    fs::remove(data() / "file.bench");
    // Asked for once more, it is the same.
    EXPECT_EQ(run("c", R"(,"replace":true)"), v1::OPERATION_STATE_DONE);
    EXPECT_EQ(commands_.size(), 2U);
}

TEST_F(ApiBench, ReplacesNothingButAReport) {
    ASSERT_EQ(run("a"), v1::OPERATION_STATE_DONE);
    const auto refusal = [&](const std::string& output) {
        const RestAnswer answer =
            ask("POST", "/bench-runs", fmt::format(R"({{"output":"{}","replace":true}})", output));
        EXPECT_EQ(answer.status, 409) << *answer.body;
        return *answer.body;
    };
    for (const char* other : {"mesh.eym", "mesh.eym.source", "notes.txt", ".hidden"}) {
        const fs::path path = data() / "one.bench" / other;
        std::ofstream(path) << "not of a report";
        EXPECT_THAT(refusal("one.bench"), HasSubstr(fmt::format("holds '{}'", other)));
        EXPECT_EQ(textOf(path), "not of a report");
        fs::remove(path);
    }
    fs::create_directory(data() / "one.bench/errors.csv");
    EXPECT_THAT(refusal("one.bench"), HasSubstr("holds 'errors.csv'")) << "a folder of that name";
    fs::remove(data() / "one.bench/errors.csv");
    std::ofstream(data() / "file.bench") << "x";
    EXPECT_THAT(refusal("file.bench"), HasSubstr("it is no folder"));
    fs::create_directory(data() / "own.bench");
    std::ofstream(data() / "own.bench/scene.json") << "somebody's";
    EXPECT_THAT(refusal("own.bench"), HasSubstr("holds 'scene.json' and no summary.json"));
    EXPECT_EQ(commands_.size(), 1U);
    EXPECT_EQ(statusOf(R"({"output":"one.bench/two.bench"})"), 400) << "it would go with the other";
    EXPECT_EQ(run("b", R"(,"replace":true)"), v1::OPERATION_STATE_DONE);
}

TEST_F(ApiBench, KeepsWhatHasComeToItsPlaceMeanwhile) {
    ASSERT_EQ(run("a"), v1::OPERATION_STATE_DONE);
    const fs::path report = data() / "one.bench";
    run_ = [&](const fs::path& folder, const Heard& heard, const std::stop_token& stop) {
        std::ofstream(report / "mesh.eym") << "imported meanwhile";
        return writeReport(folder, heard, stop);
    };
    EXPECT_EQ(run("b", R"(,"replace":true)"), v1::OPERATION_STATE_FAILED);
    EXPECT_THAT(ended("b").problem(), HasSubstr("holds 'mesh.eym'"));
    EXPECT_EQ(textOf(report / "mesh.eym"), "imported meanwhile");
    EXPECT_TRUE(fs::exists(report / "summary.json"));
    EXPECT_THAT(names(), ElementsAre("a.eyt", "one.bench"));
}

TEST_F(ApiBench, AReportWhoseSuccessorCannotTakeItsPlaceGoesBackThere) {
    ASSERT_EQ(run("a"), v1::OPERATION_STATE_DONE);
    run_ = [](const fs::path& folder, const Heard&, const std::stop_token&) {
        fs::remove_all(folder);
        return absl::StatusOr<ProgramEnd>(ProgramEnd());
    };
    EXPECT_EQ(run("b", R"(,"replace":true)"), v1::OPERATION_STATE_FAILED);
    EXPECT_EQ(*ask("GET", "/reports/one.bench").body, R"({"runs":[]})");
    EXPECT_THAT(names(), ElementsAre("a.eyt", "one.bench"));
}

TEST_F(ApiBench, SaysWhatFailedInTheTermsOfTheRequest) {
    const std::string place = fs::canonical(data()).string();
    const std::vector<std::pair<std::string, std::string>> cases = {
        {place + "/a.eyt: its source " + place +
             "/dem.tif is not there, nor beside it; put it there, or name the source's files with "
             "--source",
         "a.eyt: its source dem.tif is not there, nor beside it; put it there"},
        {"m.ply: is not what " + place +
             "/m.eym was imported from; import it again, or name what it was with --source",
         "m.ply: is not what m.eym was imported from; import it again"},
        {"https://host" + place + "/dem.eym: the server answers 503",
         "https://host" + place + "/dem.eym: the server answers 503"},
        {"allow more with --reference-memory, or measure fewer --reference-frames, a smaller "
         "--size or a part of the scene",
         "allow more with --import-memory of the server, or measure fewer referenceFrames, a "
         "smaller width and height or a part of the scene"}};
    for (int i = 0; const auto& [said, told] : cases) {
        run_ = [&said = said](const fs::path&, const Heard& heard, const std::stop_token&) {
            heard("eyrie: " + said);
            return absl::StatusOr<ProgramEnd>(ProgramEnd{false, 2, ""});
        };
        const std::string id = fmt::format("case-{}", ++i);
        EXPECT_EQ(run(id, R"(,"withReference":true)"), v1::OPERATION_STATE_FAILED);
        EXPECT_EQ(ended(id).problem(), told);
    }
}

TEST_F(ApiBench, LeavesNothingOfWhatFailedOrWasCalledOff) {
    run_ = [](const fs::path& folder, const Heard& heard, const std::stop_token& stop) {
        EXPECT_TRUE(writeReport(folder, heard, stop).ok());
        heard("eyrie: no renderer can work on this machine");
        return ProgramEnd{false, 1, ""};
    };
    EXPECT_EQ(run("a"), v1::OPERATION_STATE_FAILED);
    EXPECT_EQ(ended("a").problem(), "no renderer can work on this machine");
    EXPECT_THAT(names(), ElementsAre("a.eyt"));
    run_ = [](const fs::path& folder, const Heard& heard,
              const std::stop_token& stop) -> absl::StatusOr<ProgramEnd> {
        EXPECT_TRUE(writeReport(folder, heard, stop).ok());
        EXPECT_TRUE(eventually([&] { return stop.stop_requested(); }));
        return absl::CancelledError("");
    };
    ASSERT_EQ(ask("POST", "/bench-runs", R"({"output":"one.bench","requestId":"b"})").status, 200);
    ASSERT_TRUE(eventually([&] {
        return parsed<v1::Operation>(ask("GET", "/operations/b")).stage() == "1 px, one process";
    }));
    EXPECT_EQ(parsed<v1::Operation>(ask("GET", "/operations/b")).stage_progress(), 0.5);
    EXPECT_EQ(ask("POST", "/operations/b/cancel", "{}").status, 200);
    EXPECT_EQ(ended("b").state(), v1::OPERATION_STATE_CANCELLED);
    EXPECT_TRUE(eventually([&] { return names().size() == 1; }));
}

}  // namespace
}  // namespace eyrie::api
