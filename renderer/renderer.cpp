// SPDX-License-Identifier: Apache-2.0
#include "renderer/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stop_token>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "effects/object_block.h"
#include "fabric/scene_reach.h"
#include "fabric/status.h"
#include "renderer/draw/batches.h"
#include "renderer/draw/budget_choice.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/memory_shares.h"
#include "renderer/draw/mesh_draw.h"
#include "renderer/draw/occluded_draw.h"
#include "renderer/draw/open_object.h"
#include "renderer/draw/scene_lights.h"
#include "renderer/draw/selection.h"
#include "renderer/draw/terrain_draw.h"
#include "renderer/draw/view_turns.h"
#include "renderer/gl/debug_output.h"
#include "renderer/gl/egl_context.h"
#include "renderer/gl/framebuffer.h"
#include "renderer/lod/view.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/page/loader.h"
#include "renderer/page/remote_name.h"
#include "renderer/pick/picker.h"
#include "renderer/task_check.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie {
namespace {

using Clock = std::chrono::steady_clock;

using TerrainFile = std::shared_ptr<const terrain::EytFile>;
using MeshFile = std::shared_ptr<const mesh::EymFile>;
/// An object's, open.
using ObjectFile = std::variant<TerrainFile, MeshFile>;

absl::Status unlessStopped(const std::stop_token& stop) {
    return stop.stop_requested() ? absl::CancelledError("nobody wants this picture any more")
                                 : absl::OkStatus();
}

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

const gl::PassState& passState(fabric::Shading shading) {
    return shading == fabric::Shading::Wireframe ? effects::ObjectBlock::kWireframe
                                                 : effects::ObjectBlock::kSolid;
}

/// What is always in memory of an open file: its index, or its tables.
std::uint64_t memoryBytesOf(const ObjectFile& file) {
    if (const auto* terrain = std::get_if<TerrainFile>(&file))
        return (*terrain)->indexMemoryBytes();
    return std::get<MeshFile>(file)->tableMemoryBytes();
}

/// What the indices of terrains take in memory for as long as they are open.
std::uint64_t indexBytesOf(const std::vector<ObjectFile>& files) {
    std::uint64_t bytes = 0;
    for (const ObjectFile& file : files)
        if (const auto* terrain = std::get_if<TerrainFile>(&file))
            bytes += (*terrain)->indexMemoryBytes();
    return bytes;
}

/// How high the terrains among `objects` reach; null where there are none.
std::shared_ptr<const std::vector<fabric::GroundGrid>> groundOf(
    const std::vector<draw::OpenObject>& objects) {
    const auto terrains = std::count_if(objects.begin(), objects.end(), [](const auto& open) {
        return open.object.kind == fabric::ObjectKind::Terrain;
    });
    if (terrains == 0 || terrains > fabric::kMaxGroundCells)
        return nullptr;
    auto ground = std::make_shared<std::vector<fabric::GroundGrid>>();
    for (std::size_t i = 0; i < objects.size(); ++i)
        if (auto grid =
                objects[i].drawable->ground(fabric::kMaxGroundCells / static_cast<int>(terrains))) {
            grid->object = static_cast<std::int32_t>(i);
            ground->push_back(*std::move(grid));
        }
    return ground;
}

}  // namespace

class Renderer::Impl {
public:
    static absl::StatusOr<std::unique_ptr<Impl>> create(const RendererOptions& options);
    ~Impl() { context_->makeCurrent().IgnoreError(); }  // what is below goes with the context
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    const fabric::DeviceInfo& device() const { return context_->device(); }
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene);
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& asked,
                                                 const fabric::ChannelTask& task,
                                                 const fabric::Delivery& delivery);
    std::shared_ptr<const pick::Picker> picker() const { return picker_; }
    RendererMemory memory() const;

