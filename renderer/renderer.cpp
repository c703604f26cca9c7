// SPDX-License-Identifier: Apache-2.0
#include "renderer/renderer.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "effects/object_block.h"
#include "fabric/status.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/mesh_draw.h"
#include "renderer/draw/occluded_draw.h"
#include "renderer/draw/terrain_draw.h"
#include "renderer/gl/egl_context.h"
#include "renderer/gl/framebuffer.h"
#include "renderer/lod/view.h"
#include "renderer/page/loader.h"
#include "renderer/page/remote_name.h"

namespace eyrie {
namespace {

using Clock = std::chrono::steady_clock;

/// What is drawn so far is handed over, so that llvmpipe fills pixels on other cores while this
/// thread prepares more triangles: it waits for a frame's end, or megabytes of them, by itself.
constexpr std::uint64_t kTrianglesABatch = 8192;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

absl::Status validateTask(const fabric::FrameData& frameData, const fabric::ChannelTask& task) {
    RETURN_IF_ERROR(fabric::validate(frameData.camera));
    RETURN_IF_ERROR(fabric::validate(frameData.look));
    if (!(frameData.tauPixels >= fabric::kMinTauPixels &&
          frameData.tauPixels <= fabric::kMaxTauPixels))
        return absl::InvalidArgumentError(fmt::format("tau is {} pixels; it must be from {} to {}",
                                                      frameData.tauPixels, fabric::kMinTauPixels,
                                                      fabric::kMaxTauPixels));
    if (frameData.budget)
        RETURN_IF_ERROR(fabric::validate(*frameData.budget));
    const auto inLimits = [](int side) { return side >= 1 && side <= fabric::kMaxViewPixels; };
    if (!inLimits(task.viewWidth) || !inLimits(task.viewHeight))
        return absl::InvalidArgumentError(
            fmt::format("the view is {} x {} pixels; each side must be from 1 to {}",
                        task.viewWidth, task.viewHeight, fabric::kMaxViewPixels));
    const fabric::PixelViewport view{0, 0, task.viewWidth, task.viewHeight};
    if (task.pixelViewport.isEmpty() || !view.contains(task.pixelViewport))
        return absl::InvalidArgumentError(fmt::format(
            "the pixel viewport {}x{}+{}+{} is empty or not inside the view of {} x {} pixels",
            task.pixelViewport.width, task.pixelViewport.height, task.pixelViewport.x,
            task.pixelViewport.y, task.viewWidth, task.viewHeight));
    return absl::OkStatus();
}

/// Whether not all that is drawn is filled surfaces.
bool hasLines(const fabric::FrameData& frameData) {
    return frameData.shading == fabric::Shading::Wireframe || frameData.look.tileBounds ||
           frameData.look.pageBounds;
}

/// Pixels that what falls to a channel may touch. A line reaches half a pixel beyond its place, so
/// the piece it belongs to may lie beside the channel.
fabric::PixelViewport reach(const fabric::FrameData& frameData, const fabric::PixelViewport& part) {
    return hasLines(frameData)
               ? fabric::PixelViewport{part.x - 1, part.y - 1, part.width + 2, part.height + 2}
               : part;
}

const gl::PassState& passState(fabric::Shading shading) {
    return shading == fabric::Shading::Wireframe ? effects::ObjectBlock::kWireframe
                                                 : effects::ObjectBlock::kSolid;
}

/// What a channel draws, and the pixels outside which none of it falls.
struct Selection {
    std::vector<draw::OrderedPiece> pieces;
    /// With parts that are blended, of any range, the farthest first.
    std::vector<draw::OrderedPiece> blended;
    std::vector<fabric::Mat4> worldFromObject;  ///< of each object, as drawn
    fabric::PixelViewport covered;
};

void addTo(fabric::FrameStatistics& statistics, const draw::Cut& cut) {
    statistics.complete = statistics.complete && cut.isComplete;
    statistics.pagesLoaded += cut.pagesLoaded;
    statistics.bytesLoaded += cut.bytesLoaded;
    statistics.pagesMissing += cut.pagesMissing;
    statistics.pagesFailed += cut.pagesFailed;
    statistics.tilesDecodedOnGpu += cut.tilesDecodedOnGpu;
}

struct OpenObject {
    fabric::SceneObject object;
    std::unique_ptr<draw::Drawable> drawable;
};

/// A terrain's heights are drawn exaggerated; a mesh is not.
fabric::Mat4 drawnWorldFromObject(const fabric::SceneObject& object, const fabric::Look& look) {
    return object.kind == fabric::ObjectKind::Terrain
               ? fabric::exaggerated(object.worldFromObject, look.exaggeration)
               : object.worldFromObject;
}

/// How high the terrains among `objects` reach; null where there are none.
std::shared_ptr<const std::vector<fabric::GroundGrid>> groundOf(
    const std::vector<OpenObject>& objects) {
    const auto terrains = std::count_if(objects.begin(), objects.end(), [](const auto& open) {
        return open.object.kind == fabric::ObjectKind::Terrain;
    });
    if (terrains == 0 || terrains > fabric::kMaxGroundCells)
        return nullptr;
    auto ground = std::make_shared<std::vector<fabric::GroundGrid>>();
    for (const OpenObject& open : objects)
        if (auto grid = open.drawable->ground(fabric::kMaxGroundCells / static_cast<int>(terrains)))
            ground->push_back(*std::move(grid));
    return ground;
}

}  // namespace

class Renderer::Impl {
public:
    static absl::StatusOr<std::unique_ptr<Impl>> create(const RendererOptions& options);

