// SPDX-License-Identifier: Apache-2.0
// The program on data in an object store that wants to know who reads them.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/image_files.h"
#include "tests/support/program.h"
#include "tests/support/s3_server.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using std::chrono::seconds;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

constexpr const char* kDem = "/vsis3/bucket/dem.eyt";
constexpr const char* kBall = "/vsis3/bucket/ball.eym";
constexpr const char* kDemCamera =
    R"({"eye":[509000,5209000,20000],"target":[509000,5209000,0],"up":[0,1,0],"fovyDegrees":25})";
constexpr const char* kBallCamera =
    R"({"eye":[0,-4,1],"target":[0,0,0],"up":[0,0,1],"fovyDegrees":45})";

/// How often `part` occurs.
int countOf(const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

/// What this machine's user may read is no concern of the test's, nor is a way through a proxy.
void forgetOwnCredentials() {
    Words names;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string name = std::string(*entry).substr(0, std::string(*entry).find('='));
        if (name.starts_with("AWS_") || name.ends_with("_proxy") || name.ends_with("_PROXY"))
            names.push_back(name);
    }
    for (const std::string& name : names) unsetenv(name.c_str());
}

Words credentials(const std::string& keyId = test::S3Server::kKeyId,
                  const std::string& secret = test::S3Server::kSecret) {
    return {"AWS_ACCESS_KEY_ID=" + keyId, "AWS_SECRET_ACCESS_KEY=" + secret};
}

class ObjectStore : public testing::Test {
protected:
    static void SetUpTestSuite() {
        forgetOwnCredentials();
        data_ = std::make_unique<test::TemporaryFolder>();
        std::filesystem::create_directory(data_->path() / "bucket");
        const auto path = [](const char* name) { return data_->path(name); };
        ASSERT_TRUE(test::succeeded(
            {"synth", "terrain", "--size", "600", "--seed", "1", "-o", path("dem.tif")}));
        ASSERT_TRUE(
            test::succeeded({"import", "terrain", path("dem.tif"), "-o", local("dem.eyt")}));
        ASSERT_TRUE(test::succeeded(
            {"synth", "mesh", "--size", "20000", "--seed", "1", "-o", path("ball.ply")}));
        ASSERT_TRUE(test::succeeded({"import", "mesh", path("ball.ply"), "-o", local("ball.eym")}));
        server_ = std::make_unique<test::S3Server>(data_->path());
    }
    static void TearDownTestSuite() {
        server_.reset();
        data_.reset();
    }
    void SetUp() override { server_->grantAll(); }

    test::Outcome eyrie(const Words& arguments, const Words& environment,
                        const test::S3Server& server = *server_) const {
        Words all = {"AWS_S3_ENDPOINT=" + server.address(),
                     "AWS_HTTPS=NO",
                     "AWS_VIRTUAL_HOSTING=FALSE",
                     "HOME=" + folder_.path().string(),
                     "AWS_CONFIG_FILE=" + folder_.path("config"),
                     "AWS_SHARED_CREDENTIALS_FILE=" + folder_.path("credentials"),
                     "CPL_AWS_AUTODETECT_EC2=NO"};
        all.insert(all.end(), environment.begin(), environment.end());
        return test::eyrie(arguments, all);
    }

    test::Outcome render(const std::string& data, Words environment, const std::string& cache,
                         const Words& options = {}) const {
        environment.push_back(std::string("AWS_REGION=") + test::S3Server::kRegion);
        std::filesystem::remove(out_);
        std::filesystem::remove(depth_);
        const std::string camera =
            folder_.write("camera.json", data.ends_with(".eyt") ? kDemCamera : kBallCamera);
        Words arguments = {
            "render", data, "--camera", camera,    "--size", "320x180", "--tau",
            "0.1",    "-o", out_,       "--depth", depth_,   "--cache", folder_.path(cache)};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return eyrie(arguments, environment);
    }

    /// The picture's bytes with those of its depths.
    std::string picture(const std::string& data, const std::string& cache,
                        const Words& options = {}) const {
        const test::Outcome outcome = render(data, credentials(), cache, options);
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        EXPECT_THAT(outcome.errors, Not(AnyOf(HasSubstr("incomplete"), HasSubstr(" 0 triangles"))));
        return test::readFile(out_).value_or("") + test::readFile(depth_).value_or("");
    }

    static std::string local(const std::string& name) { return data_->path("bucket/" + name); }

    static std::unique_ptr<test::TemporaryFolder> data_;
    static std::unique_ptr<test::S3Server> server_;
    test::TemporaryFolder folder_;
    const std::string out_ = folder_.path("out.png");
    const std::string depth_ = folder_.path("out.pfm");
};

std::unique_ptr<test::TemporaryFolder> ObjectStore::data_;
std::unique_ptr<test::S3Server> ObjectStore::server_;

TEST_F(ObjectStore, IsDrawnFromAsLocalFilesAre) {
    const std::size_t before = server_->log().size();
    const auto requests = [&] { return server_->log().substr(before); };
    for (const std::string name : {"dem.eyt", "ball.eym"}) {
        const std::string url = "/vsis3/bucket/" + name;
        const std::string request = "GET /bucket/" + name + " bytes=";
        const std::string expected = picture(local(name), "none");
        EXPECT_TRUE(picture(url, "one") == expected) << name;
        const int ofOne = countOf(requests(), request);
        EXPECT_GE(ofOne, 4) << "header, index and pages";
        EXPECT_TRUE(picture(url, "two", {"--renderers", "2"}) == expected) << name;
        EXPECT_GE(countOf(requests(), request), 2 * ofOne)
            << "renderer processes ask with the credentials that they inherit";
    }
    EXPECT_EQ(countOf(requests(), "\n"), countOf(requests(), " 206 -\n")) << requests();
}

