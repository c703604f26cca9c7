// SPDX-License-Identifier: Apache-2.0
// Wrong input of every kind ends with the agreed exit status and a message that names what is
// wrong, never with a crash, and leaves no file behind.
#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include "tests/support/image_files.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using std::chrono::seconds;
using Words = std::vector<std::string>;

constexpr int kWorkFailed = 1;
constexpr int kWrongInput = 2;

constexpr const char* kGoodCamera =
    R"({"eye":[0,-4,1],"target":[0,0,0],"up":[0,0,1],"fovyDegrees":45})";

std::string lowerCase(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// A tetrahedron as an ASCII PLY, with room for mistakes.
std::string ply(const std::string& firstVertex, const std::string& firstFace,
                const std::string& vertices = "4", const std::string& faces = "4") {
    return fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n"
        "{}\n1 0 0\n0 1 0\n0 0 1\n{}\n3 0 3 1\n3 0 2 3\n3 1 3 2\n",
        vertices, faces, firstVertex, firstFace);
}

std::string plyWithoutFaces() {
    return "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
           "property float z\nelement face 0\nproperty list uchar int vertex_indices\n"
           "end_header\n0 0 0\n";
}

/// The header promises more than the file holds.
std::string truncatedBinaryPly() {
    return "ply\nformat binary_little_endian 1.0\nelement vertex 1000\nproperty float x\n"
           "property float y\nproperty float z\nelement face 2000\n"
           "property list uchar int vertex_indices\nend_header\n" +
           std::string(5000, '\1');
}

/// A GeoTIFF in UTM, each post `height`.
void writeDem(const std::string& path, int columns, int rows, float height, float nodata) {
    GDALAllRegister();
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const GDALDatasetUniquePtr file(
        driver->Create(path.c_str(), columns, rows, 1, GDT_Float32, nullptr));
    ASSERT_NE(file, nullptr);
    std::array<double, 6> transform{500000, 30, 0, 4000000, 0, -30};
    file->SetGeoTransform(transform.data());
    OGRSpatialReference utm;
    utm.importFromEPSG(32611);
    file->SetSpatialRef(&utm);
    file->GetRasterBand(1)->SetNoDataValue(nodata);
    ASSERT_EQ(file->GetRasterBand(1)->Fill(height), CE_None);
}

class BadInput : public testing::Test {
protected:
    static void SetUpTestSuite() {
        good_ = std::make_unique<test::TemporaryFolder>();
        good_->write("camera.json", kGoodCamera);
        ASSERT_TRUE(test::succeeded(
            {"synth", "mesh", "--size", "2000", "--seed", "1", "-o", good_->path("ball.ply")}));
        ASSERT_TRUE(test::succeeded(
            {"import", "mesh", good_->path("ball.ply"), "-o", good_->path("ball.eym")}));
        ASSERT_TRUE(test::succeeded(
            {"synth", "terrain", "--size", "300", "--seed", "1", "-o", good_->path("dem.tif")}));
        ASSERT_TRUE(test::succeeded(
            {"import", "terrain", good_->path("dem.tif"), "-o", good_->path("dem.eyt")}));
    }
    static void TearDownTestSuite() { good_.reset(); }

    static std::string good(const std::string& name) { return good_->path(name); }
    std::string bad(const std::string& name) const { return folder_.path(name); }

    /// Runs `eyrie ARGUMENTS` and expects it to be refused, with each of `named` in its message (in
    /// upper or lower case), and nothing new in the folder.
    void expectRefused(const Words& arguments, const Words& named, int status = kWrongInput,
                       const Words& environment = {}) {
        const std::set<std::string> before = test::namesIn(folder_.path());
        std::string line = "eyrie";
        for (const std::string& argument : arguments) line += " " + argument;
        Words variables = environment;
        variables.push_back("XDG_CACHE_HOME=" + cache_.path("cache"));
        const test::Outcome outcome = test::eyrie(arguments, variables, seconds(20));
        EXPECT_EQ(outcome.exit, (test::Exit{status, 0})) << line << "\n" << outcome.errors;
        const std::string message = lowerCase(outcome.errors);
        for (const std::string& word : named)
            EXPECT_NE(message.find(lowerCase(word)), std::string::npos)
                << line << "\nshould say '" << word << "', but says:\n"
                << outcome.errors;
        EXPECT_EQ(test::namesIn(folder_.path()), before) << line << "\nleft something behind";
    }