    const fabric::DeviceInfo& device() const { return context_->device(); }
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene);
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& asked,
                                                 const fabric::ChannelTask& task);
    RendererMemory memory() const;

private:
    Impl(std::unique_ptr<gl::EglContext> context, const RendererOptions& options)
        : context_(std::move(context)),
          options_(options),
          decoding_(options.decoding),
          loader_({.threads = options.loaderThreads}),
          sources_(page::sourceOptions(options.remote.cacheFolder, options.remote.cacheBytes)) {}

    page::Loader& loaderFor(const fabric::SceneObject& object);
    absl::StatusOr<std::unique_ptr<draw::Drawable>> openObject(const fabric::SceneObject& object,
                                                               std::size_t objects);
    draw::TextureFormat textureFormat() const {
        return GLEW_EXT_texture_compression_s3tc && !device().software ? draw::TextureFormat::Bc1
                                                                       : draw::TextureFormat::Rgba8;
    }
    std::uint64_t viewTriangles(const lod::View& view, const fabric::FrameData& frameData,
                                const fabric::ChannelTask& task, double tauPixels);
    double coveredShare(const lod::View& view, const fabric::FrameData& frameData) const;
    fabric::FrameData withinBudget(const lod::View& view, const fabric::FrameData& frameData,
                                   const fabric::ChannelTask& task,
                                   fabric::FrameStatistics& statistics);
    Selection selectPieces(const lod::View& view, const fabric::FrameData& frameData,
                           const fabric::ChannelTask& task, fabric::FrameStatistics& statistics);
    double errorPixels(const lod::View& view, const fabric::FrameData& frameData,
                       const fabric::ChannelTask& task, const fabric::PixelViewport& covered);
    absl::Status drawSelection(const Selection& selection, const lod::View& view,
                               const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                               fabric::FrameStatistics& statistics);
    absl::Status drawPieces(const draw::OccludedDraw::Pieces& pieces, const draw::FrameState& frame,
                            fabric::FrameStatistics& statistics);
    absl::Status measureStages(const Selection& selection, const lod::View& view,
                               const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                               fabric::StageMilliseconds& milliseconds);
    absl::Status drawBlended(std::span<const draw::OrderedPiece> pieces, draw::FrameState frame,
                             fabric::FrameStatistics& statistics);

    std::unique_ptr<gl::EglContext> context_;  // first: everything below needs it current
    effects::EffectVariants<effects::TerrainEffect> terrainPrograms_;
    effects::EffectVariants<effects::MeshEffect> meshPrograms_;
    gl::Framebuffer framebuffer_;
    draw::OccludedDraw occludedDraw_;
    RendererOptions options_;
    draw::DecodeChoice decoding_;
    page::Loader loader_;
    /// Of its own threads, so that a server that stalls does not hold up local files. Made for the
    /// first scene that needs it.
    std::optional<page::Loader> remoteLoader_;
    page::SourceOptions sources_;
    /// What the last frame drew, one after the other: some of it more than once.
    std::vector<draw::OccludedDraw::Pieces> drawn_;
    std::optional<fabric::Scene> scene_;
    std::vector<OpenObject> objects_;
};

