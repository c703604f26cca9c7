// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/default_layouts.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

namespace eyrie::config {
namespace {

constexpr double kUsualAspect = 16.0 / 9.0;
constexpr Buffers kBoth{true, true};
constexpr Buffers kColour{true, false};

double sum(std::span<const double> weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
}

/// Few enough digits that sums of parts are exact.
double rounded(double share) { return std::ldexp(std::round(std::ldexp(share, 20)), -20); }

/// Where the parts of a whole end, the last at 1.
std::vector<double> ends(std::span<const double> weights) {
    std::vector<double> ends;
    for (std::size_t i = 1; i <= weights.size(); ++i)
        ends.push_back(rounded(sum(weights.first(i)) / sum(weights)));
    return ends;
}

/// A rectangle for each, by halves of the longer side.
void split(const Viewport& whole, std::span<const double> weights, std::vector<Viewport>& found) {
    if (weights.size() == 1)
        return found.push_back(whole);
    const std::size_t half = weights.size() / 2;
    const double share = sum(weights.first(half)) / sum(weights);
    Viewport low = whole;
    Viewport high = whole;
    if (whole.width * kUsualAspect >= whole.height) {
        low.width = rounded(whole.width * share);
        high.x = whole.x + low.width;
        high.width = whole.width - low.width;
    } else {
        low.height = rounded(whole.height * share);
        high.y = whole.y + low.height;
        high.height = whole.height - low.height;
    }
    split(low, weights.first(half), found);
    split(high, weights.subspan(half), found);
}

Frame named(std::string name) {
    Frame frame;
    frame.name = std::move(name);
    return frame;
}

std::string resultOf(std::size_t channel) { return "frame." + channelName(channel); }

/// Gives what `child`, done by the channel, draws to `parent`; the destination's own is there.
void addChild(Compound& parent, Compound child, std::size_t channel, bool isOwn) {
    if (!isOwn) {
        child.channel = ChannelIndex{channel, 0, 0, 0};
        child.outputFrames.push_back(named(resultOf(channel)));
        parent.inputFrames.push_back(named(resultOf(channel)));
    }
    parent.children.push_back(std::move(child));
}

void addParts(std::span<const double> weights, std::size_t firstChannel, Compound& parent) {
    std::vector<Viewport> viewports;
    split({}, weights, viewports);
    for (std::size_t i = 0; i < viewports.size(); ++i) {
        Compound child;
        child.viewport = viewports[i];
        addChild(parent, child, firstChannel + i, i == 0);
    }
}

std::string stripOf(std::size_t merging, std::size_t drawing) {
    return fmt::format("strip{}.{}", merging + 1, channelName(drawing));
}

/// The compound of one channel: it draws its range, hands out the strips that others merge, and
/// merges its own.
Compound exchanging(std::size_t own, const fabric::Range& range, std::span<const Viewport> strips,
                    Compound& root) {
    Compound drawing;
    drawing.range = range;
    for (std::size_t other = 0; other < strips.size(); ++other)
        if (other != own) {
            drawing.outputFrames.push_back(named(stripOf(other, own)));
            drawing.outputFrames.back().viewport = strips[other];
        }
    Compound merging;
    Compound& merger = own == 0 ? root : merging;
    for (std::size_t other = 0; other < strips.size(); ++other)
        if (other != own)
            merger.inputFrames.push_back(named(stripOf(own, other)));
    if (own == 0)
        return drawing;
    merging.channel = ChannelIndex{own, 0, 0, 0};
    merging.children.push_back(std::move(drawing));
    merging.outputFrames.push_back(named(resultOf(own)));
    merging.outputFrames.back().buffers = kColour;
    merging.outputFrames.back().viewport = strips[own];
    return merging;
}

}  // namespace

std::string channelName(std::size_t index) { return fmt::format("channel{}", index + 1); }

Compound parts(std::span<const double> weights) {
    Compound root;
    addParts(weights, 0, root);
    return root;
}

Compound ranges(std::span<const double> weights) {
    Compound root;
    root.buffers = kBoth;
    const std::vector<double> cuts = ends(weights);
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        Compound child;
        child.range = {i == 0 ? 0 : cuts[i - 1], cuts[i]};
        addChild(root, child, i, i == 0);
    }
    return root;
}

Compound directSend(std::span<const double> weights) {
    const std::vector<double> cuts = ends(weights);
    std::vector<Viewport> strips;
    for (double y = 0; const double end : ends(std::vector<double>(weights.size(), 1))) {
        strips.push_back({0, y, 1, end - y});
        y = end;
    }
    Compound root;
    root.buffers = kBoth;
    for (std::size_t i = 0; i < weights.size(); ++i)
        root.children.push_back(exchanging(i, {i == 0 ? 0 : cuts[i - 1], cuts[i]}, strips, root));
    for (std::size_t i = 1; i < weights.size(); ++i) root.inputFrames.push_back(named(resultOf(i)));
    return root;
}

Compound rangesOfParts(std::span<const double> weights) {
    Compound root;
    root.buffers = kBoth;
    const auto groups =
        static_cast<std::size_t>(std::round(std::sqrt(static_cast<double>(weights.size()))));
    double begin = 0;
    for (std::size_t group = 0; group < groups; ++group) {
        const std::size_t first = group * weights.size() / groups;
        const std::size_t last = (group + 1) * weights.size() / groups;
        Compound child;
        child.range = {begin, rounded(sum(weights.first(last)) / sum(weights))};
        begin = child.range.end;
        addParts(weights.subspan(first, last - first), first, child);
        addChild(root, std::move(child), first, first == 0);
    }
    return root;
}

Compound balanced(Compound root, SplitMode mode) {
    Equalizer equalizer;
    equalizer.mode = mode;
    root.equalizers.push_back(equalizer);
    return root;
}

}  // namespace eyrie::config
