// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/paging_fixture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "renderer/gl/debug_output.h"
#include "renderer/import/terrain_import.h"
#include "tests/renderer/sample_scene.h"

namespace eyrie::test {

using fabric::Camera;
using fabric::ChannelResult;
using fabric::Completeness;
using fabric::Vec3;
using terrain::TileId;

namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 360;

}  // namespace

void Paging::SetUp() {
    gl::setOnGlError(gl::OnGlError::Abort);
    auto scene = sampleScene(SampleKind::Terrain);
    ASSERT_TRUE(scene.ok()) << scene.status();
    scene_ = *scene;
    copyAndOpen();
}

void Paging::take(const terrain::HeightGrid& grid) {
    scene_.objects[0].path = folder_.path("own.eyt");
    const auto report = import::importTerrain(grid, {"own", "", 0}, scene_.objects[0].path, {});
    ASSERT_TRUE(report.ok()) << report.status();
    copyAndOpen();
}

void Paging::copyAndOpen() {
    auto file = terrain::EytFile::open(scene_.objects[0].path);
    ASSERT_TRUE(file.ok()) << file.status();
    file_ = *file;
    copy_ = folder_.path("copy.eyt");
    std::filesystem::copy_file(scene_.objects[0].path, copy_,
                               std::filesystem::copy_options::overwrite_existing);
}

void Paging::flip(std::uint32_t page) {
    const terrain::PageRecord& record = file_->index().pages[page];
    if (record.bytes == 0)
        return;
    std::fstream file(copy_, std::ios::in | std::ios::out | std::ios::binary);
    const auto at = static_cast<std::streamoff>(record.offset + record.bytes / 2);
    file.seekg(at);
    const char byte = static_cast<char>(~file.get());
    file.seekp(at);
    file.put(byte);
}

void Paging::withholdWest(int level) {
    for (std::uint32_t page = 0; page < quadtree().pageCount(); ++page) {
        const TileId first = quadtree().firstTileOfPage(page);
        const bool isWest = 2 * first.x < quadtree().tilesX(first.level);
        if (first.level < level && isWest)
            flip(page);
    }
}

void Paging::withholdLevel(int level) {
    for (std::uint32_t page = 0; page < quadtree().pageCount(); ++page)
        if (quadtree().firstTileOfPage(page).level == level)
            flip(page);
}

std::unique_ptr<Renderer> Paging::open(const std::string& path, const RendererOptions& options) {
    auto renderer = Renderer::create(options);
    EXPECT_TRUE(renderer.ok()) << renderer.status();
    fabric::Scene scene = scene_;
    scene.objects[0].path = path;
    const auto info = (*renderer)->openScene(scene);
    EXPECT_TRUE(info.ok()) << info.status();
    return *std::move(renderer);
}

Camera Paging::lookingDown(int i) const {
    const fabric::Box box = file_->index().bounds();
    Camera camera;
    camera.eye = box.centre() + Vec3(200.0 * (i % 5 - 2), 1500.0 * (i - 4), 0);
    camera.eye.z = box.max.z + 300.0 * (i + 1);
    camera.target = camera.eye + Vec3(300.0 * (i % 3 - 1), 200.0 * (i % 2), -1000);
    camera.up = {0, 1, 0};
    return camera;
}

Camera Paging::lookingAhead(int i) const {
    const fabric::Box box = file_->index().bounds();
    const double azimuth = 0.7 * i;
    Camera camera;
    camera.eye = box.centre();
    camera.eye.z = box.max.z + 10 + 100 * i;
    camera.target = camera.eye + Vec3(std::cos(azimuth), std::sin(azimuth), 0);
    return camera;
}

ChannelResult Paging::draw(Renderer& renderer, const Camera& camera, Completeness completeness,
                           double tau, const fabric::Range& range) {
    fabric::FrameData frame;
    frame.camera = camera;
    frame.tauPixels = tau;
    fabric::ChannelTask task;
    task.viewWidth = kWidth;
    task.viewHeight = kHeight;
    task.pixelViewport = {0, 0, kWidth, kHeight};
    task.wantsDepth = true;
    task.completeness = completeness;
    task.range = range;
    auto result = renderer.render(frame, task);
    EXPECT_TRUE(result.ok()) << result.status();
    if (!result.ok())
        return {};
    fabric::Image whole = fabric::makeImage(task.pixelViewport, scene_.background, true);
    if (!result->image.area.isEmpty())
        fabric::paste(result->image, whole);
    return {std::move(whole), result->statistics};
}

ChannelResult Paging::converge(Renderer& renderer, const Camera& camera) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < deadline) {
        ChannelResult result = draw(renderer, camera, Completeness::Interactive);
        if (result.statistics.complete)
            return result;
        EXPECT_GT(result.statistics.pagesMissing, 0U);
    }
    ADD_FAILURE() << "no interactive frame was complete in time";
    return {};
}

std::size_t Paging::uncovered(const fabric::Image& image) {
    return static_cast<std::size_t>(
        std::count_if(image.depth.begin(), image.depth.end(), [](float d) { return d <= 0; }));
}

std::size_t Paging::holesBelowTerrain(const fabric::Image& image) {
    std::size_t holes = 0;
    for (std::size_t x = 0; x < kWidth; ++x) {
        bool isBelow = false;
        for (std::size_t y = kHeight; y-- > 0;) {  // rows go from the bottom up
            const bool isCovered = image.depth[y * kWidth + x] > 0;
            holes += isBelow && !isCovered ? 1 : 0;
            isBelow = isBelow || isCovered;
        }
    }
    return holes;
}

std::size_t Paging::different(const fabric::Image& one, const fabric::Image& other) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < one.depth.size(); ++i)
        count += one.depth[i] == other.depth[i] && one.colour[i] == other.colour[i] ? 0 : 1;
    return count;
}

}  // namespace eyrie::test
