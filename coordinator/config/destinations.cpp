// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/destinations.h"

#include <fmt/format.h>

#include "coordinator/config/pixels.h"

namespace eyrie::config {
namespace {

constexpr double kUsualEyeBase = .05;  // metres

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

/// The view's own, as much of it as falls on the segment; else the segment's; else the canvas's
/// where the segment is.
std::optional<Wall> wallOf(const Canvas& canvas, const Segment& segment, const View& view,
                           const Viewport& shown) {
    if (const auto wall = wallOf(view.surface))
        return part(*wall, within(shown, view.viewport));
    const Viewport ofSegment = within(shown, segment.viewport);
    if (const auto wall = wallOf(segment.surface))
        return part(*wall, ofSegment);
    if (const auto wall = wallOf(canvas.surface))
        return part(part(*wall, segment.viewport), ofSegment);
    return std::nullopt;
}

Eyes shownEyes(const View& view, const Segment& segment) {
    if (!view.isStereo)
        return {segment.eyes.cyclop, false, false};
    return {false, segment.eyes.left, segment.eyes.right};
}

class Finder {
public:
    Finder(const Configuration& configuration, Findings& findings)
        : configuration_(configuration), findings_(findings) {}

    std::vector<Destination> find() {
        for (std::size_t canvas = 0; canvas < configuration_.canvases.size(); ++canvas)
            for (const std::optional<std::size_t>& layout : configuration_.canvases[canvas].layouts)
                if (layout)
                    addLayout(canvas, *layout);
        return std::move(found_);
    }

private:
    void addLayout(std::size_t canvas, std::size_t layout) {
        const std::size_t views = configuration_.layouts[layout].views.size();
        const std::size_t segments = configuration_.canvases[canvas].segments.size();
        for (std::size_t view = 0; view < views; ++view)
            for (std::size_t segment = 0; segment < segments; ++segment)
                add({canvas, segment, layout, view});
    }

    void add(const DestinationIndex& index) {
        const Canvas& canvas = configuration_.canvases[index.canvas];
        const Segment& segment = canvas.segments[index.segment];
        const View& view = configuration_.layouts[index.layout].views[index.view];
        const Viewport shown = intersection(segment.viewport, view.viewport);
        if (shown.width <= 0 || shown.height <= 0)
            return;
        if (!segment.channel)
            return findings_.warning(segment.place, "a segment without channel shows nothing");
        const ChannelIndex& channel = *segment.channel;
        const Viewport viewport = within(shown, segment.viewport);
        found_.push_back({index, channel,
                          configuration_.nodes[channel.node]
                              .pipes[channel.pipe]
                              .windows[channel.window]
                              .channels[channel.channel]
                              .name,
                          viewport, part(pixelsOf(configuration_, channel), viewport),
                          shownEyes(view, segment), wallOf(canvas, segment, view, shown)});
    }

    const Configuration& configuration_;
    Findings& findings_;
    std::vector<Destination> found_;
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

std::vector<Destination> destinationsOf(const Configuration& configuration, Findings& findings) {
    return Finder(configuration, findings).find();
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
