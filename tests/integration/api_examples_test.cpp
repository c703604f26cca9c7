// SPDX-License-Identifier: Apache-2.0
// Programs that ask a running `eyrie serve`: the examples, and every call of the API's document.
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <thread>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "eyrie/v1/coordinator_service.pb.h"
#include "tests/integration/grpc_examples.h"
#include "tests/support/http_client.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/told_services.h"
#include "tests/support/viewer_client.h"

namespace eyrie {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

/// One server of the demo's scene for all of these.
class ApiExamples : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new test::TemporaryFolder;
        std::filesystem::create_directory(folder_->path("data"));
        const test::Outcome made = test::eyrie({"synth", "terrain", "--size", "129", "--seed", "1",
                                                "-o", folder_->path("data/example.tif")});
        ASSERT_EQ(made.exit.status, 0) << made.errors;
        server_ = new test::Process(
            test::eyrieCommand({"serve", EYRIE_SOURCE_DIR "/demo/scene.json", "--listen",
                                "127.0.0.1:0", "--renderers", "2", "--data", folder_->path("data"),
                                "--grpc", "127.0.0.1:0", "--grpc-reflection"}),
            {"XDG_CACHE_HOME=" + folder_->path("cache")});
        ASSERT_TRUE(server_->waitForOutput("Eyrie is at http://", seconds(120)) &&
                    server_->waitForOutput("/\n", seconds(1)))
            << server_->errors();
        const std::string line = server_->output();
        url_ = line.substr(line.find("http://"));
        url_ = url_.substr(0, url_.find("/\n"));
        ASSERT_TRUE(test::eventually(seconds(120), [&] {
            const auto ready = test::httpGet(port(), "/readyz");
            return ready.ok() && ready->status == 200;
        })) << server_->errors();
    }

    static void TearDownTestSuite() {
        delete server_;
        delete folder_;
    }

    static test::Outcome ask(const std::string& interpreter, const std::string& script,
                             std::vector<std::string> arguments) {
        std::vector<std::string> command{"/usr/bin/env", interpreter, EYRIE_SOURCE_DIR "/" + script,
                                         url_};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return test::run(command, seconds(200));
    }

    static std::uint16_t port() {
        return static_cast<std::uint16_t>(std::atoi(&url_[url_.rfind(':') + 1]));
    }

    static std::string grpcAddress() {
        EXPECT_TRUE(server_->waitForOutput("Programs call by gRPC at ", seconds(60)));
        const std::string output = server_->output();
        const std::string address = output.substr(output.find("gRPC at ") + 8);
        return address.substr(0, address.find('\n'));
    }

    static std::string textOf(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    static std::string curl(std::vector<std::string> arguments, const std::string& path) {
        arguments.insert(arguments.begin(), {"/usr/bin/env", "curl", "--silent"});
        arguments.push_back(url_ + "/api/v1" + path);
        const test::Outcome outcome = test::run(arguments, seconds(60));
        EXPECT_EQ(outcome.exit.status, 0) << outcome.errors;
        return outcome.output;
    }

    static inline test::TemporaryFolder* folder_ = nullptr;
    static inline test::Process* server_ = nullptr;
    static inline std::string url_;
};

/// Somebody who looks, and takes what comes, in the session of that name.
class Somebody {
public:
    Somebody(std::uint16_t port, const std::string& session)
        : client_(test::ViewerClient::connect(port, "?session=" + session).value()),
          reading_([this](const std::stop_token& stop) {
              v1::ViewRequest view;
              view.set_sequence(1);
              view.set_width(64);
              view.set_height(48);
              view.set_tau_pixels(4);
              for (const double metres : {10.0, -10.0, 5.0}) view.mutable_camera()->add_eye(metres);
              for (int i = 0; i < 3; ++i) view.mutable_camera()->add_target(0);
              v1::ViewerRequest request;
              *request.mutable_view() = view;
              bool isOpen = client_->send(request).ok();
              while (isOpen && !stop.stop_requested()) {
                  const auto message = client_->receive(std::chrono::milliseconds(100));
                  isOpen = message.ok() || absl::IsDeadlineExceeded(message.status());
                  if (message.ok() && message->has_frame()) {
                      v1::ViewerRequest ack;
                      ack.mutable_frame_ack()->set_frame_number(message->frame().frame_number());
                      isOpen = client_->send(ack).ok();
                  }
              }
              wasSentAway_ = !isOpen;
          }) {}

