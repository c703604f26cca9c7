// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "effects/terrain_effect.h"
#include "fabric/look.h"
#include "renderer/draw/drawable.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

/// Takes a frame's look to the terrain effect: which variant draws it, and its uniforms. Of one
/// terrain; GL thread.
class TerrainLook {
public:
    explicit TerrainLook(const terrain::EytIndex& index);

    /// What is not in the frame's look is not compiled in.
    static effects::TerrainEffect::Variant variantFor(const FrameState& frame,
                                                      const fabric::Mat4& worldFromObject);

    /// Sets the uniforms of the look, after setObject. `worldFromObject` is not exaggerated. Of a
    /// transfer function it keeps the table.
    void use(const effects::TerrainEffect& program, const fabric::Mat4& worldFromObject,
             const FrameState& frame);

    /// Sets the colour that stands in for that of a tile, where one does.
    static void tint(const effects::TerrainEffect& program, const FrameState& frame, int level);

private:
    void setSides(const effects::TerrainEffect& program, const fabric::Mat4& worldFromGround,
                  const FrameState& frame) const;
    void setContours(const effects::TerrainEffect& program,
                     const fabric::ContourLines& lines) const;
    void setTransfer(const effects::TerrainEffect& program,
                     const fabric::TransferFunction& function);

    const terrain::EytIndex& index_;
    double lowestMetres_;
    double reliefMetres_;
    std::optional<fabric::TransferFunction> tabled_;
    gl::Texture2D table_;
};

}  // namespace eyrie::draw
