// SPDX-License-Identifier: Apache-2.0
// What meshes with textures and see-through materials look like, against what is known of pixels.
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fabric/depth_merge.h"
#include "renderer/import/mesh_import.h"
#include "renderer/mesh/image_codec.h"
#include "renderer/renderer.h"
#include "tests/renderer/import/tga_text.h"
#include "tests/renderer/mesh/temporary_folder.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

using fabric::Rgba;
using fabric::Vec3;
using import::TriangleMesh;

constexpr int kSize = 96;
constexpr Rgba kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255},
    kWhite{255, 255, 255, 255};
const Rgba kBackground{10, 20, 30, 255};

/// Four quarters: red and green above blue and white.
std::vector<Rgba> quarters(int side) {
    std::vector<Rgba> texels;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            texels.push_back(2 * y < side ? (2 * x < side ? kRed : kGreen)
                                          : (2 * x < side ? kBlue : kWhite));
    return texels;
}

/// Adds a square of `side` metres around the z axis, facing up, with an image once over it.
void addSquare(TriangleMesh& mesh, double side, double height, Rgba colour,
               std::uint16_t material) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [x, y] : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        mesh.positions.emplace_back((x - 0.5) * side, (y - 0.5) * side, height);
        mesh.colours.push_back(colour);
        mesh.textureCoordinates.emplace_back(x, 1 - y);
        mesh.materialOf.push_back(material);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

class MeshMaterials : public testing::Test {
protected:
    void SetUp() override {
        renderer_ = test::makeRenderer();
        scene_.ambient = 1;  // and nothing else
        scene_.lights = {{{0, 0, -1}, {0, 0, 0}}};
        scene_.background = kBackground;
        frame_.camera = {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 60};
        task_.viewWidth = task_.viewHeight = kSize;
        task_.pixelViewport = {0, 0, kSize, kSize};
        task_.wantsDepth = true;
    }

    void add(TriangleMesh mesh, std::uint32_t leafTriangles = 100) {
        fabric::SceneObject object;
        object.name = "mesh";
        object.path = folder_.file(std::to_string(scene_.objects.size()) + ".eym");
        const auto report =
            import::importMesh(std::move(mesh), object.path, {.leafTriangles = leafTriangles});
        EXPECT_TRUE(report.ok()) << report.status();
        scene_.objects.push_back(object);
    }

    fabric::Image draw() { return draw(task_); }
    fabric::Image draw(const fabric::ChannelTask& task) {
        EXPECT_TRUE(renderer_->openScene(scene_).ok());
        auto result = renderer_->render(frame_, task);
        EXPECT_TRUE(result.ok()) << result.status();
        statistics_ = result->statistics;
        return result->image;
    }

