// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/seen_areas.h"

namespace eyrie::compound {
namespace {

using fabric::SeenArea;
using fabric::Vec2;

fabric::Sight sightOf(const fabric::ChannelTask& task, double fovYDegrees) {
    if (task.sight)
        return *task.sight;
    fabric::Sight ahead;
    ahead.frustum = fabric::symmetricFrustum(fovYDegrees,
                                             static_cast<double>(task.viewWidth) / task.viewHeight);
    return ahead;
}

/// Appends one eye's parts, its picture being a rectangle of all: corner and size are shares.
void add(const std::vector<PicturePart>& parts, const Picture& picture, const WorkList& list,
         double fovYDegrees, const Vec2& corner, const Vec2& size, std::vector<SeenArea>& areas) {
    const Vec2 whole(picture.area.width, picture.area.height);
    for (const PicturePart& part : parts) {
        const fabric::ChannelTask* const task = list.drawOf(part.framebuffer);
        if (task == nullptr)
            continue;
        const Vec2 at(part.x - picture.area.x, part.y - picture.area.y);
        const Vec2 pixels(part.part.width, part.part.height);
        const Vec2 view(task->viewWidth, task->viewHeight);
        SeenArea area{corner + at / whole * size, pixels / whole * size,
                      sightOf(*task, fovYDegrees)};
        area.sight.frustum =
            fabric::part(area.sight.frustum, Vec2(part.part.x, part.part.y) / view, pixels / view);
        areas.push_back(area);
    }
}

/// The picture is what the camera sees straight ahead, all of it.
bool isCamerasOwn(const Picture& picture, const WorkList& list) {
    if (picture.parts.size() != 1 || !picture.right.empty())
        return false;
    const PicturePart& part = picture.parts.front();
    const fabric::ChannelTask* const task = list.drawOf(part.framebuffer);
    const fabric::PixelViewport place{part.x, part.y, part.part.width, part.part.height};
    return task != nullptr && !task->sight && place == picture.area &&
           part.part == fabric::PixelViewport{0, 0, task->viewWidth, task->viewHeight};
}

}  // namespace

fabric::SeenAreas seenAreas(const Picture& picture, const WorkList& list, double fovYDegrees) {
    if (isCamerasOwn(picture, list))
        return std::nullopt;
    std::vector<SeenArea> areas;
    const auto place = [&](const std::vector<PicturePart>& parts, Vec2 corner, Vec2 size) {
        add(parts, picture, list, fovYDegrees, corner, size, areas);
    };
    switch (picture.stereo) {
        case Stereo::SideBySide:
            place(picture.parts, {0, 0}, {.5, 1});
            place(picture.right, {.5, 0}, {.5, 1});
            break;
        case Stereo::TopBottom:
            place(picture.parts, {0, .5}, {1, .5});
            place(picture.right, {0, 0}, {1, .5});
            break;
        case Stereo::Configured:
        case Stereo::Anaglyph:
        case Stereo::Separate:
            place(picture.parts, {0, 0}, {1, 1});
            break;
    }
    return areas;
}

}  // namespace eyrie::compound
