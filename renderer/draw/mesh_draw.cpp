// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_draw.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "fabric/status.h"
#include "renderer/draw/box_lines.h"
#include "renderer/draw/depth_limit.h"
#include "renderer/draw/hidden_backs.h"
#include "renderer/draw/mesh_choice.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/draw/mesh_textures.h"
#include "renderer/draw/object_program.h"
#include "renderer/draw/tint.h"
#include "renderer/gl/object.h"
#include "renderer/lod/view.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/pick/mesh_surface.h"

namespace eyrie::draw {
namespace {

using Program = effects::MeshEffect;

std::uint32_t packedSrgb(const fabric::Vec3& linear) {
    const auto byte = [](double value) {
        return static_cast<std::uint32_t>(
            std::lround(std::sqrt(std::clamp(value, 0.0, 1.0)) * 255));
    };
    return byte(linear.x) | byte(linear.y) << 8 | byte(linear.z) << 16 | 0xFF000000U;
}

/// By how much a map stretches what it stretches most more than what it stretches least; 1 of maps
/// that keep angles.
double unevennessOf(const fabric::Mat3& map) {
    constexpr double kRounding = 1e-9;
    const double uneven = lod::largestStretch(map) * lod::largestStretch(glm::inverse(map));
    return uneven <= 1 + kRounding ? 1 : uneven;
}

/// The largest angle between normals `degrees` apart at most, or so on average, under a map as
/// uneven, which are mapped by its inverse transpose: largest where they lie on both sides of what
/// that stretches least. Of a mean, too, as it bends down (Jensen).
double mostUnder(double uneven, double degrees) {
    if (uneven == 1 || degrees == 0)
        return degrees;
    const double half = std::atan(uneven * std::tan(glm::radians(degrees) / 2));
    return std::isfinite(half) ? glm::degrees(2 * half) : 180;
}

/// Of a node's material, whose indices begin at `first`.
IndexRun runOf(const mesh::MaterialRange& range, GLsizei first) {
    return {first, static_cast<GLsizei>(range.indexCount),
            static_cast<GLsizei>(range.frontIndexCount)};
}

class MeshDrawable : public Drawable {
public:
    MeshDrawable(const fabric::SceneObject& object, MeshPrograms& programs,
                 PointPrograms& pointPrograms, std::shared_ptr<const mesh::EymFile> file,
                 MeshTextures textures, std::unique_ptr<MeshPaging> paging)
        : programs_(programs),
          worldFromObject_(object.worldFromObject),
          unevenness_(unevennessOf(fabric::Mat3(object.worldFromObject))),
          uniformColour_(packedSrgb(object.colour)),
          singleSided_(object.singleSided),
          file_(std::move(file)),
          lids_(file_->lids()),
          objectFromLattice_(file_->lattice().objectFromLattice()),
          textures_(std::move(textures)),
          points_(pointPrograms, *file_, object),
          choice_(file_, object, std::move(paging)) {
        defineVertexFormat();
    }

    fabric::Box bounds() const override { return file_->bounds(); }
    std::uint64_t triangles() const override { return file_->triangleCount(); }
    fabric::DataFile file() const override { return {file_->fileBytes(), file_->checksum()}; }

    std::unique_ptr<const pick::Surface> surface(const fabric::SceneObject& object) const override {
        return pick::meshSurface(object, file_);
    }