    void expectRenderRefused(const Words& options, const Words& named) {
        Words arguments = {"render", good("ball.eym"), "-o", bad("out.png")};
        if (std::ranges::count(options, "--camera") == 0)
            arguments.insert(arguments.end(), {"--camera", good("camera.json")});
        if (std::ranges::count(options, "--size") == 0)
            arguments.insert(arguments.end(), {"--size", "32x32"});
        arguments.insert(arguments.end(), options.begin(), options.end());
        expectRefused(arguments, named);
    }

    test::TemporaryFolder folder_;
    test::TemporaryFolder cache_;
    static std::unique_ptr<test::TemporaryFolder> good_;
};
std::unique_ptr<test::TemporaryFolder> BadInput::good_;

TEST_F(BadInput, MeshesThatAreNoneAreRefusedByName) {
    struct Case {
        const char* name;
        std::string content;
        Words named;
    };
    const std::string good = ply("0 0 0", "3 0 1 2");
    const std::vector<Case> cases = {
        {"empty.ply", "", {"empty.ply"}},
        {"text.ply", "this is no mesh\n", {"text.ply", "ply"}},
        {"header_only.ply", good.substr(0, good.find("end_header") + 11), {"vert"}},
        {"cut_header.ply", good.substr(0, 60), {"header"}},
        {"cut_vertices.ply", good.substr(0, good.find("0 1 0")), {"vert"}},
        {"cut_faces.ply", good.substr(0, good.find("3 0 2 3")), {"face"}},
        {"cut_binary.ply", truncatedBinaryPly(), {"vert", "1000"}},
        {"nan.ply", ply("nan 0 0", "3 0 1 2"), {"x", "finite"}},
        {"inf.ply", ply("0 inf 0", "3 0 1 2"), {"y", "finite"}},
        {"index.ply", ply("0 0 0", "3 0 1 4"), {"face", "4"}},
        {"negative_index.ply", ply("0 0 0", "3 0 -1 2"), {"face", "-1"}},
        {"lying.ply", ply("0 0 0", "3 0 1 2", "4000000000"), {"4000000000"}},
        {"lying_faces.ply", ply("0 0 0", "3 0 1 2", "4", "99999999999999999999"), {"face"}},
        {"no_faces.ply", plyWithoutFaces(), {"face"}},
    };
    for (const Case& one : cases) {
        folder_.write(one.name, one.content);
        Words named = one.named;
        named.push_back(one.name);
        expectRefused({"import", "mesh", bad(one.name), "-o", bad("out.eym")}, named);
    }
    expectRefused({"import", "mesh", bad("missing.ply"), "-o", bad("out.eym")}, {"missing.ply"});
    expectRefused({"import", "mesh", folder_.path().string(), "-o", bad("out.eym")},
                  {folder_.path().string()});
}

TEST_F(BadInput, ElevationModelsThatAreNoneAreRefusedByName) {
    folder_.write("text.tif", "this is no raster\n");
    expectRefused({"import", "terrain", bad("text.tif"), "-o", bad("out.eyt")}, {"text.tif"});
    writeDem(bad("empty.tif"), 64, 64, -9999, -9999);
    expectRefused({"import", "terrain", bad("empty.tif"), "-o", bad("out.eyt")},
                  {"empty.tif", "nodata"});
    writeDem(bad("nan.tif"), 64, 64, std::numeric_limits<float>::quiet_NaN(), -9999);
    expectRefused({"import", "terrain", bad("nan.tif"), "-o", bad("out.eyt")}, {"nan.tif"});
    writeDem(bad("pixel.tif"), 1, 1, 7, -9999);
    expectRefused({"import", "terrain", bad("pixel.tif"), "-o", bad("out.eyt")},
                  {"pixel.tif", "1"});
    expectRefused({"import", "terrain", bad("missing.tif"), "-o", bad("out.eyt")}, {"missing.tif"});
    const auto whole = test::readFile(good("dem.tif"));
    ASSERT_TRUE(whole.ok()) << whole.status();
    folder_.write("cut.tif", whole->substr(0, whole->size() / 2));
    expectRefused({"import", "terrain", bad("cut.tif"), "-o", bad("out.eyt")}, {"cut.tif"});
    folder_.write("mesh.ply", "ply\n");
    expectRefused({"import", "terrain", good("dem.tif"), bad("mesh.ply"), "-o", bad("out.eyt")},
                  {"mesh.ply", "out.eyt", "`eyrie import mesh`", ".eym"});
    expectRefused({"import", "terrain", bad("missing.ply"), "-o", bad("out.eyt")}, {"missing.ply"});
}

