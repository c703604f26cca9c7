// SPDX-License-Identifier: Apache-2.0
// What programs set outlives the coordinator, by a file of its data folder.
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <memory>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "coordinator/api/api.h"
#include "coordinator/api/file_lock.h"
#include "coordinator/api/state_file.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/coordinator.h"
#include "eyrie/v1/kept_state.pb.h"
#include "tests/service/eventually.h"
#include "tests/support/captured_log.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/without_rights.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kSet =
    R"({"heads":[{"observer":"me","roomFromHead":[1,0,0,0.25, 0,1,0,0, 0,0,1,0]}],)"
    R"("layouts":[{"canvas":"wall","layout":"wide"}],)"
    R"("equalizers":[{"equalizer":0,"frozen":true}]})";

config::Configuration configuration() {
    config::Findings findings;
    config::Configuration configuration = config::readEqc(
        "config { appNode { pipe { window { channel { name \"a\" } } } "
        "pipe { window { channel { name \"b\" } } } } observer { name \"me\" } "
        "layout { name \"plain\" view { observer \"me\" } } layout { name \"wide\" view { } } "
        "canvas { name \"wall\" layout \"plain\" layout \"wide\" segment { channel \"a\" } } "
        "compound { channel ( segment 0 view 0 ) load_equalizer { mode 2D } "
        "compound { } compound { channel \"b\" outputframe { } } "
        "inputframe { name \"frame.b\" } } }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

class KeptState : public testing::Test {
protected:
    KeptState() {
        std::filesystem::create_directory(data());
        std::ofstream(data() / "a.eym") << "a mesh";
        options_.dataFolder = data();
        options_.scene.objects.push_back({"started with",
                                          fabric::ObjectKind::Mesh,
                                          "/elsewhere/first.eym",
                                          fabric::Mat4(1.0),
                                          {}});
        options_.configuration = configuration();
        options_.configurationFile = "/etc/wall.eqc";
        start();
    }

    std::filesystem::path data() const { return folder_.path("data"); }
    std::filesystem::path file() const { return data() / "state.json"; }

    void start() {
        coordinator_.reset();
        coordinator_ = Coordinator::start(options_).value();
    }

    int send(const std::string& method, const std::string& target, const std::string& body) const {
        return coordinator_->api()
            .rest()
            .answer({method, "/api/v1" + target, body, "application/json", ""})
            .status;
    }
    std::string get(const std::string& target) const {
        return *coordinator_->api().rest().answer({"GET", "/api/v1" + target, "", "", ""}).body;
    }

    void setScene() const {
        ASSERT_EQ(send("PUT", "/scene", R"({"objects":[{"mesh":"a.eym","name":"set later"}]})"),
                  200);
    }
    void setConfiguration() const { ASSERT_EQ(send("PATCH", "/configuration", kSet), 200); }

    void expectConfigurationIsSet() const {
        const std::string state = get("/configuration");
        EXPECT_THAT(state, HasSubstr("0.25"));
        EXPECT_THAT(state, HasSubstr(R"("frozen": true)"));
        EXPECT_EQ(coordinator_->frames().status().canvases.front().layout, "wide");
    }
    void expectConfigurationIsAsWritten() const {
        const std::string state = get("/configuration");
        EXPECT_THAT(state, Not(HasSubstr("0.25")));
        EXPECT_THAT(state, Not(HasSubstr(R"("frozen": true)")));
        EXPECT_EQ(coordinator_->frames().status().canvases.front().layout, "plain");
    }
    void expectScene(const std::string& name) const {
        EXPECT_EQ(coordinator_->frames().status().scene.objects.front().name, name);
    }

    v1::KeptState inFile() const {
        std::ifstream stream(file());
        const std::string json(std::istreambuf_iterator<char>(stream), {});
        v1::KeptState state;
        EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(json, &state).ok());
        return state;
    }
    std::string sceneInFile() const { return inFile().scene().scene().objects(0).name(); }
    /// All is written when it has ended.
    bool keepsAScene() {
        coordinator_.reset();
        return inFile().scene().has_scene();
    }

    test::TemporaryFolder folder_;
    CoordinatorOptions options_;
    std::unique_ptr<Coordinator> coordinator_;
};

TEST_F(KeptState, IsThereAgainAfterARestart) {
    setScene();
    setConfiguration();
    start();
    expectScene("set later");
    expectConfigurationIsSet();
    EXPECT_THAT(get("/scene"), HasSubstr(R"("a.eym")"));
    start();  // nothing was set meanwhile
    expectScene("set later");
    expectConfigurationIsSet();
}

TEST_F(KeptState, IsOfASceneThatIsSetOnceTheDataAreThere) {
    setScene();
    const fabric::Scene first = std::exchange(options_.scene, {});
    start();
    ASSERT_TRUE(coordinator_->setScene(first).ok());
    expectScene("set later");
}

TEST_F(KeptState, IsOfASceneThatIsSetWhereTheCommandLineHasNone) {
    options_.scene = {};
    start();
    ASSERT_TRUE(coordinator_->setScene({}).ok());
    setScene();
    start();
    ASSERT_TRUE(coordinator_->setScene({}).ok());
    expectScene("set later");
}

TEST_F(KeptState, GivesWayToAnotherSceneOfTheCommandLine) {
    setScene();
    setConfiguration();
    options_.scene.objects.front().name = "started with instead";
    start();
    expectScene("started with instead");
    expectConfigurationIsSet();
}

/// As a mesh is that shares no coordinates with the terrain beside it.
TEST_F(KeptState, IsThereAgainWhereTheCommandLinesScenePlacesItsDataElsewhere) {
    const fabric::Scene asNamed = std::exchange(options_.scene, {});
    const auto startPlaced = [&](double metres) {
        fabric::Scene placed = asNamed;
        placed.objects.front().worldFromObject[3][0] = metres;
        start();
        ASSERT_TRUE(coordinator_->setScene(placed, asNamed).ok());
    };
    startPlaced(1);
    setScene();
    startPlaced(2);
    expectScene("set later");
}

TEST_F(KeptState, OfEarlierVersionsIsReadWhereTheCommandLinesSceneIsPlacedAsItWas) {
    const fabric::Scene asNamed = options_.scene;
    options_.scene.objects.front().worldFromObject[3][0] = 1;
    start();
    setScene();
    const fabric::Scene placed = std::exchange(options_.scene, {});
    start();
    ASSERT_TRUE(coordinator_->setScene(placed, asNamed).ok());
    expectScene("set later");
}

TEST_F(KeptState, GivesWayToAnotherConfigurationOfTheCommandLine) {
    setScene();
    setConfiguration();
    options_.configurationFile = "/etc/another.eqc";
    start();
    expectScene("set later");
    expectConfigurationIsAsWritten();
}

TEST_F(KeptState, EndsWhereTheCommandLinesSceneIsSetAgain) {
    setScene();
    ASSERT_TRUE(keepsAScene());
    start();
    ASSERT_EQ(send("PUT", "/scene",
                   R"({"objects":[{"mesh":"/elsewhere/first.eym","name":"started with",)"
                   R"("colour":[0,0,0]}]})"),
              200);
    EXPECT_FALSE(keepsAScene());
}

/// Of colours that a scene does not say, numbers of another kind are told: these round.
TEST_F(KeptState, EndsWhereTheCommandLinesSceneIsSetAsItIsTold) {
    std::filesystem::create_directory_symlink(data(), folder_.path("link"));
    for (const char* const path : {"/elsewhere/first.eym", "link/a.eym"}) {
        options_.scene.objects.front().path =
            *path == '/' ? path : (std::filesystem::path(folder_.path("")) / path).string();
        start();
        const std::string told = get("/scene");
        setScene();
        ASSERT_EQ(send("PUT", "/scene", told), 200) << told;
        EXPECT_FALSE(keepsAScene()) << path;
    }
}

TEST_F(KeptState, HasItsFilesByTheirNamesWhereTheCommandLineGoesByALink) {
    std::filesystem::create_directory_symlink(data(), folder_.path("link"));
    options_.scene.objects.front().path = folder_.path("link") + "/a.eym";
    start();
    EXPECT_THAT(get("/scene"), HasSubstr(R"("mesh": "a.eym")"));
}

TEST_F(KeptState, HasNoSceneOfTheCommandLinesFilesAsTheOtherKind) {
    const char* const asTerrain = R"({"objects":[{"terrain":"/elsewhere/first.eym"}]})";
    EXPECT_EQ(send("PUT", "/scene", asTerrain), 400);
    std::ofstream(data() / "a.eyt") << "a terrain";
    const auto refusalOf = [this](const char* scene) {
        return *coordinator_->api()
                    .rest()
                    .answer({"PUT", "/api/v1/scene", scene, "application/json", ""})
                    .body;
    };
    EXPECT_THAT(refusalOf(R"({"objects":[{"mesh":"a.eyt"}]})"),
                HasSubstr("'a.eyt' is a terrain, and named as a mesh"));
    EXPECT_THAT(refusalOf(asTerrain),
                HasSubstr("scene.objects[0]: '/elsewhere/first.eym' is a mesh"));
    expectScene("started with");
    start();
    expectScene("started with");
}

TEST_F(KeptState, IsLeftOutWhereItsFilesAreGone) {
    setScene();
    std::filesystem::remove(data() / "a.eym");
    start();
    expectScene("started with");
}

TEST_F(KeptState, ThatIsLeftOutIsToldWithWhatIsShownInItsPlace) {
    const auto told = [&] {
        const test::CapturedLog log;
        start();
        EXPECT_TRUE(coordinator_->setScene(options_.scene).ok());
        coordinator_.reset();
        return log.text();
    };
    setScene();
    std::filesystem::remove(data() / "a.eym");
    EXPECT_THAT(told(), HasSubstr("the scene of the command line is shown, and not the scene that "
                                  "was set: "));
    options_.scene = {};
    const std::string without = told();
    EXPECT_THAT(without, HasSubstr("nothing is shown, and not the scene that was set: "));
    EXPECT_THAT(without, Not(HasSubstr("of the command line")));
}

TEST_F(KeptState, IsReadByItsOwnerAlone) {
    using std::filesystem::perms;
    coordinator_.reset();
    std::ofstream(file()) << "{}";  // as versions before wrote it, for all to read
    start();
    setScene();
    coordinator_.reset();
    EXPECT_EQ(std::filesystem::status(file()).permissions(),
              perms::owner_read | perms::owner_write);
}

TEST_F(KeptState, ThatIsDamagedIsSetAside) {
    setScene();
    setConfiguration();
    coordinator_.reset();
    std::ifstream kept(file());
    const std::string whole(std::istreambuf_iterator<char>(kept), {});
    for (std::size_t bytes = 0; bytes + 2 < whole.size(); bytes += 7) {  // it ends in "}\n"
        std::ofstream(file()) << whole.substr(0, bytes);
        start();
        expectScene("started with");
        expectConfigurationIsAsWritten();
        EXPECT_FALSE(std::filesystem::exists(file())) << bytes;
        EXPECT_EQ(std::filesystem::file_size(data() / "state.json.damaged"), bytes);
        coordinator_.reset();
    }
    std::filesystem::remove(data() / "state.json.damaged");
    std::filesystem::create_directory(file());
    start();
    expectScene("started with");
    setScene();
    start();
    expectScene("set later");
}

TEST_F(KeptState, HasNothingThatCouldNotBeSet) {
    coordinator_.reset();
    std::ofstream(file()) << R"({"configuration":{"file":"/etc/wall.eqc","heads":[)"
                             R"({"observer":"me","roomFromHead":[7,0,0,0, 0,1,0,0, 0,0,1,0]}],)"
                             R"("observers":[{"observer":"me","eyeBase":-1}],)"
                             R"("views":[{"layout":"plain","view":"0","modelUnit":"NaN"}],)"
                             R"("equalizers":[{"name":"load.0","tuning":{"damping":9}}],)"
                             R"("layouts":[{"canvas":"wall","first":"plain","layout":"none"}]}})";
    start();
    expectConfigurationIsAsWritten();
    EXPECT_THAT(get("/configuration"), Not(HasSubstr("NaN")));
}

TEST_F(KeptState, ThatCannotBeSetIsToldInWords) {
    coordinator_.reset();
    std::ofstream(file()) << R"({"configuration":{"file":"/etc/wall.eqc","heads":[)"
                             R"({"observer":"me","roomFromHead":[1]}]}})";
    const test::CapturedLog log;
    start();
    coordinator_.reset();
    EXPECT_THAT(log.text(), HasSubstr("something that was set before is left out: roomFromHead"));
}

TEST_F(KeptState, ThatIsNoObjectIsSetAsideAndToldSo) {
    for (const char* whole : {"null", "[]"}) {
        coordinator_.reset();
        std::ofstream(file()) << whole;
        const test::CapturedLog log;
        start();
        coordinator_.reset();
        EXPECT_THAT(log.text(), HasSubstr("what was set before is lost: the whole must be an "
                                          "object in braces; it is state.json.damaged now"))
            << whole;
    }
}

KeptConfiguration lookingAside(double metres) {
    KeptConfiguration kept;
    kept.settings.heads["me"] = fabric::Mat4(1);
    kept.settings.heads["me"][3][0] = metres;
    return kept;
}

KeptConfiguration keptIn(const std::filesystem::path& folder) {
    return api::StateFile(access::DataFolder::open(folder).value(), "", milliseconds(1))
        .configuration();
}

TEST(StateFile, IsWrittenAtOnceAndThenAfterAPause) {
    const test::TemporaryFolder folder;
    {
        api::StateFile file(access::DataFolder::open(folder.path()).value(), "", hours(1));
        file.keep(lookingAside(1));
        ASSERT_TRUE(eventually([&] { return keptIn(folder.path()) == lookingAside(1); }));
        file.keep(lookingAside(2));
        file.keep(lookingAside(3));
        EXPECT_EQ(keptIn(folder.path()), lookingAside(1));
    }
    EXPECT_EQ(keptIn(folder.path()), lookingAside(3)) << "it ended with something to write";
}

TEST(StateFile, IsWrittenOnceItsFolderCanBe) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder.path("data"));
    api::StateFile file(access::DataFolder::open(folder.path("data")).value(), "", milliseconds(1));
    std::filesystem::rename(folder.path("data"), folder.path("elsewhere"));
    file.keep(lookingAside(1));
    std::filesystem::rename(folder.path("elsewhere"), folder.path("data"));
    EXPECT_TRUE(eventually([&] { return keptIn(folder.path("data")) == lookingAside(1); }));
}

