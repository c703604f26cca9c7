// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coordinator/compound/equalizer/area.h"
#include "coordinator/compound/equalizer/equalizers.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/resolved.h"

namespace eyrie::equalizer {

/// A channel "dst" of 1280x720 and others, "s1" to "s<others>", as large, each on a pipe of its
/// own, and `compounds`, which may show (segment 0 view 0).
inline config::Configuration configurationOf(int others, const std::string& compounds) {
    const auto pipe = [](const std::string& channel) {
        return fmt::format(
            "pipe {{ window {{ viewport [ 0 0 1280 720 ] channel {{ name \"{}\" }} }} }}\n",
            channel);
    };
    std::string pipes = pipe("dst");
    for (int i = 1; i <= others; ++i) pipes += pipe(fmt::format("s{}", i));
    config::Findings findings;
    config::Configuration configuration =
        config::readEqc(fmt::format("server {{ config {{ appNode {{ {} }} layout {{ view {{ }} }}\n"
                                    "canvas {{ layout 0 segment {{ channel \"dst\" }} }}\n{} }} }}",
                                    pipes, compounds),
                        findings);
    EXPECT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    return configuration;
}

/// What shows (segment 0 view 0) by `children` children of one compound with `equalizers`; the
/// first draws on the destination's channel. `each` stands in every child.
inline std::string sharedBetween(int children, const std::string& equalizers,
                                 const std::string& each = {}) {
    std::string text = "compound { channel ( segment 0 view 0 ) buffer [ COLOR DEPTH ] " +
                       equalizers + " compound { " + each + " }\n";
    for (int i = 1; i < children; ++i)
        text += fmt::format(
            "compound {{ channel \"s{0}\" {1} outputframe {{ name \"f{0}\" }} }} "
            "inputframe {{ name \"f{0}\" }}\n",
            i, each);
    return text + "}";
}

/// A configuration and its equalizers, drawing frame after frame of a load that is known.
class Balanced {
public:
    /// Milliseconds of what a compound draws.
    using Load = std::function<double(const config::ResolvedCompound&)>;

    explicit Balanced(config::Configuration configuration)
        : written(std::move(configuration)), live(written), equalizers(written) {
        resolve();
        asWritten = resolved;
    }

    /// The milliseconds of each compound that draws, by position; 0 of the others.
    std::vector<double> draw(const Load& load) {
        apply();
        FrameTimes frame{number, std::vector<CompoundTime>(resolved.compounds.size())};
        std::vector<double> milliseconds(resolved.compounds.size(), 0.0);
        for (std::size_t i = 0; i < milliseconds.size(); ++i) {
            if (!resolved.compounds[i].tasks.draw)
                continue;
            milliseconds[i] = load(resolved.compounds[i]);
            frame.compounds[i].draw = milliseconds[i];
        }
        underWay_.push_back(std::move(frame));
        if (underWay_.size() > late) {
            equalizers.record(underWay_.front());
            underWay_.pop_front();
        }
        return milliseconds;
    }

    void apply() {
        equalizers.apply(live, {++number, asWritten, gone, isComplete, canvases});
        resolve();
    }

    const config::ResolvedCompound& at(std::size_t position) const {
        return resolved.compounds[position];
    }

    config::Configuration written;
    config::Configuration live;
    config::ResolvedConfiguration resolved;  ///< of live
    config::ResolvedConfiguration asWritten;
    std::vector<config::ChannelIndex> gone;
    bool isComplete = false;
    std::vector<std::size_t> canvases;  ///< asked for; none: all
    std::size_t late = 0;               ///< frames that are planned before one's times are known
    Equalizers equalizers;
    std::uint64_t number = 0;

private:
    std::deque<FrameTimes> underWay_;

    void resolve() {
        config::Findings findings;
        resolved = config::resolve(live, findings);
    }
};

/// Load over [0, 1] x [0, 1]: even in all of it, and in a rectangle.
struct Spot {
    Area area;
    double load = 90;
    double elsewhere = 10;

    double in(const Area& part) const {
        const Area hot = intersection(part, area);
        return elsewhere * part.size() + (hot.isEmpty() ? 0 : load * hot.size() / area.size());
    }
    double total() const { return load + elsewhere; }

    /// Of a compound's part of the picture, or, where it has one, of the range.
    double operator()(const config::ResolvedCompound& compound) const {
        const config::Viewport& v = compound.viewport;
        if (compound.range != fabric::Range{})
            return in({compound.range.begin, 0, compound.range.end, 1});
        return in({v.x, v.y, v.x + v.width, v.y + v.height});
    }
};

}  // namespace eyrie::equalizer