TEST_F(ObjectStore, OfAnotherRegionThanTheUsualOneIsFound) {
    const test::Outcome info = eyrie({"info", kDem}, credentials());
    EXPECT_EQ(info.exit, (test::Exit{0, 0})) << info.errors;
    EXPECT_THAT(server_->log(), HasSubstr(" 400 AuthorizationHeaderMalformed\n"));
}

TEST_F(ObjectStore, TakesTemporaryCredentialsWithTheirToken) {
    const test::S3Server server(data_->path(), "the/token+of/tests");
    Words environment = credentials();
    environment.insert(environment.end(), {std::string("AWS_REGION=") + test::S3Server::kRegion,
                                           "AWS_SESSION_TOKEN=the/token+of/tests"});
    const test::Outcome info = eyrie({"info", kBall}, environment, server);
    EXPECT_EQ(info.exit, (test::Exit{0, 0})) << info.errors;
    environment.back() = "AWS_SESSION_TOKEN=expired";
    const test::Outcome expired = eyrie({"info", kBall}, environment, server);
    EXPECT_EQ(expired.exit, (test::Exit{1, 0}));
    EXPECT_THAT(expired.errors, HasSubstr("the server denies access (HTTP 400: InvalidToken)"));
    EXPECT_THAT(expired.errors, HasSubstr("AWS_SESSION_TOKEN"));
}

/// Of who may not read them, and what the error says of why.
struct Stranger {
    Words environment;
    std::string why;
};

TEST_F(ObjectStore, TellsWhoMayNotReadWhatToDoAndNobodyTheSecret) {
    picture(kDem, "kept");
    const std::string wrong = "not/the+secret";
    for (const auto& [environment, why] :
         {Stranger{credentials(test::S3Server::kKeyId, wrong),
                   "the server denies access (HTTP 403: SignatureDoesNotMatch)"},
          Stranger{credentials("AKIANOBODY", wrong),
                   "the server denies access (HTTP 403: InvalidAccessKeyId)"},
          Stranger{{"AWS_NO_SIGN_REQUEST=YES"},
                   "the server denies access (HTTP 403: AccessDenied)"},
          Stranger{{}, "access needs credentials"}})
        for (const Words& options :
             {Words{}, Words{"--renderers", "2"}, Words{"--log-level", "debug"}}) {
            const auto begin = std::chrono::steady_clock::now();
            const test::Outcome outcome = render(kDem, environment, "kept", options);
            EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(20)) << why;
            EXPECT_EQ(outcome.exit, (test::Exit{1, 0})) << outcome.errors;
            EXPECT_THAT(outcome.errors, HasSubstr(std::string(kDem) + ": " + why));
            EXPECT_THAT(outcome.errors, HasSubstr("AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY"));
            EXPECT_THAT(outcome.output + outcome.errors, Not(HasSubstr(wrong)));
            EXPECT_FALSE(std::filesystem::exists(out_)) << "what is kept is not theirs, either";
        }
}

TEST_F(ObjectStore, NamesTheCredentialsOfTheWayThatWasTaken) {
    const std::string url = "http://" + server_->address() + "/bucket/dem.eyt";
    const test::Outcome outcome = eyrie({"info", url}, {});
    EXPECT_EQ(outcome.exit, (test::Exit{1, 0}));
    EXPECT_THAT(outcome.errors,
                HasSubstr(url + ": the server denies access (HTTP response code: 403"));
    EXPECT_THAT(outcome.errors, HasSubstr("GDAL_HTTP_USERPWD"));
}

TEST_F(ObjectStore, ThatBeginsToDenyCostsDetailOrThePicture) {
    const int before = countOf(server_->log(), "\n");
    picture(kDem, "whole");
    const int needed = countOf(server_->log(), "\n") - before;
    const auto whole = test::readPfm(depth_);
    ASSERT_TRUE(whole.ok()) << whole.status();
    bool wasRefused = false;
    bool wasCoarse = false;
    for (const int granted : {1, 3, needed / 2, needed - 4, needed - 1}) {
        server_->grant(granted);
        const test::Outcome outcome =
            render(kDem, credentials(), "cache" + std::to_string(granted));
        EXPECT_THAT(outcome.errors, HasSubstr("the server denies access (HTTP 403: AccessDenied)"));
        if (outcome.exit != test::Exit{0, 0}) {
            EXPECT_EQ(outcome.exit, (test::Exit{1, 0})) << outcome.errors;
            EXPECT_FALSE(std::filesystem::exists(out_));
            wasRefused = true;
            continue;
        }
        EXPECT_THAT(outcome.errors, HasSubstr(", incomplete\n"));
        wasCoarse = true;
        const auto coarse = test::readPfm(depth_);
        ASSERT_TRUE(coarse.ok()) << coarse.status();
        ASSERT_EQ(coarse->metres.size(), whole->metres.size());
        // Seen from above; the terrain is 2500 m high, and the coarsest data are 90 m off at most.
        for (std::size_t i = 0; i < coarse->metres.size(); ++i)
            ASSERT_NEAR(coarse->metres[i], whole->metres[i], 100) << i << " of " << granted;
    }
    EXPECT_TRUE(wasRefused);
    EXPECT_TRUE(wasCoarse);
}

}  // namespace
}  // namespace eyrie