private:
    Impl(std::unique_ptr<gl::EglContext> context, const RendererOptions& options)
        : context_(std::move(context)),
          options_(options),
          decoding_(options.decoding),
          loader_({.threads = options.loaderThreads}),
          sources_(page::sourceOptions(options.remote.cacheFolder, options.remote.cacheBytes)) {}

    page::Loader& loaderFor(const fabric::SceneObject& object);
    absl::StatusOr<ObjectFile> openFile(const fabric::SceneObject& object,
                                        std::uint64_t limit) const;
    absl::StatusOr<std::vector<ObjectFile>> openFiles(const fabric::Scene& scene) const;
    std::vector<draw::MemoryUse> sharesOf(const std::vector<ObjectFile>& files,
                                          std::uint64_t hostBytes) const;
    absl::StatusOr<std::unique_ptr<draw::Drawable>> openObject(const fabric::SceneObject& object,
                                                               const ObjectFile& file,
                                                               const draw::MemoryUse& share);
    draw::TextureFormat textureFormat() const {
        return GLEW_EXT_texture_compression_s3tc && !device().software ? draw::TextureFormat::Bc1
                                                                       : draw::TextureFormat::Rgba8;
    }
    double errorPixels(const lod::TaskViews& views, const fabric::FrameData& frameData,
                       const fabric::ChannelTask& task, const fabric::PixelViewport& covered);
    absl::Status drawSelection(const draw::Selection& selection, const lod::View& view,
                               const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                               const fabric::Delivery& delivery,
                               fabric::FrameStatistics& statistics);
    absl::Status drawPieces(const draw::OccludedDraw::Pieces& pieces, const draw::FrameState& frame,
                            fabric::FrameStatistics& statistics);
    fabric::Image readBack(const fabric::PixelViewport& covered, bool withDepth,
                           const fabric::Delivery& delivery);
    absl::Status measureStages(const draw::Selection& selection, const lod::View& view,
                               const fabric::FrameData& frameData, const fabric::ChannelTask& task,
                               const std::stop_token& stop,
                               fabric::StageMilliseconds& milliseconds);
    absl::Status drawBlended(std::span<const draw::OrderedPiece> pieces, draw::FrameState frame,
                             fabric::FrameStatistics& statistics);

    std::unique_ptr<gl::EglContext> context_;  // first: everything below needs it current
    effects::EffectVariants<effects::TerrainEffect> terrainPrograms_;
    draw::MeshPrograms meshPrograms_;
    draw::PointPrograms pointPrograms_;
    gl::Framebuffer framebuffer_;
    draw::OccludedDraw occludedDraw_;
    draw::ViewTurns turns_;
    draw::Batches batches_;
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
    /// What the device had no memory for stays missing, and no error tells so again: until a scene
    /// is opened every picture fails with this.
    absl::Status incomplete_;
    std::uint64_t indexBytes_ = 0;  ///< of its terrains
    std::vector<draw::OpenObject> objects_;
    std::shared_ptr<const pick::Picker> picker_;
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

/// Of `limit` bytes its index or tables may take. What does not fit is told before all is read.
absl::StatusOr<ObjectFile> Renderer::Impl::openFile(const fabric::SceneObject& object,
                                                    std::uint64_t limit) const {
    if (object.kind == fabric::ObjectKind::Terrain)
        return terrain::EytFile::open(object.path, sources_, limit);
    ASSIGN_OR_RETURN(mesh::EymFile file, mesh::EymFile::open(object.path, sources_, limit));
    return std::make_shared<const mesh::EymFile>(std::move(file));
}

absl::StatusOr<std::vector<ObjectFile>> Renderer::Impl::openFiles(
    const fabric::Scene& scene) const {
    std::vector<ObjectFile> files;
    std::uint64_t left = options_.hostMemoryBytes;
    for (const fabric::SceneObject& object : scene.objects) {
        absl::StatusOr<ObjectFile> file = openFile(object, left);
        if (absl::IsResourceExhausted(file.status()))
            return absl::ResourceExhaustedError(fmt::format(
                "{}; the indices of the scene's files may take {} bytes of host memory: raise the "
                "limit (--host-memory of eyrie renderer), or open fewer or smaller files",
                std::string(file.status().message()), options_.hostMemoryBytes));
        RETURN_IF_ERROR(file.status());
        left -= memoryBytesOf(*file);
        files.push_back(*std::move(file));
    }
    return files;
}

