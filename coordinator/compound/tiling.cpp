// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/tiling.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace eyrie::compound {
namespace {

using fabric::PixelViewport;
using Tiles = std::vector<Tile>;

bool overlap(const PixelViewport& a, const PixelViewport& b) {
    return !intersection(a, b).isEmpty();
}

/// Those of `tiles` that lie in `part`. Nothing where one is cut by its border.
std::optional<Tiles> tilesIn(const PixelViewport& part, const Tiles& tiles) {
    Tiles inside;
    for (const Tile& tile : tiles)
        if (part.contains(tile.area))
            inside.push_back(tile);
        else if (overlap(part, tile.area))
            return std::nullopt;
    return inside;
}

void move(Tiles& tiles, std::int32_t right, std::int32_t up) {
    for (Tile& tile : tiles) {
        tile.area.x += right;
        tile.area.y += up;
    }
}

/// Nothing is left of what lies in `part`. False where a tile is cut by its border.
bool clear(const PixelViewport& part, Tiles& tiles) {
    const bool isCut = !tilesIn(part, tiles);
    std::erase_if(tiles, [&](const Tile& tile) { return overlap(part, tile.area); });
    return !isCut;
}

/// False where one comes over another.
bool add(const Tiles& tiles, Tiles& target) {
    for (const Tile& tile : tiles)
        if (std::ranges::any_of(target,
                                [&](const Tile& each) { return overlap(each.area, tile.area); }))
            return false;
    target.insert(target.end(), tiles.begin(), tiles.end());
    return true;
}

/// What makes up `part` comes into a framebuffer.
bool combine(const Tiles& tiles, const PixelViewport& part, Combine how, Tiles& layer) {
    return (how != Combine::Replace || clear(part, layer)) && add(tiles, layer);
}

/// Carries a plan's steps out on rectangles in place of pixels. Each function says whether tiles
/// are left tiles.
class Layout {
public:
    explicit Layout(const Plan& plan)
        : plan_(plan), layers_(plan.framebuffers.size()), frames_(plan.frames) {}

    std::optional<Tiles> layOut() {
        for (const Step& step : plan_.steps)
            if (!std::visit([this](const auto& each) { return carryOut(each); }, step))
                return std::nullopt;
        return seen(plan_.pictures.front());
    }

private:
    bool carryOut(const Clear& step) { return clear(step.part, layers_[step.framebuffer]); }

    bool carryOut(const Draw& step) {
        const fabric::ChannelTask& task = plan_.draws[step.draw].task;
        return !task.wantsDepth && combine({{step.draw, task.pixelViewport}}, task.pixelViewport,
                                           step.combine, layers_[step.framebuffer]);
    }

    bool carryOut(const ReadBack& step) {
        auto tiles = tilesIn(step.part, layers_[step.framebuffer]);
        if (!tiles || step.zoom || step.withDepth)
            return false;
        frames_[step.frame] = *std::move(tiles);
        return true;
    }

    bool carryOut(const Assemble& step) {
        const auto tiles = tilesIn(step.part, frames_[step.frame]);
        const bool isInPlace = step.regriddings.empty() && step.fromX == 0 && step.fromY == 0;
        return tiles && isInPlace &&
               combine(*tiles, step.part, step.combine, layers_[step.framebuffer]);
    }

    bool carryOut(const Average& /*step*/) { return false; }

    std::optional<Tiles> seen(const Picture& picture) const {
        Tiles whole;
        for (const PicturePart& part : picture.parts) {
            auto tiles = tilesIn(part.part, layers_[part.framebuffer]);
            if (!tiles)
                return std::nullopt;
            move(*tiles, part.x - part.part.x, part.y - part.part.y);
            tiles = tilesIn(picture.area, *tiles);
            if (!tiles || !add(*tiles, whole))
                return std::nullopt;
        }
        std::int64_t covered = 0;
        for (const Tile& tile : whole) covered += tile.area.area();
        return covered == picture.area.area() ? std::optional(std::move(whole)) : std::nullopt;
    }

    const Plan& plan_;
    std::vector<Tiles> layers_;  ///< of framebuffers
    std::vector<Tiles> frames_;
};

}  // namespace

std::optional<std::vector<Tile>> tilesOf(const Plan& plan) {
    if (plan.pictures.size() != 1)
        return std::nullopt;
    const Picture& picture = plan.pictures.front();
    const bool isOneEyes = picture.stereo == Stereo::Separate && picture.right.empty();
    return isOneEyes && !picture.withDepth ? Layout(plan).layOut() : std::nullopt;
}

}  // namespace eyrie::compound
