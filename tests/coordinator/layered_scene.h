// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "fabric/channel_task.h"

namespace eyrie::coordinator {

/// Opaque rectangles facing the eye, each at one depth and one position in the data: a scene simple
/// enough to draw by its definition, whole or any channel of it. Depths are few, so many tie.
class LayeredScene {
public:
    static constexpr fabric::Rgba kBackground{10, 20, 30, 255};

    explicit LayeredScene(std::uint32_t seed, int width = 41, int height = 23, int count = 30) {
        std::mt19937 random(seed);
        const auto below = [&](int bound) {
            return static_cast<int>(random() % static_cast<unsigned>(bound));
        };
        for (int i = 0; i < count; ++i)
            rectangles_.push_back(
                {{below(width), below(height), 1 + below(width), 1 + below(height)},
                 static_cast<float>(1 + below(4)) / 4,
                 static_cast<std::uint8_t>(1 + i)});
    }

    /// As a renderer answers: the part that its rectangles cover.
    fabric::ChannelResult draw(const fabric::ChannelTask& task) const {
        std::vector<const Rectangle*> drawn;
        fabric::PixelViewport covered;
        for (std::size_t i = 0; i < rectangles_.size(); ++i) {
            const double place = static_cast<double>(i) / static_cast<double>(rectangles_.size());
            if (!task.range.contains(place))
                continue;
            drawn.push_back(&rectangles_[i]);
            covered = enclosing(covered, rectangles_[i].pixels);
        }
        fabric::ChannelResult result;
        result.image =
            fabric::makeImage(intersection(covered, task.pixelViewport), kBackground, true);
        for (const Rectangle* rectangle : drawn) drawRectangle(*rectangle, result.image);
        if (!task.wantsDepth)
            result.image.depth.clear();
        result.statistics.nodes = drawn.size();
        return result;
    }

    /// The picture that every decomposition has to make.
    fabric::Image whole(int width, int height) const {
        fabric::Image picture = fabric::makeImage({0, 0, width, height}, kBackground, true);
        for (const Rectangle& rectangle : rectangles_) drawRectangle(rectangle, picture);
        return picture;
    }

private:
    struct Rectangle {
        fabric::PixelViewport pixels;
        float depth;
        std::uint8_t colour;
    };

    static void drawRectangle(const Rectangle& rectangle, fabric::Image& image) {
        const fabric::PixelViewport part = fabric::intersection(rectangle.pixels, image.area);
        for (int y = part.y; y < part.y + part.height; ++y)
            for (int x = part.x; x < part.x + part.width; ++x) {
                const auto at = static_cast<std::size_t>((y - image.area.y) * image.area.width +
                                                         (x - image.area.x));
                if (rectangle.depth > image.depth[at]) {
                    image.depth[at] = rectangle.depth;
                    image.colour[at] = {rectangle.colour, 0, 0, 255};
                }
            }
    }

    std::vector<Rectangle> rectangles_;
};

}  // namespace eyrie::coordinator