absl::StatusOr<std::unique_ptr<Renderer::Impl>> Renderer::Impl::create(
    const RendererOptions& options) {
    ASSIGN_OR_RETURN(auto context, gl::EglContext::create(options.device));
    return std::unique_ptr<Impl>(new Impl(std::move(context), options));
}

page::Loader& Renderer::Impl::loaderFor(const fabric::SceneObject& object) {
    if (!page::isRemote(object.path))
        return loader_;
    if (!remoteLoader_)
        remoteLoader_.emplace(page::LoaderOptions{.threads = options_.remote.loaderThreads});
    return *remoteLoader_;
}

absl::StatusOr<std::unique_ptr<draw::Drawable>> Renderer::Impl::openObject(
    const fabric::SceneObject& object, std::size_t objects) {
    if (object.kind == fabric::ObjectKind::Terrain)
        return draw::openTerrain(
            object, terrainPrograms_, sources_, loaderFor(object),
            {options_.memoryBytes / objects, options_.hostMemoryBytes / objects}, textureFormat(),
            decoding_);
    return draw::openMesh(object, meshPrograms_, sources_, loaderFor(object),
                          {options_.memoryBytes / objects, options_.hostMemoryBytes / objects},
                          textureFormat());
}

absl::StatusOr<fabric::SceneInfo> Renderer::Impl::openScene(const fabric::Scene& scene) {
    RETURN_IF_ERROR(fabric::validate(scene));
    std::vector<OpenObject> objects;
    fabric::SceneInfo info;
    for (const fabric::SceneObject& object : scene.objects) {
        ASSIGN_OR_RETURN(auto drawable, openObject(object, scene.objects.size()));
        info.bounds.grow(fabric::transformed(drawable->bounds(), object.worldFromObject));
        info.triangles += drawable->triangles();
        info.bytes += drawable->bytes();
        objects.push_back({object, std::move(drawable)});
    }
    info.ground = groundOf(objects);
    scene_ = scene;
    objects_ = std::move(objects);
    occludedDraw_.forget();
    return info;
}

/// The farthest first, by the middles of their boxes.
void sortBackToFront(std::vector<draw::OrderedPiece>& pieces, const lod::View& view,
                     const std::vector<fabric::Mat4>& worldFromObject) {
    std::vector<lod::ObjectView> views;
    for (const fabric::Mat4& one : worldFromObject) views.emplace_back(view, one);
    const auto height = [&](const draw::OrderedPiece& one) {  // the view looks down
        return (views[one.object].viewFromObject() * fabric::Vec4(one.piece.bounds.centre(), 1.0))
            .z;
    };
    std::stable_sort(pieces.begin(), pieces.end(),
                     [&](const auto& a, const auto& b) { return height(a) < height(b); });
}

/// Of all objects, in the whole view's cut.
std::uint64_t Renderer::Impl::viewTriangles(const lod::View& view,
                                            const fabric::FrameData& frameData,
                                            const fabric::ChannelTask& task, double tauPixels) {
    const fabric::Look& look = frameData.look;
    const lod::View cutView =
        look.cutCamera ? lod::View(*look.cutCamera, task.viewWidth, task.viewHeight) : view;
    std::uint64_t triangles = 0;
    for (const OpenObject& open : objects_) {
        const lod::ObjectView objectView(cutView, drawnWorldFromObject(open.object, look));
        triangles += open.drawable->viewTriangles({objectView,
                                                   cutView.frustum,
                                                   {},
                                                   tauPixels,
                                                   task.completeness,
                                                   look.exaggeration,
                                                   false});
    }
    return triangles;
}

