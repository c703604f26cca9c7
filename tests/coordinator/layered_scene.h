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

    /// `fillsView`: what is `width` x `height` here is the view, whatever its size; otherwise
    /// rectangles are in its pixels.
    explicit LayeredScene(std::uint32_t seed, int width = 41, int height = 23, int count = 30,
                          bool fillsView = false)
        : width_(width), height_(height), fillsView_(fillsView) {
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

    /// As a renderer answers: the part that its rectangles cover. They lie beside where they are by
    /// the eye's place and the wall's, nearer ones further.
    fabric::ChannelResult draw(const fabric::ChannelTask& task) const {
        fabric::ChannelResult result;
        fabric::Image image = fabric::makeImage(task.pixelViewport, kBackground, true);
        fabric::PixelViewport covered;
        for (std::size_t i = 0; i < rectangles_.size(); ++i) {
            const double place = static_cast<double>(i) / static_cast<double>(rectangles_.size());
            if (!task.range.contains(place))
                continue;
            covered = enclosing(covered, drawSampled(rectangles_[i], task, image));
            ++result.statistics.nodes;
        }
        result.image = fabric::makeImage(covered, kBackground, true);
        for (int y = covered.y; y < covered.y + covered.height; ++y)
            for (int x = covered.x; x < covered.x + covered.width; ++x) {
                result.image.colour[offset(covered, x, y)] = image.colour[offset(image.area, x, y)];
                result.image.depth[offset(covered, x, y)] = image.depth[offset(image.area, x, y)];
            }
        if (!task.wantsDepth)
            result.image.depth.clear();
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

    static std::size_t offset(const fabric::PixelViewport& area, int x, int y) {
        return static_cast<std::size_t>((y - area.y) * area.width + (x - area.x));
    }

    /// First pixel of those from `begin` on whose sample is not before `edge`, in scene units.
    static int firstNotBefore(double edge, int begin, int count, double origin, double step,
                              double unitsPerPixel, double moved) {
        int pixel = begin;
        while (pixel < begin + count &&
               (origin + (pixel + .5) * step) * unitsPerPixel + moved < edge)
            ++pixel;
        return pixel;
    }

    /// Returns which pixels it covers.
    fabric::PixelViewport drawSampled(const Rectangle& rectangle, const fabric::ChannelTask& task,
                                      fabric::Image& image) const {
        fabric::Vec2 origin(0, 0);
        fabric::Vec2 step(1, 1);
        if (task.raster) {
            origin = task.raster->origin;
            step = task.raster->step;
        }
        double moved = 0;
        if (task.sight)
            moved = (task.sight->eye.x * 40 + task.sight->frustum.left) * rectangle.depth;
        const double across = fillsView_ ? static_cast<double>(width_) / task.viewWidth : 1;
        const double upward = fillsView_ ? static_cast<double>(height_) / task.viewHeight : 1;
        const fabric::PixelViewport& area = task.pixelViewport;
        const auto column = [&](int edge) {
            return firstNotBefore(edge, area.x, area.width, origin.x, step.x, across, moved);
        };
        const auto row = [&](int edge) {
            return firstNotBefore(edge, area.y, area.height, origin.y, step.y, upward, 0);
        };
        const fabric::PixelViewport& pixels = rectangle.pixels;
        const int left = column(pixels.x);
        const int bottom = row(pixels.y);
        const fabric::PixelViewport part{left, bottom, column(pixels.x + pixels.width) - left,
                                         row(pixels.y + pixels.height) - bottom};
        if (part.isEmpty())
            return {};
        drawRectangle({part, rectangle.depth, rectangle.colour}, image);
        return part;
    }

    int width_;
    int height_;
    bool fillsView_;
    std::vector<Rectangle> rectangles_;
};

}  // namespace eyrie::coordinator
