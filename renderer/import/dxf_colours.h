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
/// white, whichever is seen, and stands for no colour here, as a block's does for what is in it.
class DxfColours {
public:
    explicit DxfColours(std::string_view dxf);

    /// Whether anything is drawn that says its colour, or that of its layer is known.
    bool areAny() const { return areAny_; }
    /// As displayed; grey where it has none.
    fabric::Rgba of(const DxfRecord& entity) const;

private:
    std::map<std::string_view, fabric::Rgba> ofLayers_;
    bool areAny_ = false;
};

/// The name of a layer that stands for a colour. Assimp gives it to the mesh of what is on it.
std::string dxfLayerOf(const fabric::Rgba& colour);

/// Nothing for other layers.
std::optional<fabric::Rgba> colourOfDxfLayer(std::string_view layer);

}  // namespace eyrie::import