/// Of the view's pixels, those in a rectangle around all objects.
double Renderer::Impl::coveredShare(const lod::View& view,
                                    const fabric::FrameData& frameData) const {
    fabric::PixelViewport covered{};
    for (const OpenObject& open : objects_) {
        const lod::ObjectView objectView(view, drawnWorldFromObject(open.object, frameData.look));
        covered = enclosing(covered, objectView.coveredPixels(open.drawable->bounds()));
    }
    const fabric::PixelViewport all{0, 0, view.width, view.height};
    return static_cast<double>(intersection(covered, all).area()) / static_cast<double>(all.area());
}

/// The frame data with the tau that is drawn at.
fabric::FrameData Renderer::Impl::withinBudget(const lod::View& view,
                                               const fabric::FrameData& frameData,
                                               const fabric::ChannelTask& task,
                                               fabric::FrameStatistics& statistics) {
    fabric::FrameData drawn = frameData;
    if (!frameData.budget)
        return drawn;
    statistics.budget = fabric::tauForBudget(
        frameData.tauPixels, *frameData.budget, coveredShare(view, frameData),
        [&](double tauPixels) { return viewTriangles(view, frameData, task, tauPixels); });
    drawn.tauPixels = statistics.budget->tauPixels;
    return drawn;
}

/// The pieces of all objects that fall to the task, in the order of their place in the range.
/// Every channel of a frame draws in that order, so where depths tie the lower range wins in one
/// channel as it does in compositing.
///
/// What is blended falls to every range: of the channels that are composited, that which has the
/// nearest opaque surface of a pixel wins, and has to have drawn all that is in front of it.
Selection Renderer::Impl::selectPieces(const lod::View& view, const fabric::FrameData& frameData,
                                       const fabric::ChannelTask& task,
                                       fabric::FrameStatistics& statistics) {
    Selection selection;
    std::vector<draw::OrderedPiece>& pieces = selection.pieces;
    const fabric::Look& look = frameData.look;
    const bool hasLayers = frameData.shading != fabric::Shading::Wireframe;
    const fabric::Frustum channel = lod::subFrustum(view, reach(frameData, task.pixelViewport));
    // A cut that was frozen is brought whole: this view may see all of it.
    const lod::View cutView =
        look.cutCamera ? lod::View(*look.cutCamera, task.viewWidth, task.viewHeight) : view;
    const fabric::Frustum& cutChannel = look.cutCamera ? cutView.frustum : channel;
    for (std::uint32_t i = 0; i < objects_.size(); ++i) {
        const fabric::Mat4& worldFromObject =
            selection.worldFromObject.emplace_back(drawnWorldFromObject(objects_[i].object, look));
        const lod::ObjectView objectView(view, worldFromObject);
        const lod::ObjectView cutObjectView(cutView, worldFromObject);
        const draw::Cut cut = objects_[i].drawable->selectCut(
            {cutObjectView, cutChannel, task.range, frameData.tauPixels, task.completeness,
             look.exaggeration, look.pageBounds});
        addTo(statistics, cut);
        for (const draw::Piece& piece : cut.pieces) {
            const bool isInRange = task.range.contains(piece.rangePosition);
            const bool isBlended = piece.hasBlended && hasLayers;
            if ((!isInRange && !isBlended) || !objectView.isVisible(piece.bounds, channel))
                continue;
            if (isInRange)
                pieces.push_back({i, piece});
            if (isBlended)
                selection.blended.push_back({i, piece});
            if (!selection.covered.contains(task.pixelViewport))
                selection.covered =
                    enclosing(selection.covered, objectView.coveredPixels(piece.bounds));
        }
    }
    std::stable_sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) {
        return a.piece.rangePosition < b.piece.rangePosition;
    });
    sortBackToFront(selection.blended, view, selection.worldFromObject);
    selection.covered = intersection(selection.covered, task.pixelViewport);
    return selection;
}