    bool wasSentAway() const { return wasSentAway_; }

private:
    std::atomic<bool> wasSentAway_ = false;
    std::unique_ptr<test::ViewerClient> client_;
    std::jthread reading_;
};

TEST_F(ApiExamples, GrpcToolsMayAskWhichCallsThereAre) {
    const auto [code, told] = test::servicesToldAt(grpcAddress());
    EXPECT_EQ(code, grpc::StatusCode::OK);
    EXPECT_THAT(told, HasSubstr("eyrie.v1.CoordinatorService"));
}

TEST_F(ApiExamples, EveryCallAnswersAsDocumented) {
    const Somebody somebody(port(), "example");
    const test::Outcome outcome = ask("python3", "tests/integration/check_api.py", {});
    EXPECT_EQ(outcome.exit.status, 0) << outcome.output << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr(" 0 answers that are not as documented"));
}

TEST_F(ApiExamples, ProgramsCallByGrpcWhereTheServerSays) {
    const test::Outcome outcome = test::eyrie({"health", grpcAddress()});
    EXPECT_EQ(outcome.exit.status, 0) << outcome.errors;
}

TEST_F(ApiExamples, EveryCallIsMadeByItsExampleOverGrpc) {
    const Somebody somebody(port(), "example");
    const std::map<std::string, absl::Status> made = test::makeExamples(grpcAddress());
    const auto* const service =
        v1::GetStatusRequest::descriptor()->file()->FindServiceByName("CoordinatorService");
    for (int i = 0; i < service->method_count(); ++i)
        EXPECT_TRUE(made.contains(service->method(i)->name())) << service->method(i)->name();
    for (const auto& [call, status] : made) EXPECT_TRUE(status.ok()) << call << ": " << status;
}

TEST_F(ApiExamples, AStillComesWithDepthAndAPick) {
    const std::string picture = folder_->path("still.png");
    const test::Outcome outcome = ask("python3", "examples/render_still.py", {picture});
    EXPECT_EQ(outcome.exit.status, 0) << outcome.output << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr("of the pixels show something"));
    EXPECT_THAT(outcome.output, HasSubstr("in the middle: "));
    EXPECT_GT(std::filesystem::file_size(picture), 1000U);
}

TEST_F(ApiExamples, StatisticsAreToldAsFramesAreDrawn) {
    const Somebody somebody(port(), "told");
    const test::Outcome outcome = ask("python3", "examples/watch_statistics.py", {"1"});
    EXPECT_EQ(outcome.exit.status, 0) << outcome.output << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr("triangles, error at most"));
}

TEST_F(ApiExamples, SessionsAreSeenMovedAndClosed) {
    const Somebody somebody(port(), "tour");
    EXPECT_TRUE(test::eventually(seconds(60), [&] {
        return ask("python3", "examples/sessions.py", {}).output.find("tour: from 10, -10, 5") !=
               std::string::npos;
    }));
    const test::Outcome moved =
        ask("python3", "examples/sessions.py", {"tour", "0,-20,3", "0,0,0"});
    EXPECT_EQ(moved.exit.status, 0) << moved.errors;
    EXPECT_THAT(moved.output, HasSubstr("tour: from 0, -20, 3"));
    EXPECT_THAT(moved.output, HasSubstr("viewer 1 leads"));
    EXPECT_FALSE(somebody.wasSentAway());
    EXPECT_EQ(ask("python3", "examples/sessions.py", {"tour", "close"}).exit.status, 0);
    EXPECT_TRUE(test::eventually(seconds(20), [&] { return somebody.wasSentAway(); }));
    const test::Outcome gone = ask("python3", "examples/sessions.py", {"tour", "close"});
    EXPECT_THAT(gone.errors, HasSubstr("there is no session 'tour'"));
}