/// By what the files can ever use: the same wherever textures are kept in the same format.
std::vector<draw::MemoryUse> Renderer::Impl::sharesOf(const std::vector<ObjectFile>& files,
                                                      std::uint64_t hostBytes) const {
    std::vector<std::uint64_t> onDevice;
    std::vector<std::uint64_t> onHost;
    for (const ObjectFile& file : files) {
        const draw::MemoryUse most = std::visit(
            [this](const auto& opened) { return draw::greatestUse(*opened, textureFormat()); },
            file);
        onDevice.push_back(most.deviceBytes);
        onHost.push_back(most.hostBytes);
    }
    onDevice = draw::memoryShares(options_.memoryBytes, onDevice);
    onHost = draw::memoryShares(hostBytes, onHost);
    std::vector<draw::MemoryUse> shares;
    for (std::size_t i = 0; i < files.size(); ++i) shares.push_back({onDevice[i], onHost[i]});
    return shares;
}

absl::StatusOr<std::unique_ptr<draw::Drawable>> Renderer::Impl::openObject(
    const fabric::SceneObject& object, const ObjectFile& file, const draw::MemoryUse& share) {
    if (const auto* terrain = std::get_if<TerrainFile>(&file))
        return draw::openTerrain(object, *terrain, terrainPrograms_, loaderFor(object),
                                 {share.deviceBytes, share.hostBytes}, textureFormat(), decoding_);
    return draw::openMesh(object, std::get<MeshFile>(file), meshPrograms_, pointPrograms_,
                          loaderFor(object), {share.deviceBytes, share.hostBytes}, textureFormat());
}

absl::StatusOr<fabric::SceneInfo> Renderer::Impl::openScene(const fabric::Scene& scene) {
    RETURN_IF_ERROR(context_->makeCurrent());
    RETURN_IF_ERROR(fabric::validate(scene));
    std::vector<draw::OpenObject> objects;
    std::vector<std::unique_ptr<const pick::Surface>> surfaces;
    fabric::SceneInfo info;
    ASSIGN_OR_RETURN(const std::vector<ObjectFile> files, openFiles(scene));
    const std::uint64_t indexBytes = indexBytesOf(files);
    const std::vector<draw::MemoryUse> shares =
        sharesOf(files, options_.hostMemoryBytes - indexBytes);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const fabric::SceneObject& object = scene.objects[i];
        ASSIGN_OR_RETURN(auto drawable, openObject(object, files[i], shares[i]));
        info.objects.push_back({fabric::transformed(drawable->bounds(), object.worldFromObject),
                                drawable->triangles()});
        RETURN_IF_ERROR(fabric::checkReach(object, info.objects.back().bounds));
        info.bounds.grow(info.objects.back().bounds);
        info.triangles += info.objects.back().triangles;
        info.files.push_back(drawable->file());
        info.bytes += info.files.back().bytes;
        surfaces.push_back(drawable->surface(object));
        objects.push_back({object, std::move(drawable)});
    }
    info.ground = groundOf(objects);
    indexBytes_ = indexBytes;
    incomplete_ = absl::OkStatus();
    scene_ = scene;
    objects_ = std::move(objects);
    picker_ = std::make_shared<const pick::Picker>(std::move(surfaces));
    occludedDraw_.forget();
    turns_.forget();
    return info;
}