TEST_F(BadInput, ScenesThatCannotBeAreRefusedByFileAndField) {
    struct Case {
        const char* name;
        std::string content;
        Words named;
    };
    const std::string mesh = good("ball.eym");
    const std::vector<Case> cases = {
        {"broken.json", "{\"objects\":[", {}},
        {"list.json", "[]", {}},
        {"unknown.json", R"({"objcts":[]})", {"objcts"}},
        {"type.json", R"({"objects":"ball"})", {"objects"}},
        {"ambient.json",
         fmt::format(R"({{"objects":[{{"mesh":"{}"}}],"ambient":7}})", mesh),
         {"ambient", "7"}},
        {"empty.json", R"({"objects":[]})", {"object"}},
        {"no_data.json", R"({"objects":[{"name":"ghost"}]})", {"objects[0]", "data"}},
        {"missing.json", R"({"objects":[{"mesh":"nowhere.eym"}]})", {"nowhere.eym"}},
        {"singular.json",
         fmt::format(R"({{"objects":[{{"name":"flat","mesh":"{}","transform":{{"matrix":)"
                     R"([1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1]}}}}]}})",
                     mesh),
         {"flat", "transform"}},
        {"short.json",
         fmt::format(R"({{"objects":[{{"mesh":"{}","transform":{{"translation":[1,2]}}}}]}})",
                     mesh),
         {"translation"}},
        {"nan.json",
         fmt::format(R"({{"objects":[{{"mesh":"{}","transform":{{"translation":[1,2,"NaN"]}}}}]}})",
                     mesh),
         {"translation"}},
        {"far.json",
         fmt::format(
             R"({{"objects":[{{"name":"star","mesh":"{}","transform":{{"scale":1e15}}}}]}})", mesh),
         {"star", "transform", "1e+14"}},
        {"endless.json",
         fmt::format(
             R"({{"objects":[{{"name":"all","mesh":"{}","transform":{{"scale":1e300}}}}]}})", mesh),
         {"all", "transform", "1e+14"}},
        {"reach.json",
         fmt::format(R"({{"objects":[{{"name":"moon","mesh":"{}","transform":)"
                     R"({{"scale":1e14,"translation":[1e14,1e14,1e14]}}}}]}})",
                     mesh),
         {"moon", "metres", "transform"}},
    };
    const std::set<std::string> opened = {"missing.json", "reach.json"};
    for (const Case& one : cases) {
        folder_.write(one.name, one.content);
        Words named = one.named;
        if (!opened.contains(one.name))
            named.push_back(one.name);
        expectRefused({"render", bad(one.name), "--camera", good("camera.json"), "--size", "32x32",
                       "-o", bad("out.png")},
                      named);
    }
    expectRefused({"render", bad("nowhere.json"), "--camera", good("camera.json"), "--size",
                   "32x32", "-o", bad("out.png")},
                  {"nowhere.json"});
}

TEST_F(BadInput, CamerasThatSpanNoPictureAreRefusedByField) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {R"({"eye":["NaN",0,0],"target":[0,0,0]})", "eye"},
        {R"({"eye":["Infinity",0,0],"target":[0,0,0]})", "eye"},
        {R"({"target":[0,0,0]})", "eye"},
        {R"({"eye":[0,0],"target":[0,0,0]})", "eye"},
        {R"({"eye":[0,0,0],"target":[0,0,0]})", "target"},
        {R"({"eye":[0,0,5],"target":[0,0,0],"up":[0,0,1]})", "up"},
        {R"({"eye":[0,-4,0],"target":[0,0,0],"fovyDegrees":500})", "fovy"},
        {R"({"eye":[0,-4,0],"target":[0,0,0],"fovyDegrees":-1})", "fovy"},
        {R"({"eye":[0,-4,0],"target":[0,0,0],"fov":45})", "fov"},
        {R"(eye)", "camera"},
    };
    for (const auto& [content, field] : cases) {
        const std::string file = folder_.write("camera.json", content);
        expectRenderRefused({"--camera", file}, {"camera.json", field});
    }
    expectRenderRefused({"--camera", bad("nowhere.json")}, {"nowhere.json"});
}

