// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/destinations.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "coordinator/config/pixels.h"
#include "fabric/channel_task.h"

namespace eyrie::config {
namespace {

constexpr double kUsualEyeBase = .05;  // metres
constexpr std::size_t kMostPairs = 20'000;

/// Of what is in pixels the size; a screen's window manager would place it.
fabric::PixelViewport placed(const fabric::PixelViewport& whole,
                             const std::optional<Viewport>& viewport) {
    if (!viewport)
        return whole;
    if (!viewport->isPixels())
        return part(whole, *viewport);
    return {static_cast<std::int32_t>(viewport->x), static_cast<std::int32_t>(viewport->y),
            static_cast<std::int32_t>(viewport->width),
            static_cast<std::int32_t>(viewport->height)};
}

/// A wall, and the part of the canvas that is seen on it.
struct Shown {
    std::optional<Wall> wall;
    Viewport onCanvas;
};

/// The view's own; else the segment's; else the canvas's; else what the view's camera sees.
Shown shownBy(const Canvas& canvas, const Segment& segment, const View& view) {
    if (const auto wall = wallOf(view.surface))
        return {wall, view.viewport};
    if (const auto wall = wallOf(segment.surface))
        return {wall, segment.viewport};
    if (const auto wall = wallOf(canvas.surface))
        return {wall, {}};
    return {std::nullopt, view.viewport};
}

Eyes shownEyes(const View& view, const Segment& segment) {
    if (!view.isStereo)
        return {segment.eyes.cyclop, false, false};
    return {false, segment.eyes.left, segment.eyes.right};
}

/// A rectangle of a canvas whose pixels are known: all of it, or one segment.
struct Reference {
    fabric::PixelViewport pixels;
    Viewport onCanvas;

    fabric::PixelViewport pixelsAt(const Viewport& viewport) const {
        return part(pixels, within(viewport, onCanvas));
    }
};

PixelSize nearest(double width, double height) {
    const auto whole = [](double pixels) {
        return static_cast<std::int32_t>(std::clamp(std::round(pixels), 1.0, 1e6));
    };
    return {whole(width), whole(height)};
}

/// 1 of what has no pixels.
double aspect(double width, double height) { return width > 0 && height > 0 ? width / height : 1; }

/// The segments of a canvas in pixels.
class CanvasPixels {
public:
    CanvasPixels(const Configuration& configuration, std::size_t canvas, const ShownCanvas* shown)
        : configuration_(configuration), canvas_(configuration.canvases[canvas]), shown_(shown) {}

    Reference reference(std::size_t segment) const {
        if (shown_ != nullptr && shown_->size)
            return {{0, 0, shown_->size->width, shown_->size->height}, {}};
        const PixelSize size = sizeOf(segment);
        return {{0, 0, size.width, size.height}, canvas_.segments[segment].viewport};
    }

    /// How much wider what is shown is than what is configured, at equal height.
    double widening(std::size_t segment) const {
        const Segment& each = canvas_.segments[segment];
        const fabric::PixelViewport configured = pixelsOf(configuration_, *each.channel);
        const double before = aspect(configured.width / each.viewport.width,
                                     configured.height / each.viewport.height);
        if (shown_ != nullptr && shown_->size)
            return aspect(shown_->size->width, shown_->size->height) / canvasAspect(before);
        const PixelSize size = sizeOf(segment);
        return aspect(size.width / each.viewport.width, size.height / each.viewport.height) /
               before;
    }

private:
    PixelSize sizeOf(std::size_t segment) const {
        if (shown_ != nullptr && segment < shown_->segments.size() && shown_->segments[segment])
            return *shown_->segments[segment];
        const fabric::PixelViewport pixels =
            pixelsOf(configuration_, *canvas_.segments[segment].channel);
        return {pixels.width, pixels.height};
    }

    /// As configured, by its first segment; all segments of one canvas are widened alike.
    double canvasAspect(double otherwise) const {
        const std::optional<PixelSize> size = configuredSize(configuration_, canvas_);
        return size ? aspect(size->width, size->height) : otherwise;
    }