/// What the finished picture promises. A frozen cut was chosen for another view. Hills hide what is
/// behind them where nothing is in the picture but one terrain, all of it opaque.
double Renderer::Impl::errorPixels(const lod::TaskViews& views, const fabric::FrameData& frameData,
                                   const fabric::ChannelTask& task,
                                   const fabric::PixelViewport& covered) {
    const fabric::Look& look = frameData.look;
    if (look.cutCamera)
        return std::numeric_limits<double>::infinity();
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < objects_.size(); ++i)
        if (!look.hidden.contains(i))
            shown.push_back(i);
    const bool isGroundAlone =
        shown.size() == 1 && !look.transfer && !look.tileBounds && !look.pageBounds &&
        look.objects.shadingOf(shown[0], frameData.shading) != fabric::Shading::Wireframe &&
        objects_[shown[0]].object.kind == fabric::ObjectKind::Terrain;
    const fabric::Frustum channel =
        lod::subFrustum(views.drawn, draw::reach(frameData, task.pixelViewport));
    double worst = 0;
    for (const std::size_t i : shown) {
        const draw::OpenObject& open = objects_[i];
        const fabric::Mat4 worldFromObject = draw::drawnWorldFromObject(open.object, look);
        const lod::ObjectView objectView(views.whole, worldFromObject);
        const lod::ObjectView drawnView(views.drawn, worldFromObject);
        occlusion::HiddenGround hidden(
            drawnView, covered, [this](const auto& part) { return framebuffer_.depth(part); },
            device().software ? occlusion::Reading::ByParts : occlusion::Reading::AllAtOnce);
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
    std::uint64_t triangles = 0;  // of the run
    const gl::PassState* state = &passState(frame.shading);
    const auto change = [&state](const gl::PassState& wanted) {
        if (std::exchange(state, &wanted) != &wanted)
            wanted.apply();
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        run.push_back(pieces[i]->piece);
        triangles += run.back().triangles;
        statistics.nodes += run.back().isNode ? 1 : 0;
        const bool isBatch = triangles >= draw::Batches::kTriangles;
        if (!isBatch && i + 1 < pieces.size() && pieces[i + 1]->object == pieces[i]->object)
            continue;
        RETURN_IF_ERROR(unlessStopped(frame.stop));
        const draw::FrameState own = draw::frameOf(frame, pieces[i]->object);
        change(passState(own.shading));
        RETURN_IF_ERROR(objects_[pieces[i]->object].drawable->draw(run, own, statistics));
        run.clear();
        batches_.add(std::exchange(triangles, 0));
    }
    change(passState(frame.shading));
    return absl::OkStatus();
}

/// Surfaces, never lines. Tested against the opaque surfaces' depth, which stays: what is not
/// opaque has none.
absl::Status Renderer::Impl::drawBlended(std::span<const draw::OrderedPiece> pieces,
                                         draw::FrameState frame,
                                         fabric::FrameStatistics& statistics) {
    if (pieces.empty())
        return absl::OkStatus();
    frame.layer = draw::Layer::Blended;
    effects::ObjectBlock::kSolid.apply();
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    absl::Status drawn;
    for (std::size_t i = 0; i < pieces.size() && drawn.ok(); ++i) {
        drawn = unlessStopped(frame.stop);
        if (drawn.ok())
            drawn = objects_[pieces[i].object].drawable->draw(
                std::span(&pieces[i].piece, 1), draw::frameOf(frame, pieces[i].object), statistics);
    }
    passState(frame.shading).apply();
    return drawn;
}

/// Lines hide nothing, and are drawn with the piece they belong to, hidden or not.
absl::Status Renderer::Impl::drawSelection(const draw::Selection& selection, const lod::View& view,
                                           const fabric::FrameData& frameData,
                                           const fabric::ChannelTask& task,
                                           const fabric::Delivery& delivery,
                                           fabric::FrameStatistics& statistics) {
    RETURN_IF_ERROR(framebuffer_.resize(view.width, view.height));
    const fabric::Lights lights = draw::lightsOf(*scene_, objects_, frameData.look);
    const draw::FrameState frame{view,
                                 lights,
                                 frameData.shading,
                                 frameData.look,
                                 task.range,
                                 task.pixelViewport,
                                 task.pixelViewport,
                                 draw::Layer::Opaque,
                                 delivery.stop};
    drawn_.clear();
    batches_.begin(delivery.nearlyDrawn != nullptr);
    RETURN_IF_ERROR(occludedDraw_.draw(
        {view, selection.worldFromObject,
         [&](const draw::OrderedPiece& one) {
             return objects_[one.object].drawable->partBounds(one.piece);
         },
         task.pixelViewport, selection.covered, task.range, scene_->background,
         passState(frameData.shading), framebuffer_},
        selection.pieces, draw::hasLines(frameData) ? fabric::Occlusion::Off : frameData.occlusion,
        [&](const draw::OccludedDraw::Pieces& pieces, fabric::FrameStatistics& drawn) {
            if (task.measuresStages)
                drawn_.push_back(pieces);
            return drawPieces(pieces, frame, drawn);
        },
        statistics));
    RETURN_IF_ERROR(drawBlended(selection.blended, frame, statistics));
    if (delivery.nearlyDrawn) {
        batches_.awaitMost();
        delivery.nearlyDrawn();
    }
    glFinish();
    return absl::OkStatus();
}