TEST_F(BadInput, OptionsOutOfRangeAreRefusedByName) {
    for (const char* size : {"0x0", "99999x1", "abc", "32", "32x", "-1x32", "32x32x32", "1e3x9"})
        expectRenderRefused({"--size", size}, {"--size", size});
    for (const char* tau : {"0", "-1", "nan", "inf", "abc", "1e9"})
        expectRenderRefused({"--tau", tau}, {"--tau"});
    for (const char* count : {"0", "-1", "abc", "100000"})
        expectRenderRefused({"--renderers", count}, {"--renderers"});
    expectRenderRefused({"--renderers", "2", "--compound", "3D"}, {"--compound"});
    for (const char* metres : {"0", "-1", "nan", "inf", "abc", "1e9"})
        expectRefused({"import", "terrain", EYRIE_SOURCE_DIR "/demo/mount_rainier.tif", "--error",
                       metres, "-o", bad("out.eyt")},
                      {"--error"});
    expectRefused({"render", good("ball.eym"), "--camera", good("camera.json")}, {"--output"});
    expectRefused({"render", good("ball.eym"), "--camera", good("camera.json"), "-o",
                   bad("out.xyz"), "--size", "32x32"},
                  {"out.xyz", ".png"});
}

TEST_F(BadInput, ConfigurationsThatCannotBeAreRefusedByPlaceAndNotConverted) {
    const std::string text = folder_.write("wrong.eqc", "config {\n latency -1 }");
    const std::string json =
        folder_.write("wrong.json", R"({"nodes": [{"pipes": [{"port": -1}]}]})");
    const std::string fine = folder_.write("fine.eqc", "config { node { pipe {} } }");
    expectRefused({"check", text, "--convert", bad("out.json")}, {"wrong.eqc:2:2", "latency"});
    expectRefused({"check", json, "--convert", bad("out.eqc")},
                  {"wrong.json:nodes[0].pipes[0].port: error"});
    const std::string ring = folder_.write(
        "ring.eqc",
        "config { appNode { pipe { window { channel { name \"a\" } channel { name \"b\" } channel "
        "{ "
        "name \"c\" } } } } layout { view {} } canvas { layout 0 segment { channel \"a\" } }\n"
        "compound { channel ( segment 0 view 0 )\n"
        "compound { channel \"b\" inputframe { name \"x\" } outputframe { name \"y\" } }\n"
        "compound { channel \"c\" inputframe { name \"y\" } outputframe { name \"x\" } }\n"
        "inputframe { name \"y\" } } }");
    expectRefused({"check", ring, "--convert", bad("ring.json")},
                  {"ring.eqc:3:1: error: compounds wait for each other's frames", "at 4:1"});
    expectRefused({"serve", good("ball.eym"), "--listen", "127.0.0.1:0", "--config", ring},
                  {"ring.eqc:3:1: error:", "--config", "1 error"});
    expectRenderRefused({"--config", ring}, {"ring.eqc:3:1: error:", "--config"});
    expectRenderRefused({"--config", fine}, {"--config", "fine.eqc has no canvas"});
    expectRefused({"check", fine, "--convert", bad("out.txt")}, {"--convert", ".eqc or .json"});
    expectRefused({"check", fine, "--convert", bad("fine.eqc")}, {"--convert", "the same file"});
    EXPECT_EQ(*test::readFile(fine), "config { node { pipe {} } }");
    expectRefused({"check", fine, "--convert", bad("none/out.json")}, {"none/out.json"});
    ASSERT_EQ(mkfifo(bad("pipe").c_str(), 0600), 0);
    expectRefused({"check", bad("pipe")}, {"no regular file"});
    expectRefused({"check", bad("missing.eqc")}, {"missing.eqc"});
}

