// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_look.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/gtc/matrix_inverse.hpp>

#include "renderer/draw/object_program.h"
#include "renderer/draw/tint.h"
#include "renderer/draw/transfer_table.h"

namespace eyrie::draw {
namespace {

/// Every fifth contour line is stronger.
constexpr int kLinesPerStrongOne = 5;

/// Of the colours of levels and ranges, in the ground's.
constexpr float kTintShare = 0.6F;
/// As in effects/terrain.effect.
constexpr float kLightened = 1.35F;

}  // namespace

TerrainLook::TerrainLook(const terrain::EytIndex& index)
    : index_(index),
      lowestMetres_(index.bounds().min.z),
      reliefMetres_(std::max(index.bounds().size().z, index.heightStepMetres())) {}

effects::TerrainEffect::Variant TerrainLook::variantFor(const FrameState& frame,
                                                        const fabric::Mat4& worldFromObject) {
    const fabric::Look& look = frame.look;
    effects::TerrainEffect::Variant variant;
    static_cast<effects::ObjectBlock::Variant&>(variant) =
        draw::variantFor(frame, fabric::exaggerated(worldFromObject, look.exaggeration));
    variant.transfer = look.transfer.has_value();
    variant.contours = look.contours.has_value();
    variant.adjusted = look.slopeShading != 1 || look.saturation != 1 || isTinted(frame);
    return variant;
}

void TerrainLook::use(const effects::TerrainEffect& program, const fabric::Mat4& worldFromObject,
                      const FrameState& frame) {
    const fabric::Look& look = frame.look;
    setSides(program, fabric::exaggerated(worldFromObject, look.exaggeration), frame);
    program.slopeShading(static_cast<float>(look.slopeShading));
    program.saturation(static_cast<float>(look.saturation));
    program.tintShare(look.levelTint || look.rangeTint ? kTintShare : frame.colour ? 1.0F : 0.0F);
    if (look.contours)
        setContours(program, *look.contours);
    if (look.transfer)
        setTransfer(program, *look.transfer);
}

/// The side that is seen is lit, but for two: lines have none, and where the eye is above all of
/// the ground a back is seen through its outer sides alone. Lines are lit on the side that faces
/// up, which of a mirror image that is upside down is the one that was below.
void TerrainLook::setSides(const effects::TerrainEffect& program,
                           const fabric::Mat4& worldFromGround, const FrameState& frame) const {
    const bool areLines = frame.shading == fabric::Shading::Wireframe;
    const fabric::Vec3 eye(glm::inverse(worldFromGround) * fabric::Vec4(frame.view.eye, 1));
    program.backSide(areLines || eye.z > index_.bounds().max.z ? 1.0F : -1.0F);
    const fabric::Mat3 worldFromNormal = glm::inverseTranspose(fabric::Mat3(worldFromGround));
    if (areLines && glm::determinant(worldFromNormal) < 0 && worldFromNormal[2].z < 0)
        program.worldFromNormal(-glm::mat3(worldFromNormal));
}

/// Grounds are drawn lighter than they are, and so are the colours of levels and ranges.
void TerrainLook::tint(const effects::TerrainEffect& program, const FrameState& frame, int level) {
    if (frame.look.levelTint)
        program.tintColour(kLightened * levelColour(level));
    else if (frame.look.rangeTint)
        program.tintColour(kLightened * rangeColour(frame.range));
    else if (frame.colour)
        program.tintColour(glm::vec3(*frame.colour));
}

/// Lines are counted from a height in the middle, so that float32 has digits left between them.
void TerrainLook::setContours(const effects::TerrainEffect& program,
                              const fabric::ContourLines& lines) const {
    const double step = index_.heightStepMetres();
    const double middle = lowestMetres_ + reliefMetres_ / 2 - index_.heightOriginMetres();
    const double base = std::round(middle / step);
    const double baseLine =
        std::fmod((base * step + index_.heightOriginMetres()) / lines.intervalMetres,
                  double{kLinesPerStrongOne});
    program.contourBase(static_cast<int>(base));
    program.linesPerHeight(static_cast<float>(step / lines.intervalMetres));
    program.baseLine(static_cast<float>(baseLine));
    program.lineWidth(static_cast<float>(lines.widthPixels));
}

void TerrainLook::setTransfer(const effects::TerrainEffect& program,
                              const fabric::TransferFunction& function) {
    if (tabled_ != function) {
        const std::vector<std::uint8_t> texels =
            transferTable(function, lowestMetres_, reliefMetres_);
        if (!tabled_) {
            glTextureStorage2D(table_.id(), 1, GL_RGBA8, kTransferTexels, 1);
            glTextureParameteri(table_.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
            glTextureParameteri(table_.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
            glTextureParameteri(table_.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
            glTextureParameteri(table_.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        }
        glTextureSubImage2D(table_.id(), 0, 0, 0, kTransferTexels, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                            texels.data());
        tabled_ = function;
    }
    program.transferTable(table_);
}

}  // namespace eyrie::draw
