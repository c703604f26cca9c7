// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/config/configuration.h"

namespace eyrie::compound {

/// Configurations with random trees of compounds that make their views' pictures: 2D, DB, pixel and
/// eye compounds, direct-send, binary swap and streams within each other, on up to eight channels.
/// The shares of the data that one channel has of one picture are always next to each other.
class RandomCompounds {
public:
    static constexpr std::size_t kChannels = 8;

    explicit RandomCompounds(std::uint32_t seed) : random_(seed) {}

    /// One canvas of one or two segments with channels 0 and 1; a compound tree for each.
    config::Configuration configuration(int depth) {
        config::Configuration made = room();
        for (std::size_t i = 0; i < made.canvases[0].segments.size(); ++i) {
            config::Compound root;
            root.channel = config::DestinationIndex{0, i, 0, 0};
            split(root, allFrom(i), depth, false);
            made.compounds.push_back(std::move(root));
        }
        return made;
    }

    /// The same for one eye, where 2D compounds alone are within each other: nothing is merged.
    config::Configuration sideBySide(int depth) {
        kinds_ = {&RandomCompounds::splitPicture};
        config::Configuration made = configuration(depth);
        made.layouts[0].views[0].isStereo = false;
        return made;
    }

    /// With `period` channels that draw a frame each in turn.
    config::Configuration timeMultiplexed(int period) {
        config::Configuration made = room();
        made.canvases[0].segments.resize(1);
        made.canvases[0].segments[0].viewport = {};
        config::Compound root;
        root.channel = config::DestinationIndex{0, 0, 0, 0};
        for (int phase = 0; phase < period; ++phase) {
            config::Compound child;
            const std::size_t channel = anyChannel();
            child.channel = at(channel);
            child.period = period;
            child.phase = phase;
            child.outputFrames.push_back(frame("turn"));
            split(child, allFrom(channel), 2, false);
            root.children.push_back(std::move(child));
        }
        root.inputFrames.push_back(frame("turn"));
        made.compounds.push_back(std::move(root));
        return made;
    }

    int below(int bound) { return static_cast<int>(random_() % static_cast<unsigned>(bound)); }
    bool maybe() { return below(2) == 1; }

    static config::ChannelIndex at(std::size_t channel) { return {0, channel, 0, 0}; }

    static config::Frame frame(std::string name) {
        config::Frame made;
        made.name = std::move(name);
        return made;
    }

private:
    /// Those that may be used, that of the compound first.
    using Channels = std::vector<std::size_t>;
    using Kind = void (RandomCompounds::*)(config::Compound&, const Channels&, int, bool);

    config::Configuration room() {
        config::Configuration made;
        made.nodes.resize(1);
        for (std::size_t i = 0; i < kChannels; ++i) {
            config::Channel channel;
            channel.name = "channel" + std::to_string(i);
            config::Window window;
            window.viewport = config::Viewport{0, 0, 41, 23};
            window.channels.push_back(channel);
            config::Pipe pipe;
            pipe.windows.push_back(window);
            made.nodes[0].pipes.push_back(pipe);
        }
        config::View view;
        view.isStereo = maybe();
        made.layouts.push_back({"layout", {view}, {}});
        config::Canvas canvas;
        canvas.layouts = {0};
        if (maybe())
            canvas.surface = config::Wall{};
        const double cut = maybe() ? 1 : .2 + .1 * below(7);
        canvas.segments.resize(cut < 1 ? 2 : 1);
        canvas.segments[0].viewport = {0, 0, cut, 1};
        canvas.segments[0].channel = at(0);
        if (cut < 1) {
            canvas.segments[1].viewport = {cut, 0, 1 - cut, 1};
            canvas.segments[1].channel = at(1);
        }
        made.canvases.push_back(canvas);
        return made;
    }

    std::size_t anyChannel() { return static_cast<std::size_t>(below(kChannels)); }

    std::string newName() { return "f" + std::to_string(names_++); }

    /// Makes `self`, which is on `channel`, draw its part in one of the ways there are. `byDepth`:
    /// it is to have depth.
    void split(config::Compound& self, const Channels& channels, int depth, bool byDepth) {
        if (depth == 0 || below(5) == 0)
            return;
        const auto kind = static_cast<std::size_t>(below(static_cast<int>(kinds_.size())));
        (this->*kinds_[kind])(self, channels, depth, byDepth);
        if (below(3) == 0)
            bundle(self);
    }

    /// Puts some of the children into a group that says nothing; their frames go where they went.
    void bundle(config::Compound& self) {
        const int count = static_cast<int>(self.children.size());
        if (count == 0)
            return;
        const int begin = below(count);
        const int end = begin + 1 + below(count - begin);
        config::Compound group;
        const auto first = self.children.begin() + begin;
        const auto last = self.children.begin() + end;
        group.children.assign(std::make_move_iterator(first), std::make_move_iterator(last));
        self.children.insert(self.children.erase(first, last), std::move(group));
    }

