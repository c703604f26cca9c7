// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/work.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "coordinator/config/pixels.h"

namespace eyrie::equalizer {
namespace {

constexpr double kMostMilliseconds = 1e9;  ///< longer than any frame waits

void addInPreorder(config::Compound& compound, std::vector<config::Compound*>& compounds) {
    compounds.push_back(&compound);
    for (config::Compound& child : compound.children) addInPreorder(child, compounds);
}

std::vector<std::optional<fabric::Vec2>> zoomsOf(const std::vector<config::Frame>& frames) {
    std::vector<std::optional<fabric::Vec2>> zooms;
    for (const config::Frame& frame : frames) zooms.push_back(frame.zoom);
    return zooms;
}

config::Viewport enclosing(const config::Viewport& a, const config::Viewport& b) {
    const double x = std::min(a.x, b.x);
    const double y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x,
            std::max(a.y + a.height, b.y + b.height) - y};
}

}  // namespace

std::vector<config::Compound*> inPreorder(config::Configuration& configuration) {
    std::vector<config::Compound*> compounds;
    for (config::Compound& root : configuration.compounds) addInPreorder(root, compounds);
    return compounds;
}

std::optional<double> known(double milliseconds) {
    if (!std::isfinite(milliseconds) || milliseconds < 0)
        return std::nullopt;
    return std::min(milliseconds, kMostMilliseconds);
}

std::optional<double> costOf(const CompoundTime& time) {
    const auto draw = known(time.draw);
    const auto readback = known(time.readback);
    const auto transmit = known(time.transmit);
    if (!draw || !readback || !transmit)
        return std::nullopt;
    return *draw + *readback + *transmit;
}

Work::Work(const config::Configuration& written) {
    for (const config::Compound& root : written.compounds) add(root);
}

void Work::add(const config::Compound& compound) {
    const std::size_t position = compounds_.size();
    compounds_.emplace_back();
    const bool drawsItself = compound.children.empty() && (!compound.tasks || compound.tasks->draw);
    bool draws = drawsItself;
    std::vector<std::size_t> children;
    for (const config::Compound& child : compound.children) {
        children.push_back(compounds_.size());
        add(child);
        draws = draws || compounds_[children.back()].draws;
    }
    compounds_[position] = {compounds_.size(),
                            std::move(children),
                            draws,
                            drawsItself,
                            zoomsOf(compound.outputFrames),
                            zoomsOf(compound.inputFrames)};
}

std::vector<std::size_t> Work::drawingChildren(std::size_t position) const {
    std::vector<std::size_t> drawing;
    for (const std::size_t child : compounds_[position].children)
        if (compounds_[child].draws)
            drawing.push_back(child);
    return drawing;
}

std::optional<double> Work::cost(std::size_t position, const PlannedFrame& frame,
                                 const FrameTimes& times) const {
    double sum = 0;
    for (std::size_t i = position; i < compounds_[position].end; ++i) {
        if (!compounds_[i].drawsItself || frame.parts[i].isEmpty)
            continue;
        const auto cost = i < times.compounds.size() ? costOf(times.compounds[i]) : std::nullopt;
        if (!cost)
            return std::nullopt;
        sum += *cost;
    }
    return sum;
}

double Work::longest(std::size_t position, const PlannedFrame& frame,
                     const FrameTimes& times) const {
    std::map<std::pair<std::size_t, std::size_t>, double> sums;  // by node and pipe
    double longest = 0;
    for (std::size_t i = position; i < compounds_[position].end && i < times.compounds.size();
         ++i) {
        const Part& part = frame.parts[i];
        if (!compounds_[i].drawsItself || part.isEmpty || !part.channel)
            continue;
        double& sum = sums[{part.channel->node, part.channel->pipe}];
        sum += costOf(times.compounds[i]).value_or(0);
        longest = std::max(longest, sum);
    }
    return longest;
}

config::Viewport Work::covered(std::size_t position, const PlannedFrame& frame,
                               const FrameTimes& times) const {
    std::optional<config::Viewport> all;
    const auto add = [&](const config::Viewport& part) {
        if (part.width > 0 && part.height > 0)
            all = all ? enclosing(*all, part) : part;
    };
    if (frame.parts[position].isEmpty)
        return {0, 0, 0, 0};
    if (compounds_[position].drawsItself && position < times.compounds.size())
        add(times.compounds[position].covered);
    for (const std::size_t child : drawingChildren(position))
        add(config::part(frame.parts[child].viewport, covered(child, frame, times)));
    return all.value_or(config::Viewport{0, 0, 0, 0});
}

}  // namespace eyrie::equalizer