    /// What is seen of the plane z = 0 at a place of it, in metres; what is left of the picture.
    static Rgba at(const fabric::Image& image, double x, double y) {
        const double half = std::tan(3.14159265358979 / 6) * 10;
        const auto pixel = [&](double place) {
            return static_cast<int>((place / half + 1) / 2 * kSize);
        };
        if (!image.area.contains({pixel(x), pixel(y), 1, 1}))
            return kBackground;
        return image.colour[static_cast<std::size_t>((pixel(y) - image.area.y) * image.area.width +
                                                     pixel(x) - image.area.x)];
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<Renderer> renderer_;
    fabric::Scene scene_;
    fabric::FrameData frame_;
    fabric::ChannelTask task_;
    fabric::FrameStatistics statistics_;  ///< of the last picture
};

/// `colour` over what is behind it, as displayed.
Rgba over(Rgba colour, Rgba behind) {
    const auto mix = [&](std::uint8_t front, std::uint8_t back) {
        return static_cast<std::uint8_t>(
            std::lround((front * colour.a + back * (255 - colour.a)) / 255.0));
    };
    return {mix(colour.r, behind.r), mix(colour.g, behind.g), mix(colour.b, behind.b), 255};
}

void expectNear(Rgba found, Rgba expected, int levels) {
    EXPECT_NEAR(found.r, expected.r, levels);
    EXPECT_NEAR(found.g, expected.g, levels);
    EXPECT_NEAR(found.b, expected.b, levels);
    EXPECT_EQ(found.a, 255);
}

TEST_F(MeshMaterials, TexturesOfAFileAreTheRightWayUp) {
    std::ofstream(folder_.file("floor.obj"))
        << "mtllib floor.mtl\nusemtl tiles\nv -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\n"
           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    std::ofstream(folder_.file("floor.mtl")) << "newmtl tiles\nKd 1 1 1\nmap_Kd Tiles.TGA\n";
    std::ofstream(folder_.file("tiles.tga"), std::ios::binary) << test::tgaOf(16, 16, quarters(16));
    const auto report = import::importMesh({folder_.file("floor.obj")}, folder_.file("floor.eym"));
    ASSERT_TRUE(report.ok()) << report.status();
    EXPECT_TRUE(report->notes.empty()) << report->notes.front();
    fabric::SceneObject object;
    object.name = "floor";
    object.path = folder_.file("floor.eym");
    scene_.objects = {object};
    for (const auto shading :
         {fabric::Shading::Smooth, fabric::Shading::Gouraud, fabric::Shading::Flat}) {
        frame_.shading = shading;
        const fabric::Image image = draw();
        EXPECT_EQ(at(image, -2, 2), kRed);
        EXPECT_EQ(at(image, 2, 2), kGreen);
        EXPECT_EQ(at(image, -2, -2), kBlue);
        EXPECT_EQ(at(image, 2, -2), kWhite);
        EXPECT_EQ(at(image, -3.6, 0.6), kRed) << "the image's edge";
    }
}

/// An asset of few colours: squares of 0.8 metres, each with one texel of a palette.
TEST_F(MeshMaterials, EachTexelOfAPaletteIsShownInItsColour) {
    std::vector<Rgba> palette;
    for (int i = 0; i < 64; ++i)
        palette.push_back({static_cast<std::uint8_t>(37 * i), static_cast<std::uint8_t>(101 * i),
                           static_cast<std::uint8_t>(200 - 59 * i), 255});
    TriangleMesh mesh;
    mesh.materials = {{}, {.image = 0}};
    mesh.images = {mesh::encodeImage({8, 8, 0}, palette)};
    const auto placeOf = [](int index) { return 0.8 * (index - 3.5); };
    for (int i = 0; i < 64; ++i) {
        const auto first = mesh.positions.size();
        addSquare(mesh, 0.8, 0, kWhite, 1);
        for (std::size_t v = first; v < mesh.positions.size(); ++v) {
            mesh.positions[v] = mesh.positions[v] + Vec3(placeOf(i % 8), placeOf(i / 8), 0);
            mesh.textureCoordinates[v] = (glm::vec2(i % 8, i / 8) + 0.5F) / 8.0F;
        }
    }
    add(std::move(mesh));
    const fabric::Image image = draw();
    for (int i = 0; i < 64; ++i)
        expectNear(at(image, placeOf(i % 8), placeOf(i / 8)), palette[std::size_t(i)], 4);
}

TEST_F(MeshMaterials, CoarserLevelsShowTheMeanOfTheLight) {
    std::vector<Rgba> checks;
    for (int i = 0; i < 256 * 256; ++i)
        checks.push_back((i + i / 256) % 2 == 0 ? kWhite : Rgba{0, 0, 0, 255});
    TriangleMesh mesh;
    mesh.materials = {{}, {.image = 0}};
    mesh.images = {mesh::encodeImage({256, 256, 0}, checks)};
    addSquare(mesh, 3, 0, kWhite, 1);  // 25 pixels: the fourth level and some
    add(std::move(mesh));
    expectNear(at(draw(), 0.3, -0.2), {180, 180, 180, 255}, 4);
}

TEST_F(MeshMaterials, ATexturesHolesShowWhatIsBehindAndHaveNoDepth) {
    std::vector<Rgba> texels = quarters(16);
    for (int i = 0; i < 128; ++i) texels[static_cast<std::size_t>(i)].a = 0;  // red and green
    TriangleMesh mesh;
    mesh.materials = {{}, {.image = 0, .alphaCutoff = 0.5F}};
    mesh.images = {mesh::encodeImage({16, 16, mesh::kHasAlpha}, texels)};
    addSquare(mesh, 8, 0, kWhite, 1);
    add(std::move(mesh));
    const fabric::Image image = draw();
    EXPECT_EQ(at(image, -2, 2), kBackground);
    EXPECT_EQ(at(image, -2, -2), kBlue);
    EXPECT_EQ(at(image, 2, -2), kWhite);
    std::size_t deep = 0;
    for (const float depth : image.depth) deep += depth > 0 ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(deep), 0.5 * 66.5 * 66.5, 80);  // half of 8 metres squared
}