    /// On a channel of its own, from which `self` gets a frame, or perhaps on that of `self`, into
    /// which it then draws.
    void addChild(config::Compound& self, const Channels& channels, config::Compound child,
                  int depth, bool byDepth) {
        Channels own = channels;
        std::swap(own.front(), own[static_cast<std::size_t>(below(static_cast<int>(own.size())))]);
        addChildOn(self, channels.front(), std::move(own), std::move(child), depth, byDepth);
    }

    void addChildOn(config::Compound& self, std::size_t channel, const Channels& own,
                    config::Compound child, int depth, bool byDepth) {
        const bool isOther = own.front() != channel;
        if (isOther || maybe())
            child.channel = at(own.front());
        if (isOther || below(3) == 0) {
            const std::string name = newName();
            child.outputFrames.push_back(frame(name));
            self.inputFrames.push_back(frame(name));
        }
        split(child, own, depth - 1, byDepth);
        self.children.push_back(std::move(child));
    }

    /// Places in (0, 1), ascending, between 0 and 1.
    std::vector<double> cuts(int parts) {
        std::vector<double> edges = {0, 1};
        for (int i = 1; i < parts; ++i)
            edges.push_back(maybe() ? .05 * (1 + below(19)) : static_cast<double>(i) / parts);
        std::ranges::sort(edges);
        return edges;
    }

    config::Viewport strip(double begin, double end, bool across) const {
        return across ? config::Viewport{begin, 0, end - begin, 1}
                      : config::Viewport{0, begin, 1, end - begin};
    }

    void splitPicture(config::Compound& self, const Channels& channels, int depth, bool byDepth) {
        const std::vector<double> edges = cuts(2 + below(3));
        const bool across = maybe();
        for (std::size_t i = 0; i + 1 < edges.size(); ++i)
            if (edges[i] < edges[i + 1]) {
                config::Compound child;
                child.viewport = strip(edges[i], edges[i + 1], across);
                addChild(self, channels, std::move(child), depth, byDepth);
            }
    }

    void splitData(config::Compound& self, const Channels& channels, int depth, bool) {
        self.buffers = config::Buffers{true, true};
        const int parts = std::min(2 + below(3), static_cast<int>(channels.size()));
        std::vector<double> edges = cuts(parts);
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        std::vector<std::size_t> order(edges.size() - 1);
        std::iota(order.begin(), order.end(), 0);
        std::ranges::shuffle(order, random_);
        for (const std::size_t i : order) {
            config::Compound child;
            child.range = {edges[i], edges[i + 1]};
            Channels own;  // every so-many-th
            for (std::size_t k = i; k < channels.size(); k += order.size())
                own.push_back(channels[k]);
            addChildOn(self, channels.front(), own, std::move(child), depth, true);
        }
        std::ranges::shuffle(self.inputFrames, random_);
    }

    void splitPixels(config::Compound& self, const Channels& channels, int depth, bool byDepth) {
        const int count = 2 + below(2);
        const bool across = maybe();
        for (int i = 0; i < count; ++i) {
            config::Compound child;
            child.pixel =
                across ? config::PixelShare{i, 0, count, 1} : config::PixelShare{0, i, 1, count};
            addChild(self, channels, std::move(child), depth, byDepth);
        }
    }

    void splitEyes(config::Compound& self, const Channels& channels, int depth, bool byDepth) {
        for (const config::Eyes& eyes :
             {config::Eyes{true, true, false}, config::Eyes{false, false, true}}) {
            config::Compound child;
            child.eyes = eyes;
            addChild(self, channels, std::move(child), depth, byDepth);
        }
    }

    Channels allFrom(std::size_t channel) {
        Channels channels(kChannels);
        std::iota(channels.begin(), channels.end(), 0);
        std::ranges::shuffle(channels, random_);
        std::iter_swap(channels.begin(), std::ranges::find(channels, channel));
        return channels;
    }

    static fabric::Range share(std::size_t index, std::size_t count) {
        return {static_cast<double>(index) / static_cast<double>(count),
                static_cast<double>(index + 1) / static_cast<double>(count)};
    }

    config::Frame finished(const std::string& name, const config::Viewport& part, bool byDepth) {
        config::Frame made = frame(name);
        made.viewport = part;
        if (!byDepth)
            made.buffers = config::Buffers{true, false};
        return made;
    }