    const Configuration& configuration_;
    const Canvas& canvas_;
    const ShownCanvas* shown_;
};

/// Pictures of renderers have no more pixels a side.
bool isTooLarge(const fabric::PixelViewport& pixels) {
    return pixels.width > fabric::kMaxViewPixels || pixels.height > fabric::kMaxViewPixels;
}

class Finder {
public:
    Finder(const Configuration& configuration, const Display& display, Findings& findings)
        : configuration_(configuration), display_(display), findings_(findings) {}

    std::vector<Destination> find() {
        for (std::size_t canvas = 0; canvas < configuration_.canvases.size(); ++canvas)
            addCanvas(canvas);
        return std::move(found_);
    }

private:
    bool isOn(std::size_t canvas, std::size_t layout) const {
        const ShownCanvas* const shown = display_.find(canvas);
        return shown == nullptr ? layout == 0 : shown->layout == layout;
    }

    void addCanvas(std::size_t index) {
        const Canvas& canvas = configuration_.canvases[index];
        if (canvas.segments.empty() || canvas.layouts.empty())
            findings_.warning(canvas.place,
                              fmt::format("a canvas without {} shows nothing",
                                          canvas.segments.empty() ? "segment" : "layout"));
        std::vector<bool> has(configuration_.layouts.size(), false);
        for (std::size_t i = 0; i < canvas.layouts.size(); ++i) {
            const std::optional<std::size_t>& layout = canvas.layouts[i];
            if (!layout)
                continue;
            if (has[*layout])
                findings_.warning(canvas.place,
                                  fmt::format("layout {} is on the canvas already; the second time "
                                              "has no effect",
                                              *layout));
            else
                addLayout(index, *layout, isOn(index, i));
            has[*layout] = true;
        }
    }

    void addLayout(std::size_t canvas, std::size_t layout, bool isShown) {
        const std::size_t views = configuration_.layouts[layout].views.size();
        const std::size_t segments = configuration_.canvases[canvas].segments.size();
        looked_ += views * segments;
        if (looked_ > kMostPairs)
            return findings_.error(
                configuration_.canvases[canvas].place,
                fmt::format("views and segments would meet in more than {} pairs", kMostPairs));
        if (views == 0)
            findings_.warning(configuration_.layouts[layout].place,
                              "a layout without view shows nothing");
        for (std::size_t view = 0; view < views; ++view) {
            const std::size_t first = found_.size();
            for (std::size_t segment = 0; segment < segments; ++segment)
                add({canvas, segment, layout, view}, isShown);
            warnOfUnseen(configuration_.layouts[layout].views[view],
                         std::span(found_).subspan(first));
        }
    }

    /// Of a view whose eyes none of its segments has.
    void warnOfUnseen(const View& view, std::span<const Destination> destinations) {
        if (destinations.empty() || std::ranges::any_of(destinations, [](const Destination& each) {
                return !each.eyes.isEmpty();
            }))
            return;
        findings_.warning(
            view.place,
            fmt::format("no segment of the canvas shows the view: for its mode {} that has to have "
                        "the eye {}",
                        view.isStereo ? "STEREO" : "MONO",
                        view.isStereo ? "LEFT or RIGHT" : "CYCLOP"));
    }

    void add(const DestinationIndex& index, bool isShown) {
        const Canvas& canvas = configuration_.canvases[index.canvas];
        const Segment& segment = canvas.segments[index.segment];
        const View& view = configuration_.layouts[index.layout].views[index.view];
        if (!overlap(segment.viewport, view.viewport))
            return;
        const Viewport both = intersection(segment.viewport, view.viewport);
        if (!segment.channel)
            return findings_.warning(segment.place, "a segment without channel shows nothing");
        const ChannelIndex& channel = *segment.channel;
        Destination found;
        found.index = index;
        found.channel = channel;
        found.name = configuration_.nodes[channel.node]
                         .pipes[channel.pipe]
                         .windows[channel.window]
                         .channels[channel.channel]
                         .name;
        found.viewport = within(both, segment.viewport);
        found.eyes = shownEyes(view, segment);
        found.isShown = isShown;
        place(shownBy(canvas, segment, view), both, found);
        found_.push_back(std::move(found));
    }