TEST_F(ApiExamples, ABenchRunLeavesAReport) {
    const std::string page = folder_->path("report.html");
    const test::Outcome outcome =
        ask("python3", "examples/run_bench.py", {"measured.bench", page, "4", "--reference"});
    EXPECT_EQ(outcome.exit.status, 0) << outcome.output << outcome.errors;
    EXPECT_THAT(outcome.output, testing::ContainsRegex("4 px: .* pixels, measured [0-9]"));
    EXPECT_GT(std::filesystem::file_size(page), 10'000U);
    const test::Outcome again =
        ask("python3", "examples/run_bench.py", {"measured.bench", page, "4"});
    EXPECT_NE(again.exit.status, 0);
    EXPECT_THAT(again.errors, HasSubstr("output 'measured.bench' is there already"));
    const std::set<std::string> names = test::namesIn(folder_->path("data/measured.bench"));
    for (const char* name :
         {"summary.json", "frames.csv", "errors.csv", "index.html", "scene.json"})
        EXPECT_TRUE(names.contains(name)) << name;
}

TEST_F(ApiExamples, ABenchRunThatIsCalledOffLeavesNothing) {
    curl({"--json", R"({"output":"long.bench","frames":10000,"requestId":"long"})"}, "/bench-runs");
    const auto told = [] { return curl({}, "/operations/long"); };
    EXPECT_TRUE(test::eventually(seconds(120), [&] {
        return told().find("\"stage\": \"0.5 px, one process\"") != std::string::npos;
    })) << told();
    curl({"--json", "{}"}, "/operations/long/cancel");
    EXPECT_TRUE(test::eventually(seconds(60), [&] {
        return told().find("STATE_CANCELLED") != std::string::npos;
    })) << told();
    for (const std::string& name : test::namesIn(folder_->path("data")))
        EXPECT_FALSE(name.starts_with(".eyrie") || name == "long.bench") << name;
}

TEST_F(ApiExamples, PicturesAreDrawnSeveralAtATime) {
    const std::string folder = folder_->path("turn");
    const test::Outcome outcome = ask("python3", "examples/turntable.py", {folder, "8"});
    EXPECT_EQ(outcome.exit.status, 0) << outcome.output << outcome.errors;
    for (const char* name : {"0000.jpg", "0007.jpg"})
        EXPECT_GT(std::filesystem::file_size(folder + "/" + name), 1000U);
}

TEST_F(ApiExamples, AFileIsImportedAndCanBeShown) {
    const test::Outcome outcome =
        ask("python3", "examples/import_data.py", {"example.tif", "imported.eyt"});
    EXPECT_EQ(outcome.exit.status, 0) << outcome.output << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr("imported.eyt: "));
    EXPECT_EQ(test::eyrie({"info", folder_->path("data/imported.eyt"), "--quiet"}).exit.status, 0);
    const test::Outcome again =
        ask("python3", "examples/import_data.py", {"example.tif", "imported.eyt"});
    EXPECT_NE(again.exit.status, 0);
    EXPECT_THAT(again.errors, HasSubstr("output 'imported.eyt' is there already"));
    const test::Outcome replaced =
        ask("python3", "examples/import_data.py", {"example.tif", "imported.eyt", "--replace"});
    EXPECT_EQ(replaced.exit.status, 0) << replaced.output << replaced.errors;
    const test::Outcome wrong =
        ask("python3", "examples/import_data.py", {"example.tif", "example.tif"});
    EXPECT_NE(wrong.exit.status, 0);
    EXPECT_THAT(wrong.errors, HasSubstr("must end in .eyt"));
}

TEST_F(ApiExamples, AFileIsImportedWithAPictureOverIt) {
    std::ofstream(folder_->path("data/ground.ppm"), std::ios::binary) << "P6 2 2 255\n"
                                                                      << std::string(12, 'a');
    curl({"--json", R"({"sources":["example.tif"],"imagery":["ground.ppm"],)"
                    R"("output":"draped.eyt","requestId":"draped"})"},
         "/imports");
    std::string told;
    EXPECT_TRUE(test::eventually(seconds(60), [&] {
        told = curl({}, "/operations/draped");
        return told.find("STATE_DONE") != std::string::npos;
    })) << told;
    EXPECT_THAT(told, HasSubstr("stretched over the whole terrain")) << "a note of the import";
    const test::Outcome info = test::eyrie({"info", folder_->path("data/draped.eyt"), "--json"});
    EXPECT_THAT(info.output, HasSubstr("\"imagery\": {"));
}