/// Panes are sorted, whatever the order of objects; all lie over what is opaque.
TEST_F(MeshMaterials, WhatIsBlendedIsDrawnFromBackToFront) {
    const Rgba blue{0, 0, 255, 128}, green{0, 255, 0, 64};
    TriangleMesh floor, low, high;
    addSquare(floor, 8, -1, kRed, 0);
    floor.textureCoordinates.clear();
    floor.materialOf.clear();
    low.materials = high.materials = {{}, {.flags = mesh::kIsBlended}};
    addSquare(low, 6, 0, blue, 1);
    addSquare(high, 3, 0.5, green, 1);
    add(high);
    add(low);
    add(floor);
    const fabric::Image image = draw();
    expectNear(at(image, 0, 0.1), over(green, over(blue, kRed)), 1);
    expectNear(at(image, 2.5, 2.5), over(blue, kRed), 1);
    expectNear(at(image, 3.4, 3.4), kRed, 0);
    std::swap(scene_.objects[0], scene_.objects[1]);
    EXPECT_EQ(draw(), image);
    std::swap(scene_.objects[1], scene_.objects[2]);
    EXPECT_EQ(draw(), image);
}

/// One colour stands in for pictures, holes and what shows through.
TEST_F(MeshMaterials, AColourOfAnObjectIsAllThatIsSeenOfIt) {
    std::vector<Rgba> texels = quarters(16);
    for (int i = 0; i < 128; ++i) texels[static_cast<std::size_t>(i)].a = 0;
    TriangleMesh floor, pane, holed;
    floor.materials = {{}, {.image = 0}};
    floor.images = {mesh::encodeImage({16, 16, 0}, quarters(16))};
    addSquare(floor, 8, -1, kWhite, 1);
    pane.materials = {{}, {.flags = mesh::kIsBlended}};
    addSquare(pane, 4, 0, {0, 0, 255, 128}, 1);
    holed.materials = {{}, {.image = 0, .alphaCutoff = 0.5F}};
    holed.images = {mesh::encodeImage({16, 16, mesh::kHasAlpha}, texels)};
    addSquare(holed, 2, 1, kWhite, 1);
    add(std::move(floor));
    add(std::move(pane));
    add(std::move(holed));
    const fabric::Image plain = draw();
    EXPECT_NE(at(plain, 1.5, 0), kGreen);
    frame_.look.objects = {{{1, Vec3(0, 1, 0)}, {2, Vec3(1, 0, 0)}}};
    const fabric::Image own = draw();
    EXPECT_EQ(at(own, 1.5, 0), kGreen);
    EXPECT_EQ(at(own, 0.3, 0.3), kRed) << "where the picture has a hole";
    EXPECT_EQ(at(own, -3.2, -3.2), kBlue) << "the floor has its picture";
    frame_.look.objects = {{{0, Vec3(1, 1, 0)}}};
    EXPECT_EQ(at(draw(), -3.2, -3.2), (Rgba{255, 255, 0, 255}));
    expectNear(at(draw(), 1.5, 0), over({0, 0, 255, 128}, {255, 255, 0, 255}), 1);
}

/// A pane of 6 metres before a floor of 8, one of them as lines, whatever the picture is.
TEST_F(MeshMaterials, WhatIsBlendedIsNoLinesWhereTheRestIs) {
    const Rgba blue{0, 0, 255, 128};
    TriangleMesh floor, pane;
    addSquare(floor, 8, -1, kRed, 0);
    floor.textureCoordinates.clear();
    floor.materialOf.clear();
    pane.materials = {{}, {.flags = mesh::kIsBlended}};
    addSquare(pane, 6, 0, blue, 1);
    add(std::move(floor));
    add(std::move(pane));
    for (const auto whole : {fabric::Shading::Smooth, fabric::Shading::Wireframe}) {
        frame_.shading = whole;
        frame_.look.objects = {
            {{0, {}, fabric::Shading::Wireframe}, {1, {}, fabric::Shading::Smooth}}};
        expectNear(at(draw(), 1, -2), over(blue, kBackground), 1);
        frame_.look.objects = {
            {{0, {}, fabric::Shading::Smooth}, {1, {}, fabric::Shading::Wireframe}}};
        EXPECT_EQ(at(draw(), 1, -2), kRed);
    }
}

/// Below each other a large one of the object's sides, one of two and a small one of one.
TriangleMesh squaresOfAllSides() {
    TriangleMesh mesh;
    mesh.materials = {{}, {.flags = mesh::kIsTwoSided}, {.flags = mesh::kIsOneSided}};
    addSquare(mesh, 8, 0, kRed, 0);
    addSquare(mesh, 4, -1, kGreen, 1);
    addSquare(mesh, 2, -2, kBlue, 2);
    return mesh;
}

