// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/config/swap_barriers.h"
#include "coordinator/frame/shown.h"
#include "fabric/camera.h"
#include "fabric/channel_task.h"
#include "fabric/frame_data.h"
#include "fabric/image.h"
#include "fabric/pick.h"
#include "fabric/scene.h"
#include "fabric/seen_area.h"
#include "fabric/statistics.h"

namespace eyrie::coordinator {

/// What somebody wants to see.
struct FrameRequest {
    fabric::Camera camera;
    double tauPixels = 1;
    fabric::Shading shading = fabric::Shading::Smooth;
    fabric::Look look = {};
    fabric::Occlusion occlusion = fabric::Occlusion::Auto;
    int width = 1280;  ///< pixels, 1 to fabric::kMaxViewPixels
    int height = 720;
    /// What of the picture is drawn, with the whole picture's level of detail and rasterisation;
    /// empty: all of it.
    fabric::PixelViewport part = {};
    bool wantsDepth = false;
    /// 1 to 100: the picture goes to browsers as JPEGs of that quality, so where it is laid out of
    /// what renderers draw, and nothing is composited, they encode it (RenderedFrame::tiles).
    /// 0: its pixels are wanted.
    int jpegQuality = 0;
    fabric::Completeness completeness = fabric::Completeness::Complete;
    bool measuresStages = false;  ///< fabric::ChannelTask::measuresStages
    /// A time to hold, 1 to 10,000 ms. Tau may rise, and where that is not enough the picture gets
    /// smaller than asked for; the statistics say what came of it.
    std::optional<double> budgetMilliseconds = {};
    /// What of the configuration is seen, each as a picture of that size (of one eye); all with one
    /// version of the frame data.
    std::vector<Shown> shown = {Shown{}};
    /// Whose frame it is: of each session's, equalizers learn by themselves how to share out its
    /// next ones. 0: nobody's in particular, as single pictures are.
    std::uint64_t session = 0;
    /// Ends it, with Cancelled: nobody wants it any more. What has not begun is not drawn;
    /// renderers stop at what they are at.
    std::stop_token stop = {};

    fabric::PixelViewport drawnPart() const {
        return part.isEmpty() ? fabric::PixelViewport{0, 0, width, height} : part;
    }
    bool operator==(const FrameRequest&) const = default;
};

/// What one of a frame's pictures is.
struct PictureFacts {
    std::size_t shown = 0;      ///< in FrameRequest::shown
    fabric::SeenAreas seen;     ///< by which sights
    std::string whyBlind = {};  ///< compound::Picture::whyBlind

    bool operator==(const PictureFacts&) const = default;
};

/// What one renderer drew of a frame.
struct DrawnPart {
    std::string renderer;  ///< its id
    double left = 0;       ///< shares of its view's width and height, from the lower left corner
    double bottom = 0;
    double width = 1;
    double height = 1;
    fabric::Range range;
    double milliseconds = 0;  ///< that the renderer took, without the transmission
    std::uint64_t triangles = 0;

    bool operator==(const DrawnPart&) const = default;
};

/// A part of a picture as a renderer encoded it.
struct CodedTile {
    fabric::PixelViewport area;  ///< in the picture's pixels
    std::vector<std::byte> jpeg;

    bool operator==(const CodedTile&) const = default;
};

/// A composited picture, or the part asked for: `image.area` is its drawnPart(), or of the same
/// shape and smaller where a budget is to be kept.
struct RenderedFrame {
    fabric::Image image;
    fabric::FrameStatistics statistics;
    fabric::DeviceInfo device;  ///< of the first renderer that took part
    /// Of what else was asked for, in that order; of separate eyes, the second's after the first's.
    std::vector<fabric::Image> further = {};
    std::vector<PictureFacts> pictures = {};  ///< of `image` and of what is further
    std::vector<DrawnPart> parts = {};        ///< who drew what
    /// Side by side they are the picture, where the request allows it: `image` has no pixels then.
    std::vector<CodedTile> tiles = {};
    /// PictureRevision: pictures with different ones do not belong together.
    std::uint64_t revision = 0;
};

/// Of the first of a frame's pictures of which a part shows nothing.
inline std::string whyBlind(const RenderedFrame& frame) {
    for (const PictureFacts& picture : frame.pictures)
        if (!picture.whyBlind.empty())
            return picture.whyBlind;
    return "";
}

/// For a person to read, where a frame shows nothing; empty where it shows something. What a canvas
/// puts together of others' frames, as monitors do, is drawn and seen by no sight of its own.
inline std::string whyEmpty(const RenderedFrame& frame) {
    if (!frame.parts.empty())
        return "";
    for (const PictureFacts& picture : frame.pictures)
        if (!picture.seen || !picture.seen->empty())
            return "";
    if (frame.pictures.empty())
        return "";
    if (const std::string why = whyBlind(frame); !why.empty())
        return "Nothing is seen here: " + why + ".";
    return "Nothing is seen here: the canvas shows no layout, or no compound draws what the view "
           "shows.";
}

/// The same of a frame of which a part shows nothing.
inline std::string whyPartlyEmpty(const RenderedFrame& frame) {
    const std::string why = whyBlind(frame);
    return why.empty() || !whyEmpty(frame).empty() ? "" : "A part shows nothing: " + why + ".";
}

enum class RendererCondition {
    Ready,     ///< draws
    Opening,   ///< reads the scene
    Late,      ///< has not answered in time: others do its part meanwhile
    Draining,  ///< takes no new tasks, finishes its own and leaves
    Dead,      ///< has died, or does not answer
    Refused,   ///< has another version of Eyrie or other data, or cannot open the scene
};

struct RendererStatus {
    std::string id;
    std::string address;  ///< where it takes work
    fabric::DeviceInfo device;
    RendererCondition condition = RendererCondition::Ready;
    std::string why = {};  ///< it is dead or refused, for a person to read
    std::chrono::system_clock::time_point since = {};  ///< it is dead or was refused a place
    /// Of why it is refused: InvalidArgument, NotFound or DataLoss where the scene is wrong.
    absl::StatusCode code = absl::StatusCode::kFailedPrecondition;