    std::uint64_t viewTriangles(const CutRequest& request) override {
        return choice_.viewTriangles(request);
    }
    double viewWork(const CutRequest& request) override { return choice_.viewWork(request); }
    Cut selectCut(const CutRequest& request) override {
        Cut cut = choice_.select(request);
        countDamagedImages(cut);
        return cut;
    }
    double errorPixels(const CutRequest&, occlusion::HiddenGround*) override {
        return choice_.errorPixels();
    }
    absl::Status draw(std::span<const Piece> pieces, const FrameState& frame,
                      fabric::FrameStatistics& statistics) override;
    fabric::FileLights lights() const override { return file_->lights(); }
    MemoryUse memory() const override {
        MemoryUse use = choice_.memory();
        use.deviceBytes += textures_.bytes();
        return use;
    }

private:
    void countDamagedImages(Cut& cut) const;
    void defineVertexFormat();
    void source(const DeviceNode& node) const;
    void bind(const FrameState& frame) const;
    void use(const Program& program, const FrameState& frame) const;
    std::uint32_t colourOf(const Piece& piece, const FrameState& frame) const;
    void colour(const Piece& piece, const FrameState& frame) const;
    int levelOf(std::uint32_t node) const;
    absl::Status drawWhole(std::span<const Piece> pieces, const FrameState& frame,
                           fabric::FrameStatistics& statistics);
    /// Programs of which the object is set.
    using Prepared = std::map<Program::Variant, const Program*>;
    absl::StatusOr<const Program*> prepare(const mesh::Material& material, const FrameState& frame,
                                           Prepared& prepared);
    absl::Status drawByMaterial(std::span<const Piece> pieces, const FrameState& frame,
                                fabric::FrameStatistics& statistics);
    absl::Status drawPoints(const Piece& piece, const FrameState& frame,
                            fabric::FrameStatistics& statistics);
    void drawSides(const SeenTriangles& triangles, const IndexRun& whole, const Piece& piece,
                   const FrameState& frame, const HiddenBacks& backs) const;
    void drawOpaque(const SeenTriangles& triangles, const IndexRun& run,
                    const mesh::Material& material, const Piece& piece,
                    const HiddenBacks& backs) const;
    void drawMaterial(const SeenTriangles& triangles, const IndexRun& run,
                      const mesh::Material& material, const Piece& piece,
                      const HiddenBacks& backs) const;
    SeenTriangles seenOf(const Piece& piece, const SeenBoxes& seen);

