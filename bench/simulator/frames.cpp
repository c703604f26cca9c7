// SPDX-License-Identifier: Apache-2.0
#include "bench/simulator/frames.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/simulator/events.h"
#include "coordinator/config/frames_under_way.h"
#include "coordinator/config/resolved.h"

namespace eyrie::simulator {
namespace {

constexpr double kBytesPerPixel = 4;  ///< of colour, and again of depth
constexpr double kMillion = 1e6;
constexpr std::int64_t kMostFrames = 1024;  ///< that count: rates are within a hundredth then
constexpr double kMostSteps = 1 << 13;      ///< of these, beyond one cycle: more take minutes

/// The events of frames of a configuration.
class Farm {
public:
    Farm(const config::Configuration& configuration, const config::ResolvedConfiguration& resolved,
         const Costs& costs, const Machines& machines, double triangles)
        : configuration_(configuration),
          resolved_(resolved),
          costs_(costs),
          machines_(machines),
          triangles_(triangles) {
        for (const Compound& compound : resolved.compounds)
            if (compound.channel)
                renderers_.try_emplace({compound.channel->node, compound.channel->pipe},
                                       renderers_.size());
        last_.resize(renderers_.size() + 1);
        addHosts();
    }

    struct Frame {
        Id begun;
        Id done;
    };
    /// Begins after `start`, if any.
    Frame addFrame(std::int64_t number, std::optional<Id> start) {
        number_ = number;
        start_ = events_.addDelay(0, start ? std::vector<Id>{*start} : std::vector<Id>{});
        for (std::size_t i = 0; i < resolved_.compounds.size(); ++i)
            if (resolved_.compounds[i].depth == 0)
                addTree(i);
        return {start_, last_.back().value_or(start_)};
    }

    Events& events() { return events_; }
    bool hasDrawn() const { return hasDrawn_; }
    bool fetchesTiles() const { return fetchesTiles_; }
    double bytes() const { return bytes_; }
    double processorMilliseconds() const {
        double sum = 0;
        for (const Host& host : hosts_) sum += events_.busy(host.cores) * machines_.cores;
        return sum;
    }

private:
    using Compound = config::ResolvedCompound;
    struct Host {
        Id cores;
        Id out;
        Id in;
    };
    /// An output frame, or what else is sent.
    struct Sent {
        std::size_t place = 0;
        double megapixels = 0;
        bool hasDepth = false;
        Id packed = 0;
    };
    struct Arrival {
        std::string name;
        std::size_t place;
        Id id;
    };

    double bytesPerMillisecond() const { return machines_.gigabitsPerSecond * 1e9 / 8 / 1000; }

    void addHosts() {
        const auto perHost = static_cast<std::size_t>(std::max(1, machines_.renderersPerHost));
        for (std::size_t i = 0; i < renderers_.size(); ++i)
            hostOf_.push_back(machines_.isOneMachine ? 0 : i / perHost);
        hostOf_.push_back(machines_.isOneMachine || renderers_.empty() ? 0 : hostOf_.back() + 1);
        for (std::size_t i = 0; i <= hostOf_.back(); ++i)
            hosts_.push_back({events_.addResource(machines_.cores),
                              events_.addResource(bytesPerMillisecond()),
                              events_.addResource(bytesPerMillisecond())});
    }

    std::size_t coordinator() const { return renderers_.size(); }
    std::size_t placeOf(const Compound& compound) const {
        return renderers_.at({compound.channel->node, compound.channel->pipe});
    }

    /// In this frame, and on a canvas that shows its layout.
    bool isNow(const Compound& compound) const {
        if (number_ % compound.period != compound.phase || !compound.destination)
            return false;
        const config::DestinationIndex& index = resolved_.destinations[*compound.destination].index;
        const auto& layouts = configuration_.canvases[index.canvas].layouts;
        return !layouts.empty() && layouts.front() == index.layout;
    }

    /// Each has a picture of its own.
    static int eyes(const Compound& compound) {
        return int{compound.eyes.cyclop} + int{compound.eyes.left} + int{compound.eyes.right};
    }
    static double megapixels(const Compound& compound) {
        return eyes(compound) * static_cast<double>(compound.pixelViewport.area()) / kMillion;
    }
    static double sizes(bool hasDepth) { return hasDepth ? 2 : 1; }

    /// Names of frames are of one tree.
    void addTree(std::size_t root) {
        findSent(root);
        visit(root, false);
        for (const Arrival& arrival : arrivals_)
            events_.addDependency(arrival.id, send(sent_.at(arrival.name), arrival.place));
        arrivals_.clear();
    }