TEST(StateFile, IsOneCoordinatorsUntilThatEndsAndThenTheNextOnes) {
    const test::TemporaryFolder folder;
    const auto open = [&](std::chrono::milliseconds pause) {
        return std::make_unique<api::StateFile>(access::DataFolder::open(folder.path()).value(), "",
                                                pause);
    };
    auto first = open(milliseconds(1));
    first->keep(lookingAside(1));
    ASSERT_TRUE(eventually([&] { return keptIn(folder.path()) == lookingAside(1); }));
    const auto second = open(milliseconds(1));
    EXPECT_EQ(second->configuration(), lookingAside(1)) << "it shows what was set before";
    second->keep(lookingAside(2));
    first->keep(lookingAside(3));
    EXPECT_TRUE(eventually([&] { return keptIn(folder.path()) == lookingAside(3); }));
    std::this_thread::sleep_for(milliseconds(20));  // in which the second tries some times
    EXPECT_EQ(keptIn(folder.path()), lookingAside(3));
    first.reset();
    EXPECT_TRUE(eventually([&] { return keptIn(folder.path()) == lookingAside(2); }));
    const auto third = open(milliseconds(1));
    third->keep(lookingAside(4));
    second->keep(lookingAside(5));
    EXPECT_TRUE(eventually([&] { return keptIn(folder.path()) == lookingAside(5); }));
}