    /// Each channel draws a share of the data and puts together a strip of the picture.
    void sendDirectly(config::Compound& self, const Channels& channels, int, bool byDepth) {
        self.buffers = config::Buffers{true, true};
        const std::size_t count = std::min(2 + static_cast<std::size_t>(below(4)), channels.size());
        const std::string name = newName();
        const auto stripOf = [&](std::size_t i) {
            const fabric::Range part = share(i, count);
            return strip(part.begin, part.end, false);
        };
        const auto piece = [&](std::size_t to, std::size_t from) {
            return name + ".t" + std::to_string(to) + "." + std::to_string(from);
        };
        for (std::size_t i = 0; i < count; ++i) {
            config::Compound drawing;
            drawing.range = share(i, count);
            for (std::size_t to = 0; to < count; ++to)
                if (to != i) {
                    drawing.outputFrames.push_back(frame(piece(to, i)));
                    drawing.outputFrames.back().viewport = stripOf(to);
                }
            if (i == 0) {
                self.children.push_back(std::move(drawing));
                continue;
            }
            config::Compound collecting;
            collecting.channel = at(channels[i]);
            collecting.children.push_back(std::move(drawing));
            for (std::size_t from = 0; from < count; ++from)
                if (from != i)
                    collecting.inputFrames.push_back(frame(piece(i, from)));
            collecting.outputFrames.push_back(
                finished(name + ".s" + std::to_string(i), stripOf(i), byDepth));
            self.inputFrames.push_back(frame(name + ".s" + std::to_string(i)));
            self.inputFrames.push_back(frame(piece(0, i)));
            self.children.push_back(std::move(collecting));
        }
    }

    /// In each round two channels swap halves of what both still have.
    void swapBinary(config::Compound& self, const Channels& channels, int, bool byDepth) {
        self.buffers = config::Buffers{true, true};
        int rounds = 1 + below(3);
        while (rounds > 0 && (std::size_t{1} << rounds) > channels.size()) --rounds;
        if (rounds == 0)
            return;
        const std::size_t count = std::size_t{1} << rounds;
        const std::string name = newName();
        const auto swapped = [&](int round, std::size_t from) {
            return name + ".r" + std::to_string(round) + "." + std::to_string(from);
        };
        for (std::size_t i = 0; i < count; ++i) {
            config::Compound chain;
            if (i > 0)
                chain.channel = at(channels[i]);
            fabric::Range kept{0, 1};
            for (int round = 0; round < rounds; ++round) {
                const std::size_t bit = static_cast<std::size_t>(1) << round;
                const double middle = (kept.begin + kept.end) / 2;
                const bool keepsUpper = (i & bit) != 0;
                const fabric::Range given = keepsUpper ? fabric::Range{kept.begin, middle}
                                                       : fabric::Range{middle, kept.end};
                kept = keepsUpper ? fabric::Range{middle, kept.end}
                                  : fabric::Range{kept.begin, middle};
                config::Compound stage;
                if (round == 0) {
                    stage.range = share(i, count);
                } else {
                    stage.tasks = config::Tasks{false, false, true, true};
                    stage.inputFrames.push_back(frame(swapped(round - 1, i ^ (bit / 2))));
                }
                stage.outputFrames.push_back(frame(swapped(round, i)));
                stage.outputFrames.back().viewport = strip(given.begin, given.end, false);
                chain.children.push_back(std::move(stage));
            }
            const std::size_t last = i ^ (count / 2);
            if (i == 0) {
                self.inputFrames.push_back(frame(swapped(rounds - 1, last)));
            } else {
                chain.inputFrames.push_back(frame(swapped(rounds - 1, last)));
                const std::string own = name + ".c" + std::to_string(i);
                chain.outputFrames.push_back(
                    finished(own, strip(kept.begin, kept.end, false), byDepth));
                self.inputFrames.push_back(frame(own));
            }
            self.children.push_back(std::move(chain));
        }
    }

    /// Each channel adds its share to what the one before it hands on.
    void stream(config::Compound& self, const Channels& channels, int, bool) {
        self.buffers = config::Buffers{true, true};
        const std::size_t count = std::min(2 + static_cast<std::size_t>(below(4)), channels.size());
        std::string before;
        for (std::size_t i = 0; i < count; ++i) {
            config::Compound link;
            link.range = share(i, count);
            if (!before.empty())
                link.inputFrames.push_back(frame(before));
            if (i + 1 < count) {
                link.channel = at(channels[i + 1]);
                before = newName();
                link.outputFrames.push_back(frame(before));
            }
            self.children.push_back(std::move(link));
        }
    }

    std::mt19937 random_;
    /// That compounds are split by.
    std::vector<Kind> kinds_ = {&RandomCompounds::splitPicture, &RandomCompounds::splitData,
                                &RandomCompounds::splitPixels,  &RandomCompounds::splitEyes,
                                &RandomCompounds::sendDirectly, &RandomCompounds::swapBinary,
                                &RandomCompounds::stream};
    int names_ = 0;
};

}  // namespace eyrie::compound