TEST_F(ApiExamples, AnImportThatIsCalledOffLeavesNothing) {
    ASSERT_TRUE(test::succeeded({"synth", "terrain", "--size", "4097", "--seed", "2", "--quiet",
                                 "-o", folder_->path("data/large.tif")}));
    const std::string begun =
        curl({"--json", R"({"sources":["large.tif"],"output":"large.eyt","requestId":"large"})"},
             "/imports");
    EXPECT_THAT(begun, HasSubstr("\"id\": \"large\""));
    const auto told = [] { return curl({}, "/operations/large"); };
    // In the middle of it, if this machine is not too fast for that.
    EXPECT_TRUE(test::eventually(seconds(60), [&] {
        const std::string now = told();
        return now.find("\"stage\": \"\"") == std::string::npos ||
               now.find("STATE_DONE") != std::string::npos;
    }));
    curl({"--json", "{}"}, "/operations/large/cancel");
    EXPECT_TRUE(test::eventually(seconds(60), [&] {
        return told().find("STATE_CANCELLED") != std::string::npos ||
               told().find("STATE_DONE") != std::string::npos;
    })) << told();
    const bool isDone = told().find("STATE_DONE") != std::string::npos;
    const std::set<std::string> names = test::namesIn(folder_->path("data"));
    EXPECT_EQ(names.contains("large.eyt"), isDone);
    for (const std::string& name : names) EXPECT_FALSE(name.starts_with(".eyrie")) << name;
}

TEST_F(ApiExamples, CurlMakesTheCallsMostAskedFor) {
    const std::string folder = folder_->path("curl");
    const test::Outcome outcome = ask("bash", "examples/curl.sh", {folder});
    EXPECT_EQ(outcome.exit.status, 0) << outcome.output << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr("scene: 304"));
    EXPECT_THAT(outcome.output, HasSubstr("\"field\""));
    for (const char* name : {"status.json", "configuration.json", "picture.png", "picture.jpg",
                             "evening.png", "upper.png", "pick.json", "data-sets.json",
                             "operations.json", "sessions.json", "frame.txt"})
        EXPECT_GT(std::filesystem::file_size(folder + "/" + name), 10U) << name;
    for (const auto& [name, begin] :
         {std::pair("picture.png", "\x89PNG"), std::pair("picture.jpg", "\xff\xd8\xff"),
          std::pair("evening.png", "\x89PNG"), std::pair("upper.png", "\x89PNG")})
        EXPECT_THAT(textOf(folder + "/" + name), testing::StartsWith(begin)) << name;
}

/// What the first who connects asks for; the answer is 401.
class Stranger {
public:
    Stranger() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        auto* const generic = reinterpret_cast<sockaddr*>(&address);
        EXPECT_EQ(::bind(socket_, generic, size), 0);
        EXPECT_EQ(::listen(socket_, 8), 0);
        EXPECT_EQ(::getsockname(socket_, generic, &size), 0);
        url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
        answering_ = std::jthread([this] { answer(); });
    }
    ~Stranger() { ::close(socket_); }

    const std::string& url() const { return url_; }

    /// Once who asked has ended.
    const std::string& asked() {
        ::shutdown(socket_, SHUT_RDWR);
        answering_.join();
        return asked_;
    }

private:
    void answer() {
        const int peer = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
        char part[4096];
        ssize_t size = 0;
        while (asked_.find("\r\n\r\n") == std::string::npos &&
               (size = ::recv(peer, part, sizeof part, 0)) > 0)
            asked_.append(part, static_cast<std::size_t>(size));
        const std::string text =
            "HTTP/1.1 401 Unauthorized\r\nContent-Length: 31\r\nConnection: close\r\n\r\n"
            "{\"title\":\"No\",\"detail\":\"token\"}";
        ::send(peer, text.data(), text.size(), MSG_NOSIGNAL);
        ::close(peer);
    }

    const int socket_;
    std::string url_;
    std::string asked_;
    std::jthread answering_;
};

