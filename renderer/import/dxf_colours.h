// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "fabric/image.h"
#include "renderer/import/dxf_records.h"

namespace eyrie::import {

/// The colours of a DXF file's entities: their own, or those of their layers, as red, green and
/// blue or as numbers of AutoCAD's table, of which Assimp 5.2 has another. Number 7 is black or
/// white, whichever is seen, and stands for no colour here.
///
/// In blocks the colour BYBLOCK, and that of the layer "0", are those of what inserts the block,
/// where all that do have the same.
class DxfColours {
public:
    explicit DxfColours(std::string_view dxf);

    /// Whether anything is drawn that says its colour, or that of its layer is known.
    bool areAny() const { return areAny_; }
    /// As displayed, of an entity in the block called so, or in none; grey where it has none.
    fabric::Rgba of(const DxfRecord& entity, std::string_view block) const;
    /// Whether it has several by this, as what inserts its block has.
    bool areSeveral(const DxfRecord& entity, std::string_view block) const;

private:
    /// What a block is inserted with; nothing where that is several.
    struct Inherited {
        std::optional<fabric::Rgba> own, ofLayer;
    };

    fabric::Rgba outsideOfBlocks(const DxfRecord& entity) const;
    fabric::Rgba ofLayer(const DxfRecord& entity) const;
    void inherit(const DxfRecord& insert);
    const std::optional<fabric::Rgba>* inherited(const DxfRecord& entity,
                                                 std::string_view block) const;

    std::map<std::string_view, Inherited> ofBlocks_;
    std::map<std::string_view, fabric::Rgba> ofLayers_;
    bool areAny_ = false;
};

/// The name of a layer that stands for a colour. Assimp gives it to the mesh of what is on it.
std::string dxfLayerOf(const fabric::Rgba& colour);

/// Nothing for other layers.
std::optional<fabric::Rgba> colourOfDxfLayer(std::string_view layer);

}  // namespace eyrie::import