    bool isAlive() const {
        return condition != RendererCondition::Dead && condition != RendererCondition::Refused;
    }
    bool operator==(const RendererStatus&) const = default;
};

/// What of the configuration can be seen and switched. Names are those that config::findNamed finds
/// each by: "#1" where another is called so, or is called "1".
struct CanvasStatus {
    std::string name;
    std::vector<std::string> segments;
    std::vector<std::string> layouts;      ///< that it can show
    std::string layout;                    ///< that it shows; "OFF": none
    config::CanvasBarriers barriers = {};  ///< that its screens are shown behind

    bool operator==(const CanvasStatus&) const = default;
};

/// A change of what the configuration shows, by names as in Shown.
struct SwitchLayout {
    std::string canvas;
    std::string layout;  ///< "OFF": none
};

/// What a person should know about the coordinator now.
struct Status {
    std::vector<RendererStatus> renderers;
    fabric::Scene scene;
    fabric::SceneInfo sceneInfo;
    std::vector<CanvasStatus> canvases;
    /// Why there is no picture, for a person to read; empty while there is one.
    std::string problem;
    /// What is missing though there is one, for a person to read; empty where nothing is.
    std::string note = {};
    std::uint64_t sceneRevision = 0;    ///< of the scene and its data; counts up
    std::uint64_t displayRevision = 0;  ///< of what the configuration shows, and how; counts up
};

/// Where pictures come from. All functions may be called from any thread.
class FrameSource {
public:
    virtual ~FrameSource() = default;

    /// Draws one frame; blocks until all of the picture is there. Calls from several threads begin
    /// in turn, a few of them at the same time where the configuration's latency allows it and
    /// renderers would be idle, and end in the order in which they began. A renderer that fails has
    /// its part drawn by another, so an error means that no complete frame can be had:
    /// InvalidArgument (the request), Unavailable (no renderer, or no scene), Cancelled (the
    /// request says so), or what the last renderer said.
    virtual absl::StatusOr<RenderedFrame> renderFrame(const FrameRequest& request) = 0;

    /// What to draw; nothing where no frame is wanted any more.
    using ChooseFrame = std::function<std::optional<FrameRequest>()>;
    /// The same, but the request is asked for when the frame begins: what it shows is no older than
    /// need be. `choose` is called on the caller's thread, once or, on an error, perhaps not.
    /// Cancelled where nothing is wanted, and once `stop` is requested: of what has its turn, by
    /// the request.
    virtual absl::StatusOr<RenderedFrame> renderLatest(const ChooseFrame& choose,
                                                       const std::stop_token& stop = {}) {
        if (stop.stop_requested())
            return absl::CancelledError("no frame is wanted any more");
        const std::optional<FrameRequest> request = choose();
        if (!request)
            return absl::CancelledError("no frame is wanted any more");
        return renderFrame(*request);
    }

    /// How many frames it is worth to ask for at the same time: more would only wait.
    virtual int framesAtOnce() const { return 1; }

    /// By which sights the first of the pictures asked for would be seen, for picks in it. Errors:
    /// those of the request; FailedPrecondition before there was a renderer to make a
    /// configuration of; Unimplemented of a picture that is put together of other channels'.
    virtual absl::StatusOr<fabric::SeenAreas> seen(const FrameRequest& request) = 0;

    /// What a place of a picture shows, asked of one renderer and, should that fail, of the next;
    /// blocks, but not for frames. Errors: InvalidArgument (the request), Unavailable (no renderer,
    /// or no scene), or what the last renderer said.
    virtual absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request) = 0;

    /// From the next frame on. Errors: NotFound, naming what there is.
    virtual absl::Status configure(const SwitchLayout& change) = 0;

    virtual Status status() const = 0;

    /// Calls `listener`, from any thread and without locks held, after each change of status().
    /// Returns a handle for unsubscribe; after unsubscribe returns, the listener runs no more.
    virtual int subscribe(std::function<void()> listener) = 0;
    virtual void unsubscribe(int handle) = 0;
};

}  // namespace eyrie::coordinator