TEST(Examples, SayInALineThatTheServerDoesNotAnswer) {
    const test::TemporaryFolder folder;
    const std::string place = folder.path("out");
    for (const std::vector<std::string>& example :
         std::vector<std::vector<std::string>>{{"render_still.py", place},
                                               {"turntable.py", place},
                                               {"watch_statistics.py"},
                                               {"sessions.py"},
                                               {"import_data.py", "a.tif", "a.eyt"},
                                               {"run_bench.py", "a.bench", place}}) {
        std::vector<std::string> command{"/usr/bin/env", "python3",
                                         EYRIE_SOURCE_DIR "/examples/" + example[0],
                                         "http://127.0.0.1:1"};  // nobody listens on port 1
        command.insert(command.end(), example.begin() + 1, example.end());
        const test::Outcome outcome = test::run(command, seconds(60));
        EXPECT_EQ(outcome.exit.status, 1) << example[0];
        EXPECT_THAT(outcome.errors, testing::StartsWith("http://127.0.0.1:1 does not answer: "))
            << example[0];
    }
}

TEST(Examples, SayWhyThereIsNothingToDraw) {
    const test::TemporaryFolder folder;
    test::Process server(test::eyrieCommand({"serve", "--data", folder.path().string(), "--listen",
                                             "127.0.0.1:0", "--renderers", "1"}));
    ASSERT_TRUE(server.waitForOutput("Eyrie is at http://", seconds(120)) &&
                server.waitForOutput("/\n", seconds(5)))
        << server.errors();
    std::string url = server.output();
    url = url.substr(url.find("http://"));
    url = url.substr(0, url.find("/\n"));
    for (const char* example : {"render_still.py", "turntable.py"}) {
        const test::Outcome outcome = test::run(
            {"/usr/bin/env", "python3", EYRIE_SOURCE_DIR "/examples/" + std::string(example), url,
             folder.path("out")},
            seconds(60));
        EXPECT_EQ(outcome.exit.status, 1) << example;
        EXPECT_THAT(outcome.errors, testing::Not(HasSubstr("Traceback"))) << example;
        EXPECT_GT(outcome.errors.size(), 10U) << example;
    }
}

TEST(Examples, SayHowTheyAreCalledWhereANumberIsNone) {
    const test::TemporaryFolder folder;
    const std::string place = folder.path("out");
    for (const std::vector<std::string>& example :
         std::vector<std::vector<std::string>>{{"turntable.py", place, "many"},
                                               {"turntable.py", place, "-3"},
                                               {"watch_statistics.py", "many"},
                                               {"sessions.py", "tour", "0,0,up", "0,0,0"},
                                               {"sessions.py", "tour", "shut"},
                                               {"run_bench.py", "a.bench", place, "1,fine"},
                                               {"run_bench.py", "a.bench", "--reference"}}) {
        std::vector<std::string> command{"/usr/bin/env", "python3",
                                         EYRIE_SOURCE_DIR "/examples/" + example[0],
                                         "http://127.0.0.1:1"};
        command.insert(command.end(), example.begin() + 1, example.end());
        const test::Outcome outcome = test::run(command, seconds(60));
        EXPECT_EQ(outcome.exit.status, 1) << example[0];
        EXPECT_THAT(outcome.errors, HasSubstr(example[0] + " http://127.0.0.1:8080")) << example[0];
        EXPECT_THAT(outcome.errors, testing::Not(HasSubstr("Traceback"))) << example[0];
    }
}

TEST(Examples, BringTheTokenOfTheirEnvironment) {
    const test::TemporaryFolder folder;
    const std::string place = folder.path("out");
    for (const std::vector<std::string>& example :
         std::vector<std::vector<std::string>>{{"python3", "render_still.py", place},
                                               {"python3", "turntable.py", place},
                                               {"python3", "watch_statistics.py"},
                                               {"python3", "sessions.py"},
                                               {"bash", "curl.sh", place}}) {
        Stranger stranger;
        std::vector<std::string> command{
            "/usr/bin/env", example[0], EYRIE_SOURCE_DIR "/examples/" + example[1], stranger.url()};
        command.insert(command.end(), example.begin() + 2, example.end());
        test::run(command, seconds(60), {"EYRIE_TOKEN=view-0123456789abcdef"});
        EXPECT_THAT(stranger.asked(), HasSubstr("Authorization: Bearer view-0123456789abcdef\r\n"))
            << example[1];
    }
}

}  // namespace
}  // namespace eyrie
