// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "coordinator/config/configuration.h"

namespace eyrie::config {

/// Configurations such as can be read, each field now and then other than usual.
class RandomConfiguration {
public:
    explicit RandomConfiguration(std::uint32_t seed) : random_(seed) {}

    Configuration make() {
        all_.version = any({"", "1.0", "1.1", "1.2"});
        if (often())
            all_.globals.push_back({"EQ_WINDOW_IATTR_HINT_STEREO", Attribute::Words{{"OFF"}}});
        if (often())
            all_.globals.push_back({"EQ_CONFIG_FATTR_EYE_BASE", number()});
        if (often())
            all_.globals.push_back({"EQ_COMPOUND_IATTR_STEREO_ANAGLYPH_LEFT_MASK", mask()});
        all_.name = text();
        all_.latency = whole(0, 3);
        if (often())
            all_.attributes.push_back({"robustness", Attribute::Words{{"ON"}}});
        repeat([&] { all_.connections.push_back(connection()); });
        repeat([&] { all_.nodes.push_back(node()); });
        repeat([&] { all_.observers.push_back(observer()); });
        repeat([&] { all_.layouts.push_back(layout()); });
        repeat([&] { all_.canvases.push_back(canvas()); });
        repeat([&] { all_.compounds.push_back(compound(0)); });
        return all_;
    }

private:
    bool often() { return random_() % 3 != 0; }
    std::int64_t whole(std::int64_t low, std::int64_t high) {
        return low +
               static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(high - low + 1));
    }
    /// Of any size, with all digits of a double.
    double number() {
        return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random_),
                          static_cast<int>(whole(-60, 60)));
    }
    double share() { return std::uniform_real_distribution<double>(.001, 1)(random_); }
    std::string text() { return any({"", "a", "a", "b", "two words", "{ } [ 1 ] # // \\ ü 語 '"}); }
    template <typename T>
    T any(std::initializer_list<T> values) {
        return values.begin()[random_() % values.size()];
    }
    std::string any(std::initializer_list<const char*> values) {
        return values.begin()[random_() % values.size()];
    }
    template <typename Make>
    void repeat(const Make& make) {
        for (std::int64_t i = whole(0, 2); i > 0; --i) make();
    }
    template <typename Make>
    auto maybe(const Make& make) -> std::optional<decltype(make())> {
        if (often())
            return std::nullopt;
        return make();
    }

    Attribute::Words mask() {
        return any(
            {Attribute::Words{}, Attribute::Words{{"RED"}}, Attribute::Words{{"GREEN", "BLUE"}}});
    }
    Viewport fraction() {
        if (often())
            return {};
        const double x = share() / 2;
        const double y = share() / 2;
        return {x, y, share() / 2, share() / 2};
    }
    Viewport pixels() { return {std::fmod(number(), 1e6), -share(), 1 + share(), 1e3 * share()}; }
    fabric::Vec3 vector() { return {number(), number(), number()}; }

    Surface surface() {
        const double half = share();
        switch (whole(0, 3)) {
            case 0:
                return Wall{};
            case 1:
                return Wall{{-half, 0, -1}, {half, 0, -1}, {-half, 2, -1}, often()};
            case 2:
                return Projection{vector(), share(), {10 + share(), 100}, vector()};
            default:
                return {};
        }
    }
    SwapBarrier barrier() {
        SwapBarrier made{text(), {}};
        if (often())
            made.attributes.push_back({"NV_barrier", whole(0, 9)});
        if (often())
            made.attributes.push_back({"NV_group", Attribute::Words{{"OFF"}}});
        return made;
    }
    Connection connection() {
        return {any({"", "TCPIP", "RSP", "SDP"}),
                text(),
                text(),
                whole(0, 65535),
                whole(0, 1000000),
                text()};
    }
    Channel channel() {
        Channel made{text(), maybe([&] { return pixels(); }), {}, {}, {}};
        if (often())
            made.drawables = {"FBO_COLOR", "FBO_STENCIL"};
        if (often())
            made.attributes.push_back({"dump_image", text()});
        return made;
    }
    Window window() {
        Window made{text(), maybe([&] { return fraction(); }), {}, {}, {}};
        if (often())
            made.attributes.push_back({"planes_depth", whole(-5, 32)});
        if (often())
            made.attributes.push_back({"hint_drawable", Attribute::Words{{"FBO"}}});
        repeat([&] { made.channels.push_back(channel()); });
        return made;
    }
    Node node() {
        const bool isApplication = often() && all_.nodes.empty();  // there is one
        Node made{text(), isApplication, text(), {}, {}, {}, {}};
        repeat([&] { made.connections.push_back(connection()); });
        if (often())
            made.attributes.push_back({"launch_command_quote", std::string("'")});
        if (often())
            made.attributes.push_back({"hint_affinity", Attribute::Words{{"CORE", "-1"}}});
        repeat([&] {
            made.pipes.push_back({text(),
                                  maybe([&] { return whole(0, 9); }),
                                  maybe([&] { return whole(0, 9); }),
                                  maybe([&] { return pixels(); }),
                                  {},
                                  {},
                                  {}});
            repeat([&] { made.pipes.back().windows.push_back(window()); });
        });
        return made;
    }
    Observer observer() {
        Observer made;
        made.name = text();
        made.eyeBase = maybe([&] { return number(); });
        made.eyeLeft = maybe([&] { return vector(); });
        made.eyeCyclop = maybe([&] { return vector(); });
        made.eyeRight = maybe([&] { return vector(); });
        made.focusDistance = any({1.0, std::min(std::abs(number()), 1e6)});
        made.focusMode =
            any({FocusMode::Fixed, FocusMode::RelativeToOrigin, FocusMode::RelativeToObserver});
        made.openCvCamera = any({"", "ON", "007"});
        made.vrpnTracker = text();
        return made;
    }
    Layout layout() {
        Layout made{text(), {}, {}};
        repeat([&] {
            View view;
            view.name = text();
            view.isStereo = often();
            view.viewport = fraction();
            view.surface = surface();
            if (!all_.observers.empty() && often())
                view.observer = random_() % all_.observers.size();
            if (often())
                view.attributes.push_back({"deflect_host", text()});
            made.views.push_back(view);
        });
        return made;
    }
    std::optional<ChannelIndex> channelIndex() {
        const auto at = [this](const auto& list) { return random_() % (list.size() + 1); };
        ChannelIndex index{at(all_.nodes), 0, 0, 0};
        if (index.node == all_.nodes.size())
            return std::nullopt;
        const Node& found = all_.nodes[index.node];
        index.pipe = at(found.pipes);
        if (index.pipe == found.pipes.size())
            return std::nullopt;
        index.window = at(found.pipes[index.pipe].windows);
        if (index.window == found.pipes[index.pipe].windows.size())
            return std::nullopt;
        const Window& windowOf = found.pipes[index.pipe].windows[index.window];
        index.channel = at(windowOf.channels);
        if (index.channel == windowOf.channels.size())
            return std::nullopt;
        return index;
    }
    Canvas canvas() {
        Canvas made;
        made.name = text();
        repeat([&] {
            if (all_.layouts.empty() || !often())
                made.layouts.push_back(std::nullopt);
            else
                made.layouts.push_back(random_() % all_.layouts.size());
        });
        made.surface = surface();
        made.swapBarrier = maybe([&] { return barrier(); });
        repeat([&] {
            made.segments.push_back({text(),
                                     channelIndex(),
                                     fraction(),
                                     eyes(),
                                     surface(),
                                     maybe([&] { return barrier(); }),
                                     {}});
        });
        return made;
    }
    Eyes eyes() { return {often(), often(), often()}; }
    Buffers buffers() { return {often(), often()}; }
    ColourMask colours() { return {often(), often(), often()}; }
    ChannelReference reference(int depth) {
        if (all_.canvases.empty() || all_.layouts.empty())
            return {};
        DestinationIndex index{random_() % all_.canvases.size(), 0, random_() % all_.layouts.size(),
                               0};
        const std::size_t segments = all_.canvases[index.canvas].segments.size();
        const std::size_t views = all_.layouts[index.layout].views.size();
        const auto source = channelIndex();
        if (depth > 0 && source && often())
            return *source;
        if (segments == 0 || views == 0)
            return {};
        index.segment = random_() % segments;
        index.view = random_() % views;
        return index;
    }
    Frame frame() {
        return {text(),
                often(),
                fraction(),
                maybe([&] { return buffers(); }),
                maybe([&] {
                    return any({fabric::Vec2(1, 1), fabric::Vec2(share(), 2)});
                }),
                {}};
    }
    fabric::Vec2 size() { return fabric::Vec2(whole(1, 99), whole(1, 99)); }
    Tiles tiles() {
        return {text(), maybe([&] { return size(); }), maybe([&] { return share(); }), {}};
    }
    Equalizer equalizer() {
        Equalizer made;
        made.kind = static_cast<EqualizerKind>(whole(0, 6));
        if (made.kind <= EqualizerKind::Dfr)
            made.damping = any({.5, share()});
        if (made.kind <= EqualizerKind::Tree) {
            made.mode = static_cast<SplitMode>(whole(0, 3));
            made.boundaryPixels = maybe([&] { return size(); });
            made.boundaryRange = maybe([&] { return share(); });
            made.resistancePixels = maybe([&] { return size(); });
            made.resistanceRange = maybe([&] { return share(); });
        }
        if (made.kind == EqualizerKind::Load)
            made.assembleOnlyLimit = maybe([&] { return 3 * share(); });
        if (made.kind == EqualizerKind::Dfr)
            made.framerate = any({10.0, 60 * share()});
        if (made.kind == EqualizerKind::Tile) {
            made.name = text();
            made.tileSize = size();
            made.tileChunk = maybe([&] { return share(); });
        }
        return made;
    }
    Compound compound(int depth) {
        Compound made;
        made.name = text();
        made.channel = reference(depth);
        made.tasks = maybe([&] { return Tasks{often(), often(), often(), often()}; });
        made.buffers = maybe([&] { return buffers(); });
        made.eyes = maybe([&] { return eyes(); });
        made.viewport = fraction();
        if (!often())
            made.range = {share() / 2, .5 + share() / 2};
        made.period = maybe([&] { return whole(1, 9); });
        made.phase = maybe([&] { return whole(0, 9); });
        if (!often())
            made.pixel = {whole(0, 2), whole(0, 2), whole(3, 4), whole(3, 4)};
        if (!often())
            made.subpixel = {whole(0, 2), whole(3, 4)};
        made.zoom = any({fabric::Vec2(1, 1), fabric::Vec2(share(), 2)});
        made.surface = surface();
        made.swapBarrier = maybe([&] { return barrier(); });
        made.stereoMode = maybe([&] { return static_cast<StereoMode>(whole(0, 3)); });
        made.anaglyphLeft = maybe([&] { return colours(); });
        made.anaglyphRight = maybe([&] { return colours(); });
        repeat([&] { made.outputFrames.push_back(frame()); });
        repeat([&] { made.inputFrames.push_back(frame()); });
        repeat([&] { made.outputTiles.push_back(tiles()); });
        repeat([&] { made.inputTiles.push_back(tiles()); });
        repeat([&] { made.equalizers.push_back(equalizer()); });
        if (depth < 3 && often())
            repeat([&] { made.children.push_back(compound(depth + 1)); });
        return made;
    }

    std::mt19937 random_;
    Configuration all_;
};

}  // namespace eyrie::config