TEST_F(MeshMaterials, OneAndTwoSidesAreAsTheMaterialSays) {
    add(squaresOfAllSides());
    frame_.camera = {{0, 0, -10}, {0, 0, 0}, {0, 1, 0}, 60};  // from below: only backs
    EXPECT_EQ(at(draw(), 0, 0), kGreen) << "that of one side is not there";
    EXPECT_EQ(at(draw(), 3.5, 0), kRed);
    scene_.objects[0].singleSided = true;
    EXPECT_EQ(at(draw(), 0, 0), kGreen);
    EXPECT_EQ(at(draw(), 3.5, 0), kBackground);
    frame_.camera = {{0, 0, 10}, {0, 0, -1.5}, {0, 1, 0}, 60};
    EXPECT_EQ(at(draw(), 0, 0), kRed);
}

/// Depth tells which square is seen: a metre and two behind the red one's.
TEST_F(MeshMaterials, SidesStayWhereAnObjectHasAColour) {
    add(squaresOfAllSides());
    for (const double height : {-10.0, 10.0})
        for (const bool isSingleSided : {false, true}) {
            scene_.objects[0].singleSided = isSingleSided;
            frame_.camera = {{0, 0, height}, {0, 0, 0}, {0, 1, 0}, 60};
            frame_.look = {};
            const fabric::Image own = draw();
            frame_.look.objects = {{{0, Vec3(1, 1, 0)}}};
            const fabric::Image coloured = draw();
            EXPECT_EQ(coloured.depth, own.depth) << height << " " << isSingleSided;
            EXPECT_NE(coloured.colour, own.colour);
        }
}

TriangleMesh texturedSquare() {
    TriangleMesh mesh;
    mesh.materials = {{}, {.image = 0}};
    mesh.images = {mesh::encodeImage({256, 256, 0}, quarters(256))};
    addSquare(mesh, 8, 0, kWhite, 1);
    return mesh;
}

TEST_F(MeshMaterials, TexturesLeaveTheirFinestLevelsWhereMemoryIsShort) {
    add(texturedSquare());
    constexpr std::uint64_t kLimit = 1 << 16;  // a fifth of the image's levels
    RendererOptions options;
    options.memoryBytes = kLimit;
    renderer_.reset();
    auto small = Renderer::create(options);
    ASSERT_TRUE(small.ok()) << small.status();
    renderer_ = *std::move(small);
    EXPECT_EQ(at(draw(), -2, 2), kRed);
    EXPECT_EQ(at(draw(), 2, -2), kWhite);
    EXPECT_GT(renderer_->memory().deviceBytes, kLimit / 8);
    EXPECT_LE(renderer_->memory().deviceBytes, kLimit);
}

TEST_F(MeshMaterials, TexturesThatDoNotFitAtAllKeepTheSceneFromOpening) {
    add(texturedSquare());
    RendererOptions options;
    options.memoryBytes = 2;  // the coarsest level is one texel of four bytes
    renderer_.reset();
    auto small = Renderer::create(options);
    ASSERT_TRUE(small.ok()) << small.status();
    const absl::Status status = (*small)->openScene(scene_).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
    EXPECT_NE(status.message().find("its textures"), absl::string_view::npos) << status;
}

/// A raster of every third row and column has a pixel's centre in common with every ninth of the
/// view's. Checks of 3.6 pixels would be all grey to one that is filtered for its own.
TEST_F(MeshMaterials, TexturesAreAsFineInARasterAsInItsView) {
    std::vector<Rgba> checks;
    for (int i = 0; i < 256 * 256; ++i)
        checks.push_back((i / 8 + i / 256 / 8) % 2 == 0 ? kWhite : Rgba{0, 0, 0, 255});
    TriangleMesh square;
    square.materials = {{}, {.image = 0}};
    square.images = {mesh::encodeImage({256, 256, 0}, checks)};
    addSquare(square, 14, 0, kWhite, 1);
    add(std::move(square));
    const fabric::Image whole = draw();
    fabric::ChannelTask task = task_;
    task.raster = fabric::Raster{kSize / 3, kSize / 3, {0, 0}, {3, 3}};
    task.pixelViewport = fabric::pictureOf(task);
    const fabric::Image ninth = draw(task);
    ASSERT_EQ(whole.area, task_.pixelViewport);
    ASSERT_EQ(ninth.area, task.pixelViewport);
    double difference = 0, contrast = 0;
    for (int y = 0; y < kSize / 3; ++y)
        for (int x = 0; x < kSize / 3; ++x) {
            const int seen = ninth.colour[static_cast<std::size_t>(y * kSize / 3 + x)].g;
            const int inView =
                whole.colour[static_cast<std::size_t>((3 * y + 1) * kSize + 3 * x + 1)].g;
            difference += std::abs(seen - inView);
            contrast += std::abs(inView - 128);
        }
    EXPECT_GT(contrast / (kSize * kSize / 9), 60);
    EXPECT_LT(difference / (kSize * kSize / 9), 4);
}