    void findSent(std::size_t root) {
        sent_.clear();
        for (std::size_t i = root; i < resolved_.compounds.size(); ++i) {
            const Compound& compound = resolved_.compounds[i];
            if (i != root && compound.depth == 0)
                return;
            if (!compound.tasks.readback || !isNow(compound))
                continue;
            for (const config::ResolvedFrame& frame : compound.outputFrames) {
                const config::Frame& written = *frame.frame;
                const fabric::Vec2 zoom = written.zoom.value_or(fabric::Vec2(1, 1));
                sent_.emplace(frame.name,
                              Sent{placeOf(compound),
                                   megapixels(compound) * written.viewport.width *
                                       written.viewport.height * zoom.x * zoom.y,
                                   written.buffers.value_or(compound.buffers).depth, 0});
            }
        }
    }

    /// On the cores of a place, after what went on there before.
    Id compute(std::size_t place, double milliseconds, double threads,
               std::optional<Id> after = std::nullopt) {
        std::vector<Id> before = {start_};
        if (last_[place])
            before.push_back(*last_[place]);
        if (after)
            before.push_back(*after);
        last_[place] = events_.addActivity(milliseconds, threads, {hosts_[hostOf_[place]].cores},
                                           std::move(before));
        return *last_[place];
    }

    Id send(const Sent& sent, std::size_t to) {
        const double bytes =
            sent.megapixels * kMillion * kBytesPerPixel * (sent.hasDepth ? 2 * costs_.packed : 1);
        bytes_ += bytes;
        const std::size_t a = hostOf_[sent.place];
        const std::size_t b = hostOf_[to];
        if (a == b)
            return sent.packed;
        const Id passed = events_.addActivity(bytes, bytesPerMillisecond(),
                                              {hosts_[a].out, hosts_[b].in}, {sent.packed});
        return events_.addDelay(machines_.latencyMilliseconds, {passed});
    }

    void visit(std::size_t position, bool isWithinPicture) {
        const Compound& compound = resolved_.compounds[position];
        const bool isPicture = compound.destination && !isWithinPicture;
        if (compound.tasks.draw && isNow(compound))
            draw(compound);
        for (std::size_t child = position + 1; child < resolved_.compounds.size() &&
                                               resolved_.compounds[child].depth > compound.depth;
             ++child)
            if (resolved_.compounds[child].depth == compound.depth + 1)
                visit(child, isWithinPicture || isPicture);
        if (!isNow(compound) || !compound.channel)
            return;
        if (isPicture)
            gather(compound);
        else if (compound.tasks.assemble)
            for (const config::ResolvedFrame& frame : compound.inputFrames)
                assemble(frame.name, placeOf(compound));
        if (compound.tasks.readback)
            for (const config::ResolvedFrame& frame : compound.outputFrames) pack(frame.name);
    }

    void draw(const Compound& compound) {
        hasDrawn_ = true;
        fetchesTiles_ = fetchesTiles_ ||
                        (compound.compound != nullptr && !compound.compound->inputTiles.empty());
        const auto met = [&](double share) { return share + costs_.overlap * (1 - share); };
        const double range = compound.range.end - compound.range.begin;
        const double millions = triangles_ / kMillion * range * met(compound.viewport.width) *
                                met(compound.viewport.height);
        compute(placeOf(compound),
                eyes(compound) * (costs_.taskMs + costs_.millionTrianglesMs * millions) +
                    costs_.megapixelMs * megapixels(compound) * range,
                costs_.threads);
    }

    void pack(const std::string& name) {
        Sent& sent = sent_.at(name);
        sent.packed = compute(
            sent.place, costs_.readbackMegapixelMs * sent.megapixels * sizes(sent.hasDepth), 1);
    }

    /// What comes is put on or merged, in the order in which it is written; nothing when nobody
    /// makes it in this frame.
    void assemble(const std::string& name, std::size_t place) {
        const auto sent = sent_.find(name);
        if (sent == sent_.end())
            return;
        const Id arrival = events_.addDelay(0, {start_});
        arrivals_.push_back({name, place, arrival});
        putOn(sent->second, place, arrival);
    }

    void putOn(const Sent& sent, std::size_t place, Id arrival) {
        const double rate = sent.hasDepth ? costs_.mergeMegapixelMs : costs_.assembleMegapixelMs;
        compute(place, rate * sent.megapixels, 1, arrival);
    }