TEST_F(BadInput, UnknownCommandsAndOptionsAreRefused) {
    expectRefused({}, {"eyrie"});
    expectRefused({"fly"}, {"fly"});
    expectRefused({"import"}, {"mesh", "terrain"});
    expectRefused({"import", "cloud", "x"}, {"cloud"});
    expectRefused({"info"}, {"file"});
    expectRefused({"info", good("ball.eym"), "--colour"}, {"--colour"});
    expectRefused({"info", good("ball.eym"), "--jason"},
                  {"'--jason' is nothing that eyrie info knows, did you mean '--json'?"});
    expectRefused({"--json", "info", good("ball.eym")},
                  {"'--json' stands before the command; write `eyrie info --json ...`"});
    expectRefused({"serve", good("ball.eym"), "--listen", "nowhere"}, {"--listen", "nowhere"});
    expectRefused({"serve", good("ball.eym"), "--listen", "127.0.0.1:99999"},
                  {"--listen", "99999"});
    for (const char* missing : {"nowhere.ply", "nowhere.eym", "nowhere.eyt", "nowhere.json"})
        expectRefused({"serve", bad(missing), "--listen", "127.0.0.1:0"}, {missing});
    expectRefused({"coordinator", bad("nowhere.eym"), "--listen", "127.0.0.1:0"}, {"nowhere.eym"});
    expectRefused({"synth", "mesh", "--size", "-5", "-o", bad("out.ply")}, {"--size"});
    for (const char* roughness : {"nan", "-0.1", "0.6"})
        expectRefused(
            {"synth", "mesh", "--size", "100", "--roughness", roughness, "-o", bad("out.ply")},
            {"--roughness"});
    expectRefused({"synth", "terrain", "--size", "0", "-o", bad("out.tif")}, {"--size"});
    for (const char* seed : {"-1", "18446744073709551616", "1.5"})
        expectRefused({"synth", "terrain", "--size", "9", "--seed", seed, "-o", bad("out.tif")},
                      {"--seed", seed, "whole number"});
    expectRefused({"serve", good("ball.eym"), "--max-scene-triangles", "-1"},
                  {"--max-scene-triangles", "whole number"});
    for (const char* metres : {"nan", "inf", "-1", "1e300"})
        expectRefused({"synth", "mesh", "--from", good_->path("ball.ply"), "--displace", metres,
                       "-o", bad("out.ply")},
                      {"--displace"});
    expectRefused({"synth", "mesh", "--from", good("ball.ply"), "-o", good("ball.ply")},
                  {"-o", "--from"});
}

TEST_F(BadInput, OutputIntoAFolderThatIsMissingIsRefused) {
    const std::string out = bad("no/such/folder/out");
    expectRefused({"render", good("ball.eym"), "--camera", good("camera.json"), "--size", "32x32",
                   "-o", out + ".png"},
                  {out});
    expectRefused({"import", "mesh", good("ball.ply"), "-o", out + ".eym"}, {out});
    expectRefused({"import", "terrain", good("dem.tif"), "-o", out + ".eyt"}, {out});
    expectRefused({"synth", "mesh", "--size", "100", "-o", out + ".ply"}, {out});
    expectRefused({"synth", "terrain", "--size", "100", "-o", out + ".tif"}, {out});
}

TEST_F(BadInput, OutputInTheWayOfOtherFilesIsRefused) {
    const std::string out = bad("out.png");
    expectRefused({"render", good("ball.eym"), "--size", "32x32", "-o", out, "--depth", out},
                  {"--depth", out, "-o"});
    expectRefused({"render", good("ball.eym"), "--size", "32x32", "-o", out, "--stats", out},
                  {"--stats", out, "-o"});
    expectRefused(
        {"render", good("ball.eym"), "--size", "32x32", "-o", out, "--depth", good("ball.eym")},
        {"--depth", "the scene"});
    expectRefused({"bench", good("ball.eym"), "-o", good("ball.ply")}, {good("ball.ply")});
    const std::string folder = bad("folder");
    for (const char* ending : {".png", ".eyt", ".eym", ".tif"})
        std::filesystem::create_directory(folder + ending);
    expectRefused({"render", good("ball.eym"), "-o", folder + ".png"}, {folder, "name a file"});
    expectRefused({"import", "mesh", good("ball.ply"), "-o", folder + ".eym"},
                  {folder, "name a file"});
    expectRefused({"synth", "terrain", "--size", "100", "-o", folder + ".tif"},
                  {folder, "name a file"});
    expectRefused({"import", "terrain", good("dem.tif"), "-o", folder + ".eyt"},
                  {folder, "name a file"});
}