/// As when a coordinator is started while the one in whose place it comes finishes its last calls.
TEST(StateFile, OfACoordinatorThatIsAboutToEndIsWaitedFor) {
    const test::TemporaryFolder folder;
    const access::DataFolder data = access::DataFolder::open(folder.path()).value();
    auto ending = std::make_unique<api::StateFile>(data, "", hours(1));
    ending->keep(lookingAside(1));
    ASSERT_TRUE(eventually([&] { return keptIn(folder.path()) == lookingAside(1); }));
    ending->keep(lookingAside(2));  // which it writes at its end
    std::future<KeptConfiguration> next = std::async(
        std::launch::async, [&] { return api::StateFile(data, "", hours(1)).configuration(); });
    EXPECT_EQ(next.wait_for(milliseconds(50)), std::future_status::timeout);
    ending.reset();
    EXPECT_EQ(next.get(), lookingAside(2));
}

TEST(FileLock, IsHadByOneAndNotByWhatThatHasStarted) {
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder.path("lock");
    auto lock = std::make_unique<absl::StatusOr<api::FileLock>>(api::FileLock::take(path));
    ASSERT_TRUE(lock->ok()) << lock->status();
    EXPECT_TRUE(absl::IsFailedPrecondition(api::FileLock::take(path).status()));
    std::string name = "sleep";
    std::string time = "60";
    std::array<char*, 3> arguments = {name.data(), time.data(), nullptr};
    pid_t child = 0;
    ASSERT_EQ(::posix_spawnp(&child, "sleep", nullptr, nullptr, arguments.data(), environ), 0);
    lock.reset();
    // The child may be seen to run just before what it is not to have is closed.
    EXPECT_TRUE(eventually([&] { return api::FileLock::take(path).ok(); }));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    std::filesystem::create_symlink("elsewhere", folder.path("link"));
    EXPECT_TRUE(absl::IsUnavailable(api::FileLock::take(folder.path("link")).status()));
    EXPECT_TRUE(absl::IsUnavailable(api::FileLock::take(folder.path("none/lock")).status()));
}