    /// What the destination's channel has goes to the coordinator, and what its root takes. Where
    /// finished strips of others come, the rest is its own.
    void gather(const Compound& root) {
        double others = 0;
        bool hasDepth = false;
        for (const config::ResolvedFrame& frame : root.inputFrames)
            if (const auto sent = sent_.find(frame.name); sent != sent_.end()) {
                others += sent->second.megapixels;
                hasDepth = hasDepth || sent->second.hasDepth;
            }
        const double rest = hasDepth ? megapixels(root) : megapixels(root) - others;
        Sent own{placeOf(root), std::max(0.0, rest), hasDepth, 0};
        if (last_[own.place] && own.megapixels > 0) {
            own.packed = compute(own.place,
                                 costs_.readbackMegapixelMs * own.megapixels * sizes(hasDepth), 1);
            putOn(own, coordinator(), send(own, coordinator()));
        }
        for (const config::ResolvedFrame& frame : root.inputFrames)
            assemble(frame.name, coordinator());
    }

    const config::Configuration& configuration_;
    const config::ResolvedConfiguration& resolved_;
    const Costs& costs_;
    const Machines& machines_;
    const double triangles_;
    Events events_;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> renderers_;
    std::vector<Host> hosts_;
    std::vector<std::size_t> hostOf_;      ///< by place: renderers, then the coordinator
    std::vector<std::optional<Id>> last_;  ///< step, by place
    std::int64_t number_ = 0;
    Id start_ = 0;
    std::map<std::string, Sent> sent_;
    std::vector<Arrival> arrivals_;
    double bytes_ = 0;
    bool hasDrawn_ = false;
    bool fetchesTiles_ = false;
};

/// Those that count: whole cycles, after each of which the same is drawn with as many under way;
/// several of them, for frames in flight do not come evenly.
std::int64_t framesThatCount(const config::ResolvedConfiguration& resolved, std::int64_t underWay) {
    std::int64_t cycle = underWay;
    double steps = 1;
    for (const config::ResolvedCompound& compound : resolved.compounds) {
        cycle = std::min(std::lcm(cycle, std::min(compound.period, kMostFrames)), kMostFrames);
        steps += static_cast<double>(1 + compound.outputFrames.size()) /
                 static_cast<double>(compound.period);
    }
    if (underWay == 1)
        return cycle;
    const auto most = static_cast<std::int64_t>(kMostSteps / steps);
    return cycle * std::max<std::int64_t>(1, std::min(most, kMostFrames) / cycle);
}

}  // namespace

absl::StatusOr<Prediction> predict(const config::Configuration& configuration, const Costs& costs,
                                   const Machines& machines, double triangles) {
    config::Findings findings;
    const config::ResolvedConfiguration resolved = config::resolve(configuration, findings);
    if (findings.hasErrors())
        return absl::InvalidArgumentError(config::describe(findings, "the configuration"));
    Farm farm(configuration, resolved, costs, machines, triangles);
    const std::int64_t underWay = config::framesUnderWay(configuration.latency);
    const auto latency = static_cast<std::size_t>(underWay - 1);
    const auto counted = static_cast<std::size_t>(framesThatCount(resolved, underWay));
    // As many before them: those that begin together take hundreds to spread out.
    const std::size_t first = latency == 0 ? 0 : counted;
    std::vector<Farm::Frame> frames;
    for (std::size_t i = 0; i < first + counted; ++i) {
        const auto before = frames.size() > latency
                                ? std::optional<Id>(frames[frames.size() - 1 - latency].done)
                                : std::nullopt;
        frames.push_back(farm.addFrame(static_cast<std::int64_t>(i), before));
    }
    if (!farm.hasDrawn())
        return absl::InvalidArgumentError("the configuration draws nothing");
    if (farm.fetchesTiles())
        return absl::InvalidArgumentError(
            "which renderers fetch how many tiles is not predicted; give compounds a viewport or a "
            "range each, in place of tile_equalizer and inputtiles");
    if (!farm.events().run())
        return absl::InvalidArgumentError("frames of the configuration wait for each other");
    const auto done = [&](std::size_t i) { return farm.events().doneAt(frames[i].done); };
    Prediction prediction;
    for (std::size_t i = first; i < frames.size(); ++i)
        prediction.frameMilliseconds +=
            (done(i) - farm.events().doneAt(frames[i].begun)) / static_cast<double>(counted);
    const double begun = first == 0 ? 0 : done(first - 1);
    prediction.framesPerSecond =
        1000 * static_cast<double>(counted) / (done(frames.size() - 1) - begun);
    prediction.bytes = farm.bytes() / static_cast<double>(frames.size());
    prediction.processorMilliseconds =
        farm.processorMilliseconds() / static_cast<double>(frames.size());
    return prediction;
}

}  // namespace eyrie::simulator