/// What the finished picture promises. A frozen cut was chosen for another view. Hills hide what is
/// behind them where nothing is in the picture but one terrain, all of it opaque.
double Renderer::Impl::errorPixels(const lod::View& view, const fabric::FrameData& frameData,
                                   const fabric::ChannelTask& task,
                                   const fabric::PixelViewport& covered) {
    const fabric::Look& look = frameData.look;
    if (look.cutCamera)
        return std::numeric_limits<double>::infinity();
    const bool isGroundAlone = objects_.size() == 1 && !look.transfer && !look.tileBounds &&
                               !look.pageBounds &&
                               frameData.shading != fabric::Shading::Wireframe &&
                               objects_[0].object.kind == fabric::ObjectKind::Terrain;
    const fabric::Frustum channel = lod::subFrustum(view, reach(frameData, task.pixelViewport));
    double worst = 0;
    for (const OpenObject& open : objects_) {
        const lod::ObjectView objectView(view, drawnWorldFromObject(open.object, look));
        occlusion::HiddenGround hidden(objectView, covered, [this](const auto& part, auto& depth) {
            framebuffer_.readDepth(part, depth);
        });
        const double pixels =
            open.drawable->errorPixels({objectView, channel, task.range, frameData.tauPixels,
                                        task.completeness, look.exaggeration, look.pageBounds},
                                       isGroundAlone ? &hidden : nullptr);
        worst = std::max(worst, pixels);
    }
    return worst;
}

absl::Status Renderer::Impl::drawPieces(const draw::OccludedDraw::Pieces& pieces,
                                        const draw::FrameState& frame,
                                        fabric::FrameStatistics& statistics) {
    std::vector<draw::Piece> run;
    std::uint64_t triangles = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        run.push_back(pieces[i]->piece);
        triangles += run.back().triangles;
        statistics.nodes += run.back().isNode ? 1 : 0;
        const bool isBatch = triangles >= kTrianglesABatch;
        if (!isBatch && i + 1 < pieces.size() && pieces[i + 1]->object == pieces[i]->object)
            continue;
        RETURN_IF_ERROR(objects_[pieces[i]->object].drawable->draw(run, frame, statistics));
        run.clear();
        if (isBatch) {
            glFlush();
            triangles = 0;
        }
    }
    return absl::OkStatus();
}

/// Tested against the opaque surfaces' depth, which stays: what is not opaque has none.
absl::Status Renderer::Impl::drawBlended(std::span<const draw::OrderedPiece> pieces,
                                         draw::FrameState frame,
                                         fabric::FrameStatistics& statistics) {
    if (pieces.empty())
        return absl::OkStatus();
    frame.layer = draw::Layer::Blended;
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    absl::Status drawn;
    for (std::size_t i = 0; i < pieces.size() && drawn.ok(); ++i)
        drawn = objects_[pieces[i].object].drawable->draw(std::span(&pieces[i].piece, 1), frame,
                                                          statistics);
    passState(frame.shading).apply();
    return drawn;
}

/// Lines hide nothing, and are drawn with the piece they belong to, hidden or not.
absl::Status Renderer::Impl::drawSelection(const Selection& selection, const lod::View& view,
                                           const fabric::FrameData& frameData,
                                           const fabric::ChannelTask& task,
                                           fabric::FrameStatistics& statistics) {
    RETURN_IF_ERROR(framebuffer_.resize(task.viewWidth, task.viewHeight));
    const draw::FrameState frame{view,           *scene_,    frameData.shading,
                                 frameData.look, task.range, task.pixelViewport};
    drawn_.clear();
    RETURN_IF_ERROR(occludedDraw_.draw(
        {view, selection.worldFromObject,
         [&](const draw::OrderedPiece& one) {
             return objects_[one.object].drawable->partBounds(one.piece);
         },
         task.pixelViewport, selection.covered, task.range, scene_->background,
         passState(frameData.shading), framebuffer_},
        selection.pieces, hasLines(frameData) ? fabric::Occlusion::Off : frameData.occlusion,
        [&](const draw::OccludedDraw::Pieces& pieces, fabric::FrameStatistics& drawn) {
            if (task.measuresStages)
                drawn_.push_back(pieces);
            return drawPieces(pieces, frame, drawn);
        },
        statistics));
    RETURN_IF_ERROR(drawBlended(selection.blended, frame, statistics));
    glFinish();
    return absl::OkStatus();
}