    MeshPrograms& programs_;
    fabric::Mat4 worldFromObject_;
    double unevenness_;  ///< of that
    std::uint32_t uniformColour_;
    bool singleSided_;
    std::shared_ptr<const mesh::EymFile> file_;
    std::vector<fabric::Box> lids_;
    fabric::Mat4 objectFromLattice_;
    MeshTextures textures_;
    gl::VertexArray vertexArray_;
    MeshPoints points_;
    BoxLines boxLines_;
    MeshChoice choice_;
};

/// Those that pieces have, as pages that cannot be read.
void MeshDrawable::countDamagedImages(Cut& cut) const {
    for (const std::int32_t image : textures_.damaged()) {
        const bool isMissing = std::ranges::any_of(cut.pieces, [&](const Piece& piece) {
            return std::ranges::any_of(file_->ranges(piece.index),
                                       [&](const mesh::MaterialRange& range) {
                                           return file_->materials()[range.material].image == image;
                                       });
        });
        cut.pagesMissing += isMissing ? 1 : 0;
        cut.pagesFailed += isMissing ? 1 : 0;
        cut.isComplete = cut.isComplete && !isMissing;
    }
}

void MeshDrawable::defineVertexFormat() {
    Program::kPackedPosition.define(vertexArray_);
    Program::kPackedNormal.define(vertexArray_);
    Program::kPackedColour.define(vertexArray_, file_->hasColours());
    Program::kPackedPlace.define(vertexArray_, file_->hasTextures());
}

void MeshDrawable::source(const DeviceNode& node) const {
    Program::kPackedPosition.source(vertexArray_, node.buffer, 0);
    Program::kPackedNormal.source(vertexArray_, node.buffer, node.normalOffset);
    if (file_->hasColours())
        Program::kPackedColour.source(vertexArray_, node.buffer, node.colourOffset);
    if (file_->hasTextures())
        Program::kPackedPlace.source(vertexArray_, node.buffer, node.placeOffset);
    glVertexArrayElementBuffer(vertexArray_.id(), node.buffer.id());
}

/// Colours that stand in for the mesh's own do so by an array that is not enabled.
void MeshDrawable::bind(const FrameState& frame) const {
    glFrontFace(glm::determinant(fabric::Mat3(worldFromObject_)) < 0 ? GL_CW : GL_CCW);
    glBindVertexArray(vertexArray_.id());
    if (file_->hasColours() && !isTinted(frame))
        glEnableVertexArrayAttrib(vertexArray_.id(), Program::kPackedColour.location);
    else
        glDisableVertexArrayAttrib(vertexArray_.id(), Program::kPackedColour.location);
}

void MeshDrawable::use(const Program& program, const FrameState& frame) const {
    program.use();
    bind(frame);
}

/// From the root down.
int MeshDrawable::levelOf(std::uint32_t node) const {
    int level = 0;
    const std::span<const mesh::Node> nodes = file_->nodes();
    for (std::uint32_t at = 0; at != node; ++level) {
        const auto right = static_cast<std::uint32_t>(nodes[at].right);
        at = node < right ? at + 1 : right;
    }
    return level;
}

/// In place of the mesh's own.
std::uint32_t MeshDrawable::colourOf(const Piece& piece, const FrameState& frame) const {
    if (frame.look.levelTint)
        return packedSrgb(fabric::Vec3(levelColour(levelOf(piece.index))));
    if (frame.look.rangeTint)
        return packedSrgb(fabric::Vec3(rangeColour(frame.range)));
    return frame.colour ? packedSrgb(*frame.colour) : uniformColour_;
}

void MeshDrawable::colour(const Piece& piece, const FrameState& frame) const {
    glVertexAttribI4ui(Program::kPackedColour.location, colourOf(piece, frame), 0, 0, 0);
}

absl::Status MeshDrawable::drawPoints(const Piece& piece, const FrameState& frame,
                                      fabric::FrameStatistics& statistics) {
    RETURN_IF_ERROR(points_.draw(piece, *choice_.node(piece.index), colourOf(piece, frame), frame));
    statistics.points += piece.points;
    return absl::OkStatus();
}

SeenTriangles MeshDrawable::seenOf(const Piece& piece, const SeenBoxes& seen) {
    return {*choice_.node(piece.index), piece.bounds, file_->lattice(), seen};
}

absl::Status MeshDrawable::drawWhole(std::span<const Piece> pieces, const FrameState& frame,
                                     fabric::FrameStatistics& statistics) {
    Program::Variant variant{variantFor(frame, worldFromObject_), {}};
    variant.gouraud = frame.shading == fabric::Shading::Gouraud;
    ASSIGN_OR_RETURN(const Program* program, programs_.find(variant));
    points_.begin();
    if (frame.look.tileBounds)
        RETURN_IF_ERROR(boxLines_.begin(frame.view, worldFromObject_));
    use(*program, frame);
    setObject(*program, frame, worldFromObject_, objectFromLattice_);
    const lod::ObjectView view(frame.view, worldFromObject_);
    const HiddenBacks backs(mayHideBacks(bounds(), frame, worldFromObject_), lids_, view,
                            frame.part);
    const SeenBoxes seen(view, frame);
    DepthLimit limit(view);
    for (const Piece& piece : pieces) {
        const DeviceNode* node = choice_.node(piece.index);
        const auto fronts = static_cast<GLsizei>(file_->nodes()[piece.index].frontIndexCount);
        if (piece.points > 0) {
            limit.lift();
            RETURN_IF_ERROR(drawPoints(piece, frame, statistics));
            use(*program, frame);
        } else {
            source(*node);
            colour(piece, frame);
            program->depthScale(limit.holdTo(piece.bounds));
            drawSides(seenOf(piece, seen), {0, node->indexCount, fronts}, piece, frame, backs);
            statistics.triangles += piece.triangles;
        }
        if (frame.look.tileBounds) {
            // At once, so that where depths tie the lower range wins as in compositing.
            limit.lift();
            boxLines_.draw(piece.bounds, levelColour(levelOf(piece.index)));
            use(*program, frame);
        }
    }
    return absl::OkStatus();
}

/// All of a piece in one colour, `whole` being its node's: with the sides that its materials have,
/// but for lines, which have none.
void MeshDrawable::drawSides(const SeenTriangles& triangles, const IndexRun& whole,
                             const Piece& piece, const FrameState& frame,
                             const HiddenBacks& backs) const {
    const std::span<const mesh::MaterialRange> ranges = file_->ranges(piece.index);
    if (ranges.empty() || frame.shading == fabric::Shading::Wireframe)
        return backs.draw(triangles, piece, whole.within(piece), singleSided_);
    GLsizei first = 0;
    for (const mesh::MaterialRange& range : ranges) {
        const IndexRun all = runOf(range, first);
        if (const IndexRun run = all.within(piece); run.count > 0)
            drawOpaque(triangles, run, file_->materials()[range.material], piece, backs);
        first += all.count;
    }
}

/// With the sides that a material has.
void MeshDrawable::drawOpaque(const SeenTriangles& triangles, const IndexRun& run,
                              const mesh::Material& material, const Piece& piece,
                              const HiddenBacks& backs) const {
    if (material.isOneSided())
        return drawIndices(triangles, {run.first, run.count, run.count});
    const bool hasOneSide = singleSided_ && !material.isTwoSided() && !material.isSeeThrough();
    backs.draw(triangles, piece, run, hasOneSide);
}

/// Of what is blended the far sides first: right by itself where a piece is convex.
void MeshDrawable::drawMaterial(const SeenTriangles& triangles, const IndexRun& run,
                                const mesh::Material& material, const Piece& piece,
                                const HiddenBacks& backs) const {
    if (!material.isBlended())
        return drawOpaque(triangles, run, material, piece, backs);
    const IndexRun oneSide{run.first, run.count, run.count};
    if (!material.isOneSided()) {
        glCullFace(GL_FRONT);
        drawIndices(triangles, oneSide);
        glCullFace(GL_BACK);
    }
    drawIndices(triangles, oneSide);
}

/// Uses the program that draws a material.
absl::StatusOr<const Program*> MeshDrawable::prepare(const mesh::Material& material,
                                                     const FrameState& frame, Prepared& prepared) {
    Program::Variant variant{variantFor(frame, worldFromObject_), {}};
    variant.gouraud = frame.shading == fabric::Shading::Gouraud;
    variant.textured = !material.hasImage() ? 0 : frame.view.step == fabric::Vec2(1) ? 1 : 2;
    variant.seeThrough = material.isBlended() ? 2 : material.alphaCutoff > 0 ? 1 : 0;
    const auto [at, isNew] = prepared.try_emplace(variant, nullptr);
    const Program*& program = at->second;
    if (isNew) {
        ASSIGN_OR_RETURN(program, programs_.find(variant));
    }
    program->use();
    if (isNew)
        setObject(*program, frame, worldFromObject_, objectFromLattice_);
    if (material.hasImage())
        program->picture(textures_.texture(material.image));
    if (material.alphaCutoff > 0)
        program->alphaCutoff(material.alphaCutoff);
    return program;
}

absl::Status MeshDrawable::drawByMaterial(std::span<const Piece> pieces, const FrameState& frame,
                                          fabric::FrameStatistics& statistics) {
    Prepared prepared;
    points_.begin();
    const lod::ObjectView view(frame.view, worldFromObject_);
    const HiddenBacks backs(mayHideBacks(bounds(), frame, worldFromObject_), lids_, view,
                            frame.part);
    const SeenBoxes seen(view, frame);
    DepthLimit limit(view);
    const bool hasBoxes = frame.look.tileBounds && frame.layer == Layer::Opaque;
    if (hasBoxes)
        RETURN_IF_ERROR(boxLines_.begin(frame.view, worldFromObject_));
    bind(frame);
    glVertexAttribI4ui(Program::kPackedColour.location, uniformColour_, 0, 0, 0);
    for (const Piece& piece : pieces) {
        const DeviceNode& node = *choice_.node(piece.index);
        if (piece.points == 0) {
            source(node);
        } else if (frame.layer == Layer::Opaque) {
            limit.lift();
            RETURN_IF_ERROR(drawPoints(piece, frame, statistics));
            bind(frame);
            glVertexAttribI4ui(Program::kPackedColour.location, uniformColour_, 0, 0, 0);
        }
        const SeenTriangles triangles = seenOf(piece, seen);
        GLsizei first = 0;
        for (const mesh::MaterialRange& range : file_->ranges(piece.index)) {
            const mesh::Material& material = file_->materials()[range.material];
            const IndexRun all = runOf(range, first);
            const IndexRun run = all.within(piece);
            if (material.isBlended() == (frame.layer == Layer::Blended) && run.count > 0) {
                ASSIGN_OR_RETURN(const Program* program, prepare(material, frame, prepared));
                program->depthScale(limit.holdTo(piece.bounds));
                drawMaterial(triangles, run, material, piece, backs);
                statistics.triangles += static_cast<std::uint64_t>(run.count / 3);
            }
            first += all.count;
        }
        if (hasBoxes) {
            limit.lift();
            boxLines_.draw(piece.bounds, levelColour(levelOf(piece.index)));
            bind(frame);
        }
    }
    return absl::OkStatus();
}

absl::Status MeshDrawable::draw(std::span<const Piece> pieces, const FrameState& frame,
                                fabric::FrameStatistics& statistics) {
    for (const Piece& piece : pieces) {
        const mesh::Node& node = file_->nodes()[piece.index];
        statistics.normalErrorDegrees = std::max(statistics.normalErrorDegrees,
                                                 mostUnder(unevenness_, node.normalErrorDegrees));
        statistics.normalErrorMeanDegrees = std::max(
            statistics.normalErrorMeanDegrees, mostUnder(unevenness_, node.normalErrorMeanDegrees));
    }
    const bool isWhole = file_->materials().empty() ||
                         frame.shading == fabric::Shading::Wireframe || isTinted(frame);
    if (!isWhole)
        return drawByMaterial(pieces, frame, statistics);
    return frame.layer == Layer::Opaque ? drawWhole(pieces, frame, statistics) : absl::OkStatus();
}

}  // namespace

/// Textures may take half: where they have all of their levels, as much again is for the rest.
MemoryUse greatestUse(const mesh::EymFile& file, TextureFormat format) {
    MemoryUse use = MeshPaging::greatestUse(file);
    use.deviceBytes += 2 * MeshTextures::allBytes(file, format);
    return use;
}

absl::StatusOr<std::unique_ptr<Drawable>> openMesh(const fabric::SceneObject& object,
                                                   std::shared_ptr<const mesh::EymFile> file,
                                                   MeshPrograms& programs,
                                                   PointPrograms& pointPrograms,
                                                   page::Loader& loader, const MeshMemory& memory,
                                                   TextureFormat format) {
    ASSIGN_OR_RETURN(MeshTextures textures,
                     MeshTextures::read(*file, memory.deviceBytes / 2, format));
    if (textures.bytes() > memory.deviceBytes)
        return absl::ResourceExhaustedError(fmt::format(
            "{}: its textures' coarsest levels need {} bytes on the device, and its share of "
            "memory there is {}; raise --memory, or open fewer objects",
            object.path, textures.bytes(), memory.deviceBytes));
    ASSIGN_OR_RETURN(
        auto paging,
        MeshPaging::open(file, loader, {memory.deviceBytes, memory.hostBytes, textures.bytes()}));
    return std::make_unique<MeshDrawable>(object, programs, pointPrograms, std::move(file),
                                          std::move(textures), std::move(paging));
}

}  // namespace eyrie::draw
