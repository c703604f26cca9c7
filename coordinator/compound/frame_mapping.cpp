// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/frame_mapping.h"

#include <algorithm>
#include <cmath>

namespace eyrie::compound {
namespace {

using fabric::Regridding;

/// Both views as they lie in their pictures.
FrameMapping toScale(const fabric::PixelViewport& from, const fabric::PixelViewport& to,
                     std::vector<Regridding> rest) {
    FrameMapping mapping;
    mapping.regriddings = {{Regridding::Kind::Zoom, to, from.width, from.height}};
    if (rest.empty()) {
        mapping.fromX = from.x;
        mapping.fromY = from.y;
    } else {
        rest.front().of.x -= from.x;
        rest.front().of.y -= from.y;
    }
    mapping.regriddings.insert(mapping.regriddings.end(), rest.begin(), rest.end());
    return mapping;
}

/// Where a point of the pixels before `step` lies in those that it makes.
fabric::Vec2 through(const Regridding& step, const fabric::Vec2& point) {
    const fabric::Vec2 inside = point - fabric::Vec2(step.of.x, step.of.y);
    if (step.kind == Regridding::Kind::Zoom)
        return {inside.x * step.width / step.of.width, inside.y * step.height / step.of.height};
    return {(inside.x - step.firstColumn) / step.everyColumn,
            (inside.y - step.firstRow) / step.everyRow};
}

/// Of `frame`, whose picture begins at `origin` of its framebuffer: its pixels, each as large as
/// `zoom` says, from where the placing begins.
FrameMapping magnified(const OutputFrame& frame, const fabric::Vec2& origin,
                       const fabric::PixelViewport& placed, const fabric::Vec2& zoom) {
    const fabric::PixelViewport& part = frame.part;
    const std::int32_t width = frame.zoom ? frame.zoom->width : part.width;
    const std::int32_t height = frame.zoom ? frame.zoom->height : part.height;
    const auto reach = [](double begin, double size, std::int32_t& at, std::int32_t& pixels) {
        at = static_cast<std::int32_t>(std::floor(begin + .5));
        pixels = std::max(1, static_cast<std::int32_t>(std::floor(begin + size + .5)) - at);
    };
    Regridding made{Regridding::Kind::Zoom, {}, width, height};
    reach(placed.x + zoom.x * (part.x - origin.x) * width / part.width, zoom.x * width, made.of.x,
          made.of.width);
    reach(placed.y + zoom.y * (part.y - origin.y) * height / part.height, zoom.y * height,
          made.of.y, made.of.height);
    return {{made}, frame.zoom ? 0 : part.x, frame.zoom ? 0 : part.y};
}

FrameMapping moved(FrameMapping mapping, const fabric::PixelViewport& part, std::int32_t right,
                   std::int32_t up) {
    if (right == 0 && up == 0)
        return mapping;
    if (mapping.regriddings.empty()) {
        mapping.regriddings = {{Regridding::Kind::Zoom, part, part.width, part.height}};
        mapping.fromX = part.x;
        mapping.fromY = part.y;
    }
    mapping.regriddings.front().of.x += right;
    mapping.regriddings.front().of.y += up;
    return mapping;
}

/// Where the picture that `source` is a part of begins in `target`, both to scale.
fabric::PixelViewport beginOf(const WorkingBuffer& source, const WorkingBuffer& target,
                              const config::ResolvedConfiguration& resolved) {
    const config::Destination& from = resolved.destinations[source.destination];
    const fabric::PixelViewport& view = from.panorama.view;
    const fabric::PixelViewport& to = resolved.destinations[target.destination].panorama.view;
    const auto at = [](std::int32_t distance, std::int32_t pixels, std::int32_t of) {
        return static_cast<std::int32_t>(
            std::floor(static_cast<double>(distance) * pixels / of + .5));
    };
    return {to.x + at(from.partOfPanorama.x - view.x, to.width, view.width),
            to.y + at(from.partOfPanorama.y - view.y, to.height, view.height), 0, 0};
}

/// Where nothing is said of it: within a destination `way`, between two to scale.
FrameMapping unplaced(const OutputFrame& frame, const WorkingBuffer& source,
                      const WorkingBuffer& target, const config::ResolvedConfiguration& resolved,
                      std::vector<Regridding> way) {
    if (frame.zoom)
        way.push_back(*frame.zoom);
    if (source.destination == target.destination)
        return {std::move(way), 0, 0};
    return toScale(resolved.destinations[source.destination].panorama.view,
                   resolved.destinations[target.destination].panorama.view, std::move(way));
}

}  // namespace

std::optional<FrameMapping> mappingOf(const config::ResolvedConfiguration& resolved,
                                      const WorkList& list, const Input& input,
                                      std::size_t framebuffer) {
    const OutputFrame& frame = list.frames[input.frame];
    const WorkingBuffer& source = list.framebuffers[frame.framebuffer];
    const WorkingBuffer& target = list.framebuffers[framebuffer];
    const config::Destination& shown = resolved.destinations[target.destination];
    std::vector<Regridding> way = source.lattice.regriddings;
    const std::vector<Regridding>& begun = target.lattice.regriddings;
    const bool isShared = source.destination == target.destination;
    if (isShared) {
        if (way.size() < begun.size() || !std::equal(begun.begin(), begun.end(), way.begin()))
            return std::nullopt;
        way.erase(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(begun.size()));
    } else if (!begun.empty() || shown.panorama.view.isEmpty() ||
               resolved.destinations[source.destination].panorama.view.isEmpty()) {
        return std::nullopt;
    }
    if (!input.placing)
        return unplaced(frame, source, target, resolved, std::move(way));
    const Placing& placing = *input.placing;
    const fabric::PixelViewport& area = source.framebuffer.area;
    if (placing.zoom) {
        fabric::Vec2 origin(area.x, area.y);  // of the picture that the frame is a part of
        if (isShared) {
            origin = {placing.whole.x, placing.whole.y};
            for (const Regridding& step : way) origin = through(step, origin);
        }
        return magnified(frame, origin, placing.part, *placing.zoom);
    }
    const fabric::PixelViewport begin =
        isShared ? placing.whole : beginOf(source, target, resolved);
    return moved(unplaced(frame, source, target, resolved, std::move(way)), frame.part,
                 placing.part.x - begin.x, placing.part.y - begin.y);
}

}  // namespace eyrie::compound