TEST_F(BadInput, OutputLargerThanFilesMayBeFailsByNameAndLeavesNothing) {
    const std::vector<Words> commands = {
        {"import", "mesh", good("ball.ply"), "-o", bad("out.eym")},
        {"import", "terrain", good("dem.tif"), "-o", bad("out.eyt")},
        {"render", good("ball.eym"), "--size", "640x480", "-o", bad("out.png")},
        {"render", good("ball.eym"), "--size", "640x480", "-o", bad("out.jpg")},
        {"synth", "mesh", "--size", "9000", "--seed", "1", "-o", bad("out.ply")},
        {"synth", "terrain", "--size", "300", "--seed", "1", "-o", bad("out.tif")}};
    for (const Words& arguments : commands) {
        Words command = test::eyrieCommand(arguments);
        command.insert(command.begin(), {"/usr/bin/prlimit", "--fsize=4096"});
        const test::Outcome outcome = test::run(command, seconds(60), {});
        EXPECT_EQ(outcome.exit, (test::Exit{kWorkFailed, 0})) << arguments[0] << outcome.errors;
        EXPECT_NE(outcome.errors.find(arguments.back()), std::string::npos) << outcome.errors;
        EXPECT_NE(outcome.errors.find("ulimit -f"), std::string::npos) << outcome.errors;
    }
    for (const std::string& name : test::namesIn(folder_.path()))
        EXPECT_TRUE(name.ends_with(".source")) << name << " was left";
}

TEST_F(BadInput, DamagedDataFilesAreRefusedAndNeverCrash) {
    const unsigned seed = 20261121;
    std::mt19937 random(seed);
    for (const char* name : {"ball.eym", "dem.eyt"}) {
        const auto whole = test::readFile(good(name));
        ASSERT_TRUE(whole.ok()) << whole.status();
        const std::string file = folder_.write(name, "");
        const auto tryBoth = [&](const std::string& content, const std::string& what) {
            folder_.write(name, content);
            for (const Words& arguments :
                 {Words{"info", file}, Words{"render", file, "--camera", good("camera.json"),
                                             "--size", "32x32", "-o", bad("out.png")}}) {
                const test::Outcome outcome = test::eyrie(arguments, {}, seconds(20));
                EXPECT_EQ(outcome.exit.signal, 0) << arguments[0] << " " << what;
                EXPECT_GE(outcome.exit.status, 0) << arguments[0] << " " << what << " hangs";
                if (outcome.exit.status == 0)
                    continue;
                EXPECT_EQ(outcome.exit.status, kWrongInput) << what << outcome.errors;
                EXPECT_NE(outcome.errors.find(name), std::string::npos) << what << outcome.errors;
                EXPECT_FALSE(std::filesystem::exists(bad("out.png"))) << what;
            }
            std::filesystem::remove(bad("out.png"));
        };
        for (int i = 0; i < 12; ++i) {
            std::string content = *whole;
            // Half of the flips in the first kilobyte, where the sizes are.
            const std::size_t range = i % 2 == 0 ? std::size_t{1024} : content.size();
            const std::size_t place = random() % std::min(range, content.size());
            content[place] = static_cast<char>(content[place] ^ (1 << random() % 8));
            tryBoth(content,
                    fmt::format("{} with a bit of byte {} flipped, seed {}\n", name, place, seed));
        }
        for (const std::size_t length :
             {std::size_t{0}, std::size_t{7}, whole->size() / 2, whole->size() - 1}) {
            folder_.write(name, whole->substr(0, length));
            expectRefused({"info", file}, {name});
        }
    }
}

TEST_F(BadInput, RenderersThatCannotOpenTheDataAreNotWaitedFor) {
    const auto whole = test::readFile(good("ball.eym"));
    ASSERT_TRUE(whole.ok()) << whole.status();
    const std::string file = folder_.write("ball.eym", whole->substr(0, whole->size() / 2));
    expectRefused({"render", file, "--camera", good("camera.json"), "--size", "32x32",
                   "--renderers", "2", "-o", bad("out.png")},
                  {"renderer can draw this", "ball.eym"});
    expectRefused({"bench", file, "--size", "32x32", "--frames", "2", "--renderers", "1", "-o",
                   bad("report")},
                  {"renderer can draw this", "ball.eym"});
}