/// Draws what the frame drew once more, into a single pixel: a driver may leave out vertices that
/// it knows to make no pixels at all. The picture is spoilt.
absl::Status Renderer::Impl::measureStages(const Selection& selection, const lod::View& view,
                                           const fabric::FrameData& frameData,
                                           const fabric::ChannelTask& task,
                                           fabric::StageMilliseconds& milliseconds) {
    const fabric::PixelViewport pixel{selection.covered.x, selection.covered.y, 1, 1};
    const draw::FrameState frame{view,           *scene_,    frameData.shading,
                                 frameData.look, task.range, pixel};
    framebuffer_.begin(view.width, view.height, pixel, scene_->background);
    passState(frameData.shading).apply();
    glFinish();
    const auto start = Clock::now();
    fabric::FrameStatistics ignored;
    for (const draw::OccludedDraw::Pieces& pieces : drawn_)
        RETURN_IF_ERROR(drawPieces(pieces, frame, ignored));
    RETURN_IF_ERROR(drawBlended(selection.blended, frame, ignored));
    glFinish();
    milliseconds.vertices = std::min(millisecondsSince(start), milliseconds.draw);
    milliseconds.fill = milliseconds.draw - milliseconds.vertices;
    return absl::OkStatus();
}

absl::StatusOr<fabric::ChannelResult> Renderer::Impl::render(const fabric::FrameData& asked,
                                                             const fabric::ChannelTask& task) {
    if (!scene_)
        return absl::FailedPreconditionError("no scene is open; open one before rendering");
    RETURN_IF_ERROR(validateTask(asked, task));
    fabric::ChannelResult result;
    fabric::FrameStatistics& statistics = result.statistics;
    statistics.tauAskedPixels = asked.tauPixels;
    const auto start = Clock::now();
    terrainPrograms_.reloadChanged(start);
    meshPrograms_.reloadChanged(start);

    const lod::View view(asked.camera, task.viewWidth, task.viewHeight);
    const fabric::FrameData frameData = withinBudget(view, asked, task, statistics);
    const Selection selection = selectPieces(view, frameData, task, statistics);
    statistics.milliseconds.cull = millisecondsSince(start);

    const auto drawStart = Clock::now();
    RETURN_IF_ERROR(drawSelection(selection, view, frameData, task, statistics));
    statistics.milliseconds.draw = millisecondsSince(drawStart);

    const auto readStart = Clock::now();
    result.image = framebuffer_.read(selection.covered, task.wantsDepth);
    statistics.milliseconds.readback = millisecondsSince(readStart);
    const auto errorStart = Clock::now();
    statistics.tauAchievedPixels = errorPixels(view, frameData, task, selection.covered);
    statistics.milliseconds.cull += millisecondsSince(errorStart);
    statistics.milliseconds.total = millisecondsSince(start);
    if (task.measuresStages)
        RETURN_IF_ERROR(measureStages(selection, view, frameData, task, statistics.milliseconds));
    return result;
}

RendererMemory Renderer::Impl::memory() const {
    RendererMemory sum;
    for (const OpenObject& object : objects_) {
        const draw::MemoryUse use = object.drawable->memory();
        sum.deviceBytes += use.deviceBytes;
        sum.hostBytes += use.hostBytes;
    }
    return sum;
}

absl::StatusOr<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
    ASSIGN_OR_RETURN(auto impl, Impl::create(options));
    return std::unique_ptr<Renderer>(new Renderer(std::move(impl)));
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;

const fabric::DeviceInfo& Renderer::device() const { return impl_->device(); }

absl::StatusOr<fabric::SceneInfo> Renderer::openScene(const fabric::Scene& scene) {
    return impl_->openScene(scene);
}

absl::StatusOr<fabric::ChannelResult> Renderer::render(const fabric::FrameData& frameData,
                                                       const fabric::ChannelTask& task) {
    return impl_->render(frameData, task);
}

RendererMemory Renderer::memory() const { return impl_->memory(); }

}  // namespace eyrie
