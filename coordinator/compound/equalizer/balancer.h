// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "coordinator/compound/equalizer/frame_facts.h"
#include "coordinator/compound/equalizer/work.h"

namespace eyrie::equalizer {

/// What an equalizer says about itself, for people.
struct Report {
    /// Longest over mean time of the children in the last frame with all times, each by its
    /// resources; 0: none yet.
    double imbalance = 0;
    /// Frames a second that it holds or lets through; 0: it does not say.
    double framesPerSecond = 0;
    double zoom = 1;  ///< pixels of a side for each one that there are without it
};

/// An output frame that comes to a monitor.
struct MonitoredFrame {
    std::size_t source = 0;  ///< the position of the compound that makes it
    std::size_t output = 0;  ///< of its output frames
    std::size_t monitor = 0;
    std::size_t input = 0;  ///< of the monitor's input frames
    fabric::Vec2 zoom;      ///< the monitor's pixels for each of the source's
};

/// The configuration of a frame to come, as equalizers change it in turn, those of parents first.
struct Turn {
    const FrameFacts& facts;
    const Work& work;
    const config::Configuration& configuration;
    std::vector<config::Compound*> live;  ///< by position as in Work
    /// How much of its channel each compound that draws itself may use, 0 to 1.
    std::vector<double> usage;
    std::vector<MonitoredFrame> monitored = {};  ///< by the monitors so far

    /// Null where the configuration was resolved without it.
    const config::ResolvedCompound* resolved(std::size_t position) const {
        return position < facts.resolved.compounds.size() ? &facts.resolved.compounds[position]
                                                          : nullptr;
    }
    /// What the compounds that draw in the tree at `position` may use, each channel once.
    double resources(std::size_t position) const;
    /// Whether what it is drawn for is on a canvas that is asked for, in the layout that that
    /// shows.
    bool isAskedFor(const config::ResolvedCompound& compound) const;
};

/// One equalizer of one compound at work. Settings may differ from frame to frame.
class Balancer {
public:
    virtual ~Balancer() = default;

    /// Changes what lies below its compound for the next frame.
    virtual void apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) = 0;

    /// As if it were not there, for the next frame.
    virtual void switchOff(Turn& turn) = 0;

    /// Learns from a frame. `times` has a time for whatever drew, as far as it is known.
    virtual void record(const PlannedFrame& frame, const FrameTimes& times) = 0;

    virtual Report report() const = 0;

    /// How long after a frame has begun the next is to begin; 0: it does not say.
    virtual double intervalMilliseconds() const { return 0; }

    /// With what it has learned.
    virtual std::unique_ptr<Balancer> clone() const = 0;
};

/// `written` is the compound with the equalizer; `position` its place in `work`, which outlives it.
std::unique_ptr<Balancer> makeBalancer(const config::Equalizer& equalizer,
                                       const config::Compound& written, std::size_t position,
                                       const Work& work);

}  // namespace eyrie::equalizer