TEST_F(KeptState, OfASecondCoordinatorIsKeptOnceTheFirstHasEnded) {
    setScene();
    const auto second = Coordinator::start(options_).value();
    EXPECT_EQ(second->frames().status().scene.objects.front().name, "set later");
    EXPECT_EQ(second->api()
                  .rest()
                  .answer({"PUT", "/api/v1/scene",
                           R"({"objects":[{"mesh":"a.eym","name":"of the second"}]})",
                           "application/json", ""})
                  .status,
              200);
    EXPECT_EQ(sceneInFile(), "set later");
    coordinator_.reset();
    EXPECT_TRUE(eventually([&] { return sceneInFile() == "of the second"; }));
}

TEST_F(KeptState, IsForgottenWhereTheFolderCannotBeWrittenAndNothingElseIsAmiss) {
    using std::filesystem::perms;
    constexpr perms kReadOnly = perms::owner_read | perms::owner_exec | perms::group_read |
                                perms::group_exec | perms::others_read | perms::others_exec;
    std::filesystem::permissions(folder_.path(), kReadOnly);
    std::filesystem::permissions(data(), kReadOnly);
    {
        const test::WithoutRights other;
        start();
        setScene();
        setConfiguration();
        expectScene("set later");
        start();
        expectScene("started with");
        expectConfigurationIsAsWritten();
        coordinator_.reset();
    }
    std::filesystem::permissions(folder_.path(), perms::owner_all);
    std::filesystem::permissions(data(), perms::owner_all);
}

}  // namespace
}  // namespace eyrie::coordinator