TEST_F(BadInput, AnOutputThatNobodyReadsDoesNotKeepTheProgramFromEnding) {
    ASSERT_EQ(mkfifo(bad("pipe").c_str(), 0600), 0);
    const std::set<std::string> before = test::namesIn(folder_.path());
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        test::Process render(test::eyrieCommand({"render", good("ball.eym"), "--size", "32x32",
                                                 "-o", bad("out.png"), "--stats", bad("pipe")}));
        EXPECT_TRUE(test::eventually(seconds(20), [&] {
            return test::namesIn(folder_.path()).size() > before.size();
        })) << render.errors();
        EXPECT_FALSE(render.waitFor(std::chrono::milliseconds(500))) << "it has statistics to tell";
        render.send(signal);
        EXPECT_EQ(render.waitFor(seconds(10)), (test::Exit{kWorkFailed, 0}))
            << signal << render.errors();
        EXPECT_EQ(test::namesIn(folder_.path()), before) << signal << " left something behind";
    }
}

TEST_F(BadInput, SynthThatIsStoppedSaysSoAndLeavesNothing) {
    test::Process synth(
        test::eyrieCommand({"synth", "terrain", "--size", "3000", "-o", bad("out.tif")}));
    EXPECT_TRUE(test::eventually(
        seconds(20), [&] { return synth.errors().find("making") != std::string::npos; }));
    synth.send(SIGINT);
    EXPECT_EQ(synth.waitFor(seconds(60)), (test::Exit{kWorkFailed, 0}));
    EXPECT_NE(synth.errors().find("eyrie: stopped"), std::string::npos) << synth.errors();
    EXPECT_TRUE(test::namesIn(folder_.path()).empty());
}

TEST_F(BadInput, StandardOutputThatIsLostIsAFailureAndSaid) {
    const std::vector<Words> commands = {
        {"--help"},
        {"--version"},
        {"serve", "--help"},
        {"serve", good("ball.eym"), "--print-config"},
        {"info", good("ball.eym")},
        {"info", good("dem.eyt"), "--json"},
        {"import", "mesh", good("ball.ply"), "-o", bad("out.eym"), "--json"}};
    for (const Words& arguments : commands) {
        Words command = test::eyrieCommand(arguments);
        command.insert(command.begin(), {"/bin/sh", "-c", "exec \"$@\" > /dev/full", "sh"});
        const test::Outcome outcome = test::run(command, seconds(60), {});
        EXPECT_EQ(outcome.exit, (test::Exit{kWorkFailed, 0})) << arguments[0] << outcome.errors;
        EXPECT_TRUE(outcome.errors.ends_with(
            "eyrie: standard output cannot be written: No space left on device\n"))
            << arguments[0] << ": " << outcome.errors;
    }
}

TEST_F(BadInput, SynthWritesToAPipeAndSaysSo) {
    const std::string pipe = bad("ball.ply");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    test::Process reader({"/bin/cat", pipe});
    const test::Outcome outcome = test::eyrie({"synth", "mesh", "--size", "100", "-o", pipe});
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
    EXPECT_EQ(reader.waitFor(seconds(10)), (test::Exit{0, 0}));
    EXPECT_TRUE(reader.output().starts_with("ply\n")) << "and it is all there";
}

TEST_F(BadInput, WithoutEglRenderSaysWhatToInstall) {
    expectRefused({"render", good("ball.eym"), "--camera", good("camera.json"), "--size", "32x32",
                   "-o", bad("out.png")},
                  {"EGL", "install", "libegl-mesa0"}, kWorkFailed,
                  {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json"});
}

TEST_F(BadInput, ARendererWithoutACoordinatorSaysSoAndCanBeEnded) {
    // Nobody listens on port 1. A renderer waits for its coordinator, which may come later.
    test::Process renderer(test::eyrieCommand({"renderer", "--coordinator", "127.0.0.1:1"}));
    EXPECT_TRUE(test::eventually(seconds(20), [&] {
        return renderer.errors().find("127.0.0.1:1") != std::string::npos;
    })) << renderer.errors();
    renderer.send(SIGTERM);
    EXPECT_EQ(renderer.waitFor(seconds(30)), (test::Exit{0, 0})) << renderer.errors();
    expectRefused({"renderer", "--coordinator", "nowhere"}, {"nowhere"});
    expectRefused({"renderer"}, {"--coordinator"});
}

}  // namespace
}  // namespace eyrie