    /// In pixels of the window, the segment, the canvas and the picture that it is part of.
    void place(const Shown& shown, const Viewport& both, Destination& found) const {
        const DestinationIndex& index = found.index;
        const CanvasPixels pixels(configuration_, index.canvas, display_.find(index.canvas));
        const Reference reference = pixels.reference(index.segment);
        const View& view = configuration_.layouts[index.layout].views[index.view];
        found.widening = pixels.widening(index.segment);
        found.segmentOnCanvas = reference.pixelsAt(
            configuration_.canvases[index.canvas].segments[index.segment].viewport);
        const fabric::PixelViewport own = reference.pixelsAt(both);
        found.onSegment = movedBy(own, found.segmentOnCanvas, -1);
        found.pixelViewport = movedBy(found.onSegment, pixelsOf(configuration_, found.channel), 1);
        const fabric::PixelViewport canvas = reference.pixelsAt({});
        found.canvas = {canvas.width, canvas.height};
        found.segmentOnCanvas = movedBy(found.segmentOnCanvas, canvas, -1);

        fabric::PixelViewport whole = reference.pixelsAt(shown.onCanvas);
        if (shown.wall) {
            const Wall wall = widened(*shown.wall, found.widening);
            found.wall = part(wall, within(both, shown.onCanvas));
            found.panorama.wall = wall;
            if (isTooLarge(whole)) {
                whole = own;
                found.panorama.wall = found.wall;
            }
        }
        found.panorama.width = whole.width;
        found.panorama.height = whole.height;
        found.panorama.view = movedBy(reference.pixelsAt(view.viewport), whole, -1);
        found.partOfPanorama = movedBy(own, whole, -1);
    }

    static fabric::PixelViewport movedBy(const fabric::PixelViewport& area,
                                         const fabric::PixelViewport& corner, int sign) {
        return {area.x + sign * corner.x, area.y + sign * corner.y, area.width, area.height};
    }

    const Configuration& configuration_;
    const Display& display_;
    Findings& findings_;
    std::vector<Destination> found_;
    std::size_t looked_ = 0;
};

}  // namespace

fabric::PixelViewport pixelsOf(const Configuration& configuration, const ChannelIndex& index) {
    const Pipe& pipe = configuration.nodes[index.node].pipes[index.pipe];
    const Window& window = pipe.windows[index.window];
    fabric::PixelViewport pixels = placed(kPipePixels, pipe.viewport);
    pixels = placed(pixels, window.viewport);
    pixels.x = pixels.y = 0;
    return placed(pixels, window.channels[index.channel].viewport);
}

std::optional<PixelSize> configuredSize(const Configuration& configuration, const Canvas& canvas) {
    for (const Segment& segment : canvas.segments)
        if (segment.channel) {
            const fabric::PixelViewport pixels = pixelsOf(configuration, *segment.channel);
            return nearest(pixels.width / segment.viewport.width,
                           pixels.height / segment.viewport.height);
        }
    return std::nullopt;
}

std::vector<Destination> destinationsOf(const Configuration& configuration, const Display& display,
                                        Findings& findings) {
    return Finder(configuration, display, findings).find();
}

EyePlaces eyePlaces(const Configuration& configuration, const View& view) {
    double base = kUsualEyeBase;
    for (const Attribute* const setting : {find(configuration.globals, "EQ_CONFIG_FATTR_EYE_BASE"),
                                           find(configuration.attributes, "eye_base")})
        if (setting != nullptr)
            base = std::get<double>(setting->value);
    EyePlaces places;
    const Observer* const observer =
        view.observer ? &configuration.observers[*view.observer] : nullptr;
    if (observer != nullptr && observer->eyeBase)
        base = *observer->eyeBase;
    places.left.x = -base / 2;
    places.right.x = base / 2;
    if (observer == nullptr)
        return places;
    places.cyclop = observer->eyeCyclop.value_or(places.cyclop);
    places.left = observer->eyeLeft.value_or(places.left);
    places.right = observer->eyeRight.value_or(places.right);
    return places;
}

}  // namespace eyrie::config