/// To where it is to go: less is copied.
fabric::Image Renderer::Impl::readBack(const fabric::PixelViewport& covered, bool withDepth,
                                       const fabric::Delivery& delivery) {
    const auto room =
        delivery.room && !covered.isEmpty() ? delivery.room(covered, withDepth) : std::nullopt;
    if (!room)
        return framebuffer_.read(covered, withDepth);
    framebuffer_.read(covered, *room);
    return {covered, {}, {}};
}

/// Draws what the frame drew once more, into a single pixel: a driver may leave out vertices that
/// it knows to make no pixels at all. The picture is spoilt.
absl::Status Renderer::Impl::measureStages(const draw::Selection& selection, const lod::View& view,
                                           const fabric::FrameData& frameData,
                                           const fabric::ChannelTask& task,
                                           const std::stop_token& stop,
                                           fabric::StageMilliseconds& milliseconds) {
    const fabric::PixelViewport pixel{selection.covered.x, selection.covered.y, 1, 1};
    const fabric::Lights lights = draw::lightsOf(*scene_, objects_, frameData.look);
    const draw::FrameState frame{view,       lights, frameData.shading,  frameData.look,
                                 task.range, pixel,  task.pixelViewport, draw::Layer::Opaque,
                                 stop};
    framebuffer_.begin(view.width, view.height, pixel, scene_->background);
    passState(frameData.shading).apply();
    glFinish();
    const auto start = Clock::now();
    batches_.begin(false);
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
                                                             const fabric::ChannelTask& task,
                                                             const fabric::Delivery& delivery) {
    RETURN_IF_ERROR(context_->makeCurrent());
    const std::stop_token& stop = delivery.stop;
    if (!scene_)
        return absl::FailedPreconditionError("no scene is open; open one before rendering");
    RETURN_IF_ERROR(incomplete_);
    RETURN_IF_ERROR(validateTask(asked, task));
    RETURN_IF_ERROR(unlessStopped(stop));
    fabric::ChannelResult result;
    fabric::FrameStatistics& statistics = result.statistics;
    statistics.tauAskedPixels = asked.tauPixels;
    const auto start = Clock::now();
    terrainPrograms_.reloadChanged(start);
    meshPrograms_.reloadChanged(start);
    pointPrograms_.reloadChanged(start);

    const lod::TaskViews views(asked.camera, task);
    const fabric::FrameData frameData =
        draw::withinBudget(objects_, views.whole, asked, task, statistics);
    const draw::ViewTurn turn = turns_.next(
        {draw::cutViewOf(frameData.look, task, views.whole), task.range, task.pixelViewport},
        task.completeness);
    const draw::Selection selection =
        draw::selectPieces(objects_, views, frameData, task, turn, statistics, stop);
    RETURN_IF_ERROR(unlessStopped(stop));
    statistics.milliseconds.cull = millisecondsSince(start);

    const auto drawStart = Clock::now();
    RETURN_IF_ERROR(drawSelection(selection, views.drawn, frameData, task, delivery, statistics));
    RETURN_IF_ERROR(unlessStopped(stop));
    statistics.milliseconds.draw = millisecondsSince(drawStart);

    const auto readStart = Clock::now();
    result.image = readBack(selection.covered, task.wantsDepth, delivery);
    statistics.milliseconds.readback = millisecondsSince(readStart);
    const auto errorStart = Clock::now();
    statistics.tauAchievedPixels = errorPixels(views, frameData, task, selection.covered);
    statistics.milliseconds.cull += millisecondsSince(errorStart);
    if (absl::Status met = gl::takeGlError(); !met.ok())
        return absl::IsResourceExhausted(met) ? incomplete_ = std::move(met) : met;
    statistics.milliseconds.total = millisecondsSince(start);
    if (task.measuresStages)
        RETURN_IF_ERROR(
            measureStages(selection, views.drawn, frameData, task, stop, statistics.milliseconds));
    return result;
}

RendererMemory Renderer::Impl::memory() const {
    RendererMemory sum{.hostBytes = indexBytes_};
    for (const draw::OpenObject& object : objects_) {
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
                                                       const fabric::ChannelTask& task,
                                                       const fabric::Delivery& delivery) {
    return impl_->render(frameData, task, delivery);
}

std::shared_ptr<const pick::Picker> Renderer::picker() const { return impl_->picker(); }

RendererMemory Renderer::memory() const { return impl_->memory(); }

}  // namespace eyrie
