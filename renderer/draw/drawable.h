// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include <absl/status/status.h>

#include "fabric/box.h"
#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/frustum.h"
#include "fabric/ground.h"
#include "fabric/lights.h"
#include "fabric/scene.h"
#include "fabric/statistics.h"
#include "renderer/draw/view_turns.h"
#include "renderer/lod/view.h"
#include "renderer/occlusion/hidden_ground.h"

namespace eyrie::pick {
class Surface;
}

namespace eyrie::draw {

/// What an interactive frame spends at most on copying what has come to the device.
inline constexpr std::chrono::duration<double, std::milli> kUploadTime{3};

/// One LOD node of a frame's cut.
struct Piece {
    std::uint32_t index = 0;  ///< the drawable's own name for it, valid until the next cut
    /// Where it starts in the object's work [0, 1); of what starts before the channel's range and
    /// reaches into it, where that begins.
    double rangePosition = 0;
    fabric::Box bounds;  ///< object space, metres
    bool isNode = true;  ///< false for what is drawn beside the nodes
    /// About: what leaving it out saves. Of a mesh those that are drawn, from firstTriangle on.
    std::uint64_t triangles = 0;
    bool hasBlended = false;   ///< parts of it belong to Layer::Blended
    std::uint32_t points = 0;  ///< that it is drawn as, in place of triangles
    double pointRadiusPixels = 0;
    std::uint32_t firstTriangle = 0;
};

/// What is drawn at one time: all that hides what is behind it, and then what lets it through.
enum class Layer { Opaque, Blended };

/// What part of which view a channel draws, and how well.
struct CutRequest {
    const lod::ObjectView& view;     ///< the whole view, from the object
    const fabric::Frustum& channel;  ///< the part that the channel looks through; same axes
    fabric::Range range;             ///< the share of the object's work that it draws
    double tauPixels = 1;
    fabric::Completeness completeness = fabric::Completeness::Complete;
    double exaggeration = 1;       ///< of terrain; `view` holds it already
    bool wantsPageBounds = false;  ///< pieces for them, beside the nodes
    bool isFrozen = false;         ///< what is chosen is seen from elsewhere than `view`
    std::stop_token stop = {};     ///< ends the wait for what a complete cut needs
    ViewTurn turn = {};            ///< of `view`
};

/// What a drawable shows of itself in one channel.
struct Cut {
    std::vector<Piece> pieces;  ///< ascending by rangePosition
    bool isComplete = true;     ///< false when data that would lower the error are to come
    bool memoryRaisedTau = false;
    std::uint64_t pagesLoaded = 0;
    std::uint64_t bytesLoaded = 0;   ///< of these, as they lie in their file
    std::uint64_t pagesMissing = 0;  ///< that the wanted cut needs; coarser ones stand in
    std::uint64_t pagesFailed = 0;   ///< those of them that cannot be read now
    std::uint64_t tilesDecodedOnGpu = 0;
};

/// What a drawable holds in memory now, besides what it needs to be open.
struct MemoryUse {
    std::uint64_t deviceBytes = 0;  ///< geometry and textures
    std::uint64_t hostBytes = 0;    ///< pages, those being loaded included
};

/// What is the same for every piece of a frame.
struct FrameState {
    const lod::View& view;  ///< that is drawn
    const fabric::Lights& lights;
    fabric::Shading shading;
    const fabric::Look& look;
    const fabric::Range& range;  ///< of the channel
    fabric::PixelViewport part;  ///< of its pixels, that may be drawn: the scissor
    /// What falls on none of these may be left out: the same as `part` but where time is measured.
    fabric::PixelViewport channel;
    Layer layer = Layer::Opaque;
    std::stop_token stop = {};  ///< nobody wants the picture any more
    /// Linear; in place of all colours of the object's data.
    std::optional<fabric::Vec3> colour = {};
};

/// The frame as an object of the scene is drawn in it.
FrameState frameOf(const FrameState& frame, std::size_t object);

/// One object of the scene, on the GL thread.
class Drawable {
public:
    virtual ~Drawable() = default;

    /// Object space, metres.
    virtual fabric::Box bounds() const = 0;
    virtual std::uint64_t triangles() const = 0;
    virtual fabric::DataFile file() const = 0;

    /// How many triangles of the object the whole view sees at `request.tauPixels`, when all data
    /// are there. About: what it decides is only how well to draw. Followed by selectCut() for the
    /// same view.
    virtual std::uint64_t viewTriangles(const CutRequest& request) = 0;

    /// About how long drawing all takes that the view shows of the object, in a unit that is the
    /// same for all objects and, for the same files and view, on every machine. Followed by
    /// selectCut() for the same view.
    virtual double viewWork(const CutRequest& request) = 0;

    /// Chooses what stands for the object in a channel. Complete cuts of one view and range are the
    /// same whatever the channel, so the channels of a frame fit together; they wait for what has
    /// to be loaded. Interactive ones take what is there.
    virtual Cut selectCut(const CutRequest& request) = 0;

    /// Boxes (object space, metres) that together hold a piece of the last cut, where they are
    /// smaller than its own.
    virtual std::vector<fabric::Box> partBounds(const Piece& /*piece*/) const { return {}; }

    /// Draws what of pieces of the last cut belongs to the frame's layer, in order, into the bound
    /// framebuffer. As lines all of it is Layer::Opaque. Counts triangles, and pages that are
    /// loaded only now, in `statistics`.
    virtual absl::Status draw(std::span<const Piece> pieces, const FrameState& frame,
                              fabric::FrameStatistics& statistics) = 0;

    /// Screen-space error, in pixels, of the last cut, once it is drawn: a bound over all that is
    /// seen of it in the view. `request` is what the cut was asked for by. `hidden` tells of the
    /// finished picture what hills hide; null where it shows something else, too.
    virtual double errorPixels(const CutRequest& request, occlusion::HiddenGround* hidden) = 0;

    /// The finest data of the files it has open, placed as `object` is; outlives this.
    virtual std::unique_ptr<const pick::Surface> surface(
        const fabric::SceneObject& object) const = 0;

    /// That its file brings along. Object space.
    virtual fabric::FileLights lights() const { return {}; }

    virtual MemoryUse memory() const { return {}; }

    /// How high it reaches, if it is terrain, in at most `maxCells` cells.
    virtual std::optional<fabric::GroundGrid> ground(int /*maxCells*/) const {
        return std::nullopt;
    }
};

}  // namespace eyrie::draw
