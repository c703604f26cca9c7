// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include <absl/status/status.h>

#include "coordinator/compound/plan.h"

/// What the compounds of a configuration would do in one frame, whether anyone needs it or not:
/// their tasks, in the order in which they are written.
namespace eyrie::compound {

/// A walk through the trees for one eye: compounds of `compounds` take part, and see by `sight`.
/// They differ where a view for one eye is to be seen with two.
struct Pass {
    Eye compounds = Eye::Cyclop;
    Eye sight = Eye::Cyclop;

    bool operator==(const Pass&) const = default;
};

/// How the pixels of a framebuffer lie on the view.
struct Lattice {
    std::vector<fabric::Regridding> regriddings;  ///< from the view's pixels
    config::SubPixelShare subpixel;

    bool operator==(const Lattice&) const = default;
};

/// A framebuffer while a plan is made.
struct WorkingBuffer {
    std::size_t destination = 0;  ///< in ResolvedConfiguration::destinations
    Pass pass;
    Lattice lattice;
    Framebuffer framebuffer;
};

/// A part of a framebuffer that others may take.
struct OutputFrame {
    std::size_t framebuffer = 0;
    fabric::PixelViewport part;
    std::optional<fabric::Regridding> zoom;
    bool hasDepth = false;                   ///< to be composited by depth
    std::size_t compound = 0;                ///< that makes it, in ResolvedConfiguration::compounds
    const config::Frame* written = nullptr;  ///< null: given to a compound above, without a name
};

/// What an input frame says of where it comes; others come to where they were made.
struct Placing {
    fabric::PixelViewport whole;  ///< of the compound that takes it
    fabric::PixelViewport part;   ///< of that, the frame's viewport
    std::optional<fabric::Vec2> zoom;

    bool operator==(const Placing&) const = default;
};

struct Input {
    std::size_t frame = 0;  ///< in WorkList::frames
    std::optional<Placing> placing = {};
    const config::Frame* written = nullptr;  ///< null: given by a child, without a name
    bool withDepth = true;                   ///< by depth, where the frame has any
};

/// One task of a compound.
struct Work {
    enum class Kind { Clear, Draw, Assemble, ReadBack };
    Kind kind = Kind::Clear;
    std::size_t framebuffer = 0;
    fabric::PixelViewport part;
    std::size_t compound = 0;   ///< in ResolvedConfiguration::compounds
    std::size_t draw = 0;       ///< Draw: in WorkList::draws
    std::size_t frame = 0;      ///< ReadBack: in WorkList::frames
    std::vector<Input> inputs;  ///< Assemble
};

/// Where an eye sees nothing.
struct Blind {
    absl::Status why;
    config::Place place;  ///< of the compound that would draw it
};

struct WorkList {
    explicit WorkList(Refusals& whatCannotBe) : refusals(whatCannotBe) {}

    std::vector<WorkingBuffer> framebuffers;
    std::vector<OutputFrame> frames;
    std::vector<PlannedDraw> draws;
    std::vector<Work> works;
    std::vector<std::vector<config::ChannelIndex>> queues;
    /// By destination and pass, of the first compound.
    std::map<std::tuple<std::size_t, Eye, Eye>, Blind> blind;
    /// Null where the framebuffer's destination is seen, or its picture is put together of others'.
    const Blind* blindOf(std::size_t framebuffer) const;
    /// Any draw of the framebuffer's destination in its pass, whoever does it; null where nothing
    /// of that is drawn.
    const fabric::ChannelTask* drawOf(std::size_t framebuffer) const;
    Refusals& refusals;

    /// The framebuffer in which a destination's picture comes to be; made where there is none yet.
    std::size_t pictureOf(const config::ResolvedConfiguration& resolved, std::size_t destination,
                          const Pass& pass);
    std::size_t find(const WorkingBuffer& wanted);

private:
    /// But for the lattice, of which one destination's channel has few.
    using Owner =
        std::tuple<std::size_t, Eye, Eye, std::size_t, std::size_t, std::size_t, std::size_t>;
    std::map<Owner, std::vector<std::size_t>> found_;
};

/// Adds what one pass does. Refuses pictures larger than renderers draw.
void addWork(const config::Configuration& configuration,
             const config::ResolvedConfiguration& resolved, const PlanRequest& request,
             const Pass& pass, WorkList& list);

/// The same works, each after those that it depends on: those before it on its framebuffer, and
/// those whose frames it takes. Refuses, and leaves out, those that wait for each other.
std::vector<Work> inOrder(const config::ResolvedConfiguration& resolved, WorkList& list);

}  // namespace eyrie::compound
