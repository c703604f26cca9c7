// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/equalizers.h"

#include <algorithm>

#include <fmt/format.h>

#include "coordinator/compound/equalizer/monitored_frames.h"
#include "coordinator/config/named.h"
#include "fabric/status.h"

namespace eyrie::equalizer {
namespace {

constexpr std::size_t kFramesRemembered = 32;  ///< that may be on their way

std::string_view kindName(config::EqualizerKind kind) {
    using Kind = config::EqualizerKind;
    switch (kind) {
        case Kind::Load:
            break;
        case Kind::Tree:
            return "tree";
        case Kind::Dfr:
            return "DFR";
        case Kind::Tile:
            return "tile";
        case Kind::View:
            return "view";
        case Kind::Monitor:
            return "monitor";
        case Kind::Framerate:
            return "framerate";
    }
    return "load";
}

std::string nameOf(const config::Equalizer& equalizer, const config::Compound& compound,
                   std::size_t position) {
    if (!equalizer.name.empty())
        return equalizer.name;
    return fmt::format("{}.{}", kindName(equalizer.kind),
                       compound.name.empty() ? fmt::format("{}", position) : compound.name);
}

bool isEmpty(const config::Compound& compound) {
    return !(compound.viewport.width > 0 && compound.viewport.height > 0) ||
           compound.range.isEmpty();
}

void addParts(const config::Compound& compound, bool isParentEmpty, std::vector<Part>& parts) {
    const bool nothing = isParentEmpty || isEmpty(compound);
    parts.push_back({compound.viewport, compound.range, nothing, compound.zoom});
    for (const config::Compound& child : compound.children) addParts(child, nothing, parts);
}

std::vector<double> usageOf(const Work& work, const FrameFacts& facts) {
    std::vector<double> usage(work.size(), 0.0);
    const std::size_t count = std::min(work.size(), facts.resolved.compounds.size());
    for (std::size_t p = 0; p < count; ++p) {
        const auto& channel = facts.resolved.compounds[p].channel;
        if (work.at(p).drawsItself && channel &&
            std::ranges::find(facts.gone, *channel) == facts.gone.end())
            usage[p] = 1;
    }
    return usage;
}

}  // namespace

Equalizers::Equalizers(const config::Configuration& written)
    : work_(std::make_shared<const Work>(written)) {
    std::size_t position = 0;
    for (const config::Compound& root : written.compounds) add(root, position);
}

Equalizers::Equalizers(const Equalizers& other)
    : work_(other.work_), planned_(other.planned_), recorded_(other.recorded_) {
    for (const Entry& entry : other.entries_)
        entries_.push_back({entry.name, entry.position, entry.settings, entry.isOn, entry.isFrozen,
                            entry.balancer->clone()});
}

void Equalizers::add(const config::Compound& written, std::size_t& position) {
    for (const config::Equalizer& equalizer : written.equalizers)
        entries_.push_back({nameOf(equalizer, written, position), position, equalizer, true, false,
                            makeBalancer(equalizer, written, position, *work_)});
    ++position;
    for (const config::Compound& child : written.children) add(child, position);
}

void Equalizers::apply(config::Configuration& live, const FrameFacts& facts) {
    Turn turn{facts, *work_, live, inPreorder(live), usageOf(*work_, facts)};
    if (turn.live.size() != work_->size())
        return;
    // What is off goes first: of a load and a tile equalizer of one compound, one is on.
    for (Entry& entry : entries_)
        if (!entry.isOn)
            entry.balancer->switchOff(turn);
    for (Entry& entry : entries_)
        if (entry.isOn)
            entry.balancer->apply(turn, entry.settings, entry.isFrozen);
    zoomMonitoredFrames(turn);
    PlannedFrame frame{facts.frameNumber, {}, facts.isComplete};
    for (const config::Compound& root : live.compounds) addParts(root, false, frame.parts);
    for (std::size_t p = 0; p < frame.parts.size(); ++p)
        if (const config::ResolvedCompound* const compound = turn.resolved(p))
            frame.parts[p].channel = compound->channel;
    if (!planned_.empty() && planned_.back().number >= frame.number) {
        planned_.clear();
        recorded_.reset();
    }
    planned_.push_back(std::move(frame));
    if (planned_.size() > kFramesRemembered)
        planned_.pop_front();
}

void Equalizers::record(const FrameTimes& times) {
    if (recorded_ && times.frameNumber <= *recorded_)
        return;
    const auto frame = std::ranges::find(planned_, times.frameNumber, &PlannedFrame::number);
    if (frame == planned_.end())
        return;
    recorded_ = times.frameNumber;
    for (Entry& entry : entries_)
        if (entry.isOn)
            entry.balancer->record(*frame, times);
}

absl::StatusOr<std::size_t> Equalizers::find(std::string_view name) const {
    return config::findNamed(entries_, "equalizer", name);
}

absl::Status Equalizers::tune(std::string_view name, const Tuning& tuning) {
    ASSIGN_OR_RETURN(const std::size_t position, find(name));
    return tune(position, tuning);
}

absl::Status Equalizers::tune(std::size_t position, const Tuning& tuning) {
    Entry& entry = entries_[position];
    ASSIGN_OR_RETURN(entry.settings, config::tuned(entry.settings, tuning));
    entry.isOn = tuning.isOn.value_or(entry.isOn);
    entry.isFrozen = tuning.isFrozen.value_or(entry.isFrozen);
    return absl::OkStatus();
}

double Equalizers::intervalMilliseconds() const {
    double longest = 0;
    for (const Entry& entry : entries_)
        if (entry.isOn)
            longest = std::max(longest, entry.balancer->intervalMilliseconds());
    return longest;
}

std::vector<EqualizerState> Equalizers::states() const {
    std::vector<EqualizerState> states;
    for (const Entry& entry : entries_)
        states.push_back({entry.name, entry.position, entry.settings, entry.isOn, entry.isFrozen,
                          entry.balancer->report()});
    return states;
}

}  // namespace eyrie::equalizer
