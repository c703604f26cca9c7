// SPDX-License-Identifier: Apache-2.0
// Terrain whose pages come late, or before they are needed.
#include <algorithm>
#include <chrono>
#include <cstdint>

#include <gtest/gtest.h>

#include "renderer/renderer.h"
#include "renderer/terrain/eyt_format.h"
#include "tests/renderer/paging_fixture.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::ChannelResult;
using fabric::Completeness;
using fabric::Vec3;
using test::Paging;

TEST_F(Paging, RenderersOfOneThreadTakeTurns) {
    const auto one = open(scene_.objects[0].path);
    const ChannelResult before = draw(*one, lookingDown(1), Completeness::Complete);
    {
        const auto two = open(scene_.objects[0].path);
        draw(*two, lookingDown(2), Completeness::Complete);
        draw(*one, lookingDown(3), Completeness::Complete);
        EXPECT_TRUE(draw(*two, lookingDown(1), Completeness::Complete).image == before.image);
    }
    EXPECT_TRUE(draw(*one, lookingDown(1), Completeness::Complete).image == before.image);
}

TEST_F(Paging, AnInteractiveFrameDoesNotWaitAndHasNoHoles) {
    const auto renderer = open(scene_.objects[0].path);
    const ChannelResult first = draw(*renderer, lookingDown(0), Completeness::Interactive, 0.25);
    EXPECT_FALSE(first.statistics.complete);
    EXPECT_GT(first.statistics.tauAchievedPixels, 0.25);
    EXPECT_EQ(uncovered(first.image), 0U);
    for (int i = 0; i < 60; ++i)
        EXPECT_EQ(uncovered(draw(*renderer, lookingDown(i % 9), Completeness::Interactive).image),
                  0U);
}

TEST_F(Paging, InteractiveFramesBecomeTheCompleteOne) {
    const auto waiting = open(scene_.objects[0].path);
    const auto interactive = open(scene_.objects[0].path);
    for (int i = 0; i < 4; ++i) {
        const ChannelResult expected = draw(*waiting, lookingAhead(i), Completeness::Complete);
        EXPECT_TRUE(expected.statistics.complete);
        const ChannelResult actual = converge(*interactive, lookingAhead(i));
        EXPECT_EQ(different(expected.image, actual.image), 0U) << "camera " << i;
        EXPECT_EQ(actual.statistics.tauAchievedPixels, expected.statistics.tauAchievedPixels);
        EXPECT_EQ(actual.statistics.triangles, expected.statistics.triangles);
    }
}

/// Looking away from the terrain, beside which the camera is, through a lens as long as makes all
/// of it what may be needed soon.
TEST_F(Paging, WhatMayBeNeededSoonIsThereWhenTheCameraTurns) {
    const auto pages = static_cast<std::uint64_t>(
        std::ranges::count_if(file_->index().pages, [](auto& page) { return page.bytes > 0; }));
    const fabric::Box box = file_->index().bounds();
    Camera camera;
    camera.eye = {box.min.x - 500, box.centre().y, box.max.z + 500};
    camera.target = camera.eye - Vec3(1, 0, 0);
    camera.fovYDegrees = 2;
    const auto renderer = open(scene_.objects[0].path);
    std::uint64_t loaded = 1;  // the top tile's
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (loaded < pages && std::chrono::steady_clock::now() < end) {
        const ChannelResult away = draw(*renderer, camera, Completeness::Interactive, 0.01);
        EXPECT_EQ(away.statistics.nodes, 0U);
        EXPECT_TRUE(away.statistics.complete);
        loaded += away.statistics.pagesLoaded;
    }
    EXPECT_EQ(loaded, pages);
    camera.target = camera.eye + Vec3(1, 0, -0.4);
    camera.fovYDegrees = Camera().fovYDegrees;
    ChannelResult turned = draw(*renderer, camera, Completeness::Interactive, 0.1);
    while (!turned.statistics.complete && std::chrono::steady_clock::now() < end) {
        EXPECT_EQ(turned.statistics.pagesLoaded, 0U);
        turned = draw(*renderer, camera, Completeness::Interactive, 0.1);
    }
    EXPECT_EQ(turned.statistics.pagesLoaded, 0U);
    EXPECT_GT(turned.statistics.nodes, 10U);
    const ChannelResult complete =
        draw(*open(scene_.objects[0].path), camera, Completeness::Complete, 0.1);
    EXPECT_EQ(different(turned.image, complete.image), 0U);
}

}  // namespace
}  // namespace eyrie
