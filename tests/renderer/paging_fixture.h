// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "fabric/camera.h"
#include "fabric/channel_task.h"
#include "fabric/image.h"
#include "fabric/scene.h"
#include "renderer/renderer.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/height_grid.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::test {

/// The sample terrain and a copy of it whose pages can be damaged, drawn whole.
class Paging : public testing::Test {
protected:
    static constexpr auto kPatience = std::chrono::seconds(30);

    void SetUp() override;

    /// Takes this in place of the sample terrain.
    void take(const terrain::HeightGrid& grid);

    const terrain::Quadtree& quadtree() const { return file_->index().quadtree; }

    /// Damages the copy's page, or repairs it when it is damaged.
    void flip(std::uint32_t page);

    /// Damages the pages of all levels below `level` that lie in the western half.
    void withholdWest(int level);

    /// Damages the pages of one level everywhere.
    void withholdLevel(int level);

    /// A renderer of the scene whose terrain is the file at `path`.
    std::unique_ptr<Renderer> open(const std::string& path, const RendererOptions& options = {});

    /// Above the border between the western and the eastern half; only terrain can be seen.
    fabric::Camera lookingDown(int i) const;

    /// Level, so that a column of the picture is a vertical plane of the world.
    fabric::Camera lookingAhead(int i) const;

    fabric::ChannelResult draw(Renderer& renderer, const fabric::Camera& camera,
                               fabric::Completeness completeness, double tau = 1,
                               const fabric::Range& range = {});

    /// Interactive frames until one is complete.
    fabric::ChannelResult converge(Renderer& renderer, const fabric::Camera& camera);

    /// Pixels of the background.
    static std::size_t uncovered(const fabric::Image& image);

    /// Pixels through which one sees the background below terrain.
    static std::size_t holesBelowTerrain(const fabric::Image& image);

    /// Pixels, in colour or depth.
    static std::size_t different(const fabric::Image& one, const fabric::Image& other);

    fabric::Scene scene_;
    std::shared_ptr<const terrain::EytFile> file_;
    std::string copy_;

private:
    void copyAndOpen();

    TemporaryFolder folder_;
};

}  // namespace eyrie::test