TEST_F(MeshMaterials, AnImageThatIsDamagedIsDrawnInItsMeanColourAndReported) {
    add(texturedSquare());
    std::string bytes = test::readFile(scene_.objects[0].path);
    bytes[bytes.size() - 100] = static_cast<char>(bytes[bytes.size() - 100] ^ 1);
    test::writeFile(scene_.objects[0].path, bytes);
    const fabric::Image image = draw();
    expectNear(at(image, -2, 2), {180, 180, 180, 255}, 1);
    EXPECT_EQ(at(image, -2, 2), at(image, 2, -2));
    EXPECT_FALSE(statistics_.complete);
    EXPECT_EQ(statistics_.pagesMissing, 1U);
    EXPECT_EQ(statistics_.pagesFailed, 1U);
    frame_.camera.target = {0, 0, 20};  // away from it
    draw();
    EXPECT_TRUE(statistics_.complete);
    EXPECT_EQ(statistics_.pagesMissing, 0U);
}

/// Squares, opaque, with holes and blended by turns, each a node of its own, turned and stacked.
TriangleMesh stack() {
    TriangleMesh mesh;
    mesh.materials = {{},
                      {.image = 0},
                      {.image = 0, .flags = mesh::kIsBlended},
                      {.flags = mesh::kIsBlended},
                      {.image = 0, .alphaCutoff = 0.5F}};
    std::vector<Rgba> texels = quarters(16);
    for (std::size_t i = 0; i < texels.size(); i += 3) texels[i].a = 90;
    mesh.images = {mesh::encodeImage({16, 16, mesh::kHasAlpha}, texels)};
    for (int i = 0; i < 40; ++i) {
        const auto first = mesh.positions.size();
        addSquare(mesh, 3, 0, {static_cast<std::uint8_t>(40 * i), 200, 90, 128},
                  static_cast<std::uint16_t>(i * 7 % 5));
        for (std::size_t v = first; v < mesh.positions.size(); ++v) {
            const Vec3 flat = mesh.positions[v];
            const double turn = 0.7 * i;
            mesh.positions[v] = Vec3(flat.x * std::cos(turn), flat.y, flat.x * std::sin(turn)) +
                                Vec3(i % 5 - 2, i / 5 % 4 - 1.5, 0.3 * i - 6);
        }
    }
    return mesh;
}  // namespace eyrie

TEST_F(MeshMaterials, EveryDecompositionGivesTheWholePicture) {
    add(stack(), 2);
    frame_.camera = {{6, -5, 7}, {0, 0, 0}, {0, 0, 1}, 60};
    task_.viewWidth = task_.viewHeight = 300;
    task_.pixelViewport = {0, 0, 300, 300};
    const fabric::Image whole = draw();
    ASSERT_GT(whole.area.width, 200);
    for (const int cut : {1, 77, 150, 281}) {  // 2D
        for (const fabric::PixelViewport& part :
             {fabric::PixelViewport{0, 0, cut, 300}, {cut, 0, 300 - cut, 300}}) {
            fabric::ChannelTask task = task_;
            task.pixelViewport = part;
            const fabric::Image image = draw(task);
            for (int y = 0; y < image.area.height; ++y)
                for (int x = 0; x < image.area.width; ++x) {
                    const auto in = [&](const fabric::Image& of) {
                        return static_cast<std::size_t>((image.area.y + y - of.area.y) *
                                                            of.area.width +
                                                        image.area.x + x - of.area.x);
                    };
                    ASSERT_EQ(image.colour[in(image)], whole.colour[in(whole)]) << x << ' ' << y;
                    ASSERT_EQ(image.depth[in(image)], whole.depth[in(whole)]) << x << ' ' << y;
                }
        }
    }
    for (const double cut : {0.2, 0.5, 0.77}) {  // DB
        fabric::ChannelTask task = task_;
        task.range = {0, cut};
        fabric::Image merged = fabric::makeImage(whole.area, kBackground, true);
        fabric::paste(draw(task), merged);
        task.range = {cut, 1};
        fabric::mergeDepth(draw(task), merged);
        EXPECT_EQ(merged, whole) << cut;
    }
}

}  // namespace
}  // namespace eyrie
