// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "coordinator/compound/equalizer/frame_facts.h"
#include "coordinator/config/configuration.h"

namespace eyrie::equalizer {

/// What part of its parent's work a compound had in a frame.
struct Part {
    config::Viewport viewport;
    fabric::Range range;
    bool isEmpty = false;  ///< it drew nothing, or nothing of its parent's was drawn
    fabric::Vec2 zoom{1, 1};
    std::optional<config::ChannelIndex> channel = {};
};

/// A frame that was planned: its parts, by position as in Work.
struct PlannedFrame {
    std::uint64_t number = 0;
    std::vector<Part> parts;
    bool isComplete = false;  ///< FrameFacts
};

/// The compounds of a configuration by their position in preorder, which is that in
/// config::ResolvedConfiguration::compounds.
class Work {
public:
    explicit Work(const config::Configuration& written);

    struct Compound {
        std::size_t end = 0;                ///< past the last compound of its tree
        std::vector<std::size_t> children;  ///< positions
        bool draws = false;                 ///< itself, or one below it
        bool drawsItself = false;           ///< without children
        /// Of its frames, as they are written.
        std::vector<std::optional<fabric::Vec2>> outputZooms = {};
        std::vector<std::optional<fabric::Vec2>> inputZooms = {};
    };
    const Compound& at(std::size_t position) const { return compounds_[position]; }
    std::size_t size() const { return compounds_.size(); }
    std::vector<std::size_t> drawingChildren(std::size_t position) const;

    /// What drawing the tree at `position` took, with reading back, encoding and transmission,
    /// added up. Nothing when a compound that drew there has no time.
    std::optional<double> cost(std::size_t position, const PlannedFrame& frame,
                               const FrameTimes& times) const;

    /// What the pipe that took longest took for the tree: what compounds have on one goes on one
    /// after the other. 0 where nothing has a time.
    double longest(std::size_t position, const PlannedFrame& frame, const FrameTimes& times) const;

    /// What of the tree's own picture was covered; of no size when nothing.
    config::Viewport covered(std::size_t position, const PlannedFrame& frame,
                             const FrameTimes& times) const;

private:
    void add(const config::Compound& compound);

    std::vector<Compound> compounds_;
};

/// By position as in Work.
std::vector<config::Compound*> inPreorder(config::Configuration& configuration);

/// A known and sane number of milliseconds, or nothing.
std::optional<double> known(double milliseconds);

/// The compound's tasks as one: what a frame waits for where they go on in turn.
std::optional<double> costOf(const CompoundTime& time);

}  // namespace eyrie::equalizer
