// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dxf_colours.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdlib>

#include <fmt/format.h>

namespace eyrie::import {
namespace {

constexpr int kLayer = 8, kIndex = 62, kTrueColour = 420;
constexpr int kByLayer = 256;
constexpr fabric::Rgba kGrey{153, 153, 153, 255};  // Assimp's where there is none
constexpr std::string_view kMark = "$colour ";

fabric::Rgba colourFrom(std::uint32_t rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8),
            static_cast<std::uint8_t>(rgb), 255};
}

/// Of 10 to 249: 24 hues, each in five shades, and these mixed with white. Within one step of the
/// table that programs have.
fabric::Rgba shadeOf(int index) {
    constexpr std::array kMost = {255, 189, 129, 104, 79};
    constexpr int kHues = 24, kSixth = kHues / 6;
    const int hue = index / 10 - 1;
    const int most = kMost[static_cast<std::size_t>(index % 10 / 2)];
    const int least = index % 2 == 0 ? 0 : most * 2 / 3;
    const auto partOf = [&](int peak) {  // 4 up to a sixth of the circle from there, 0 from a third
        const int away = std::abs((hue - peak + kHues + kHues / 2) % kHues - kHues / 2);
        const int part = std::clamp(2 * kSixth - away, 0, kSixth);
        return static_cast<std::uint8_t>(least + (most - least) * part / kSixth);
    };
    return {partOf(0), partOf(2 * kSixth), partOf(4 * kSixth), 255};
}

std::optional<fabric::Rgba> colourOf(int index) {
    constexpr std::array<std::uint32_t, 10> kFirst = {
        0, 0xFF0000, 0xFFFF00, 0x00FF00, 0x00FFFF, 0x0000FF, 0xFF00FF, 0, 0x414141, 0x808080};
    constexpr std::array<std::uint32_t, 6> kGreys = {0x333333, 0x505050, 0x696969,
                                                     0x828282, 0xBEBEBE, 0xFFFFFF};
    constexpr int kFirstShade = 10, kFirstGrey = 250, kWhiteOrBlack = 7;
    if (index <= 0 || index == kWhiteOrBlack || index >= kByLayer)
        return std::nullopt;
    if (index < kFirstShade)
        return colourFrom(kFirst[static_cast<std::size_t>(index)]);
    if (index < kFirstGrey)
        return shadeOf(index);
    return colourFrom(kGreys[static_cast<std::size_t>(index - kFirstGrey)]);
}

/// What a record itself says. The number of a layer that is not shown is below 0.
std::optional<fabric::Rgba> ownColourOf(const DxfRecord& record) {
    constexpr std::uint32_t kNone = 1U << 24;
    if (const std::uint32_t rgb = dxfNumberOf(record.value(kTrueColour), kNone); rgb < kNone)
        return colourFrom(rgb);
    const int index = dxfNumberOf(record.value(kIndex), kByLayer);
    return colourOf(index < 0 && index > -kByLayer ? -index : index);
}

bool isByLayer(const DxfRecord& entity) {
    return dxfNumberOf(entity.value(kIndex), kByLayer) == kByLayer &&
           entity.value(kTrueColour).empty();
}

}  // namespace

DxfColours::DxfColours(std::string_view dxf) {
    constexpr std::array<std::string_view, 1> kTables = {"TABLES"};
    forEachDxfRecord(dxf, kTables, [&](const DxfRecord& record) {
        constexpr int kName = 2;
        if (record.kind != "LAYER")
            return;
        if (const auto colour = ownColourOf(record))
            ofLayers_[record.value(kName)] = *colour;
    });
    forEachDxfRecord(dxf, kDxfDrawn, [&](const DxfRecord& record) {
        areAny_ = areAny_ || !record.value(kIndex).empty() || !record.value(kTrueColour).empty() ||
                  ofLayers_.contains(record.value(kLayer));
        if (record.kind == "INSERT" && record.section == "ENTITIES")
            inherit(record);
    });
}

fabric::Rgba DxfColours::ofLayer(const DxfRecord& entity) const {
    const auto layer = ofLayers_.find(entity.value(kLayer));
    return layer == ofLayers_.end() ? kGrey : layer->second;
}

fabric::Rgba DxfColours::outsideOfBlocks(const DxfRecord& entity) const {
    return isByLayer(entity) ? ofLayer(entity) : ownColourOf(entity).value_or(kGrey);
}

void DxfColours::inherit(const DxfRecord& insert) {
    constexpr int kBlock = 2;
    const fabric::Rgba own = outsideOfBlocks(insert), layer = ofLayer(insert);
    const auto [known, isNew] = ofBlocks_.try_emplace(insert.value(kBlock), Inherited{own, layer});
    if (!isNew && known->second.own != own)
        known->second.own.reset();
    if (!isNew && known->second.ofLayer != layer)
        known->second.ofLayer.reset();
}

/// Null where its colour is its own, or its layer's.
const std::optional<fabric::Rgba>* DxfColours::inherited(const DxfRecord& entity,
                                                         std::string_view block) const {
    const auto inserted = ofBlocks_.find(block);
    const std::string_view layer = entity.value(kLayer);
    if (block.empty() || inserted == ofBlocks_.end())
        return nullptr;
    if (isByLayer(entity))
        return layer.empty() || layer == "0" ? &inserted->second.ofLayer : nullptr;
    const bool isByBlock =
        entity.value(kTrueColour).empty() && dxfNumberOf(entity.value(kIndex), -1) == 0;
    return isByBlock ? &inserted->second.own : nullptr;
}

fabric::Rgba DxfColours::of(const DxfRecord& entity, std::string_view block) const {
    const std::optional<fabric::Rgba>* const taken = inherited(entity, block);
    return taken != nullptr ? taken->value_or(kGrey) : outsideOfBlocks(entity);
}

bool DxfColours::areSeveral(const DxfRecord& entity, std::string_view block) const {
    const std::optional<fabric::Rgba>* const taken = inherited(entity, block);
    return taken != nullptr && !taken->has_value();
}

std::string dxfLayerOf(const fabric::Rgba& colour) {
    return fmt::format("{}{:02x}{:02x}{:02x}", kMark, colour.r, colour.g, colour.b);
}

std::optional<fabric::Rgba> colourOfDxfLayer(std::string_view layer) {
    constexpr std::size_t kDigits = 6;
    if (!layer.starts_with(kMark) || layer.size() != kMark.size() + kDigits)
        return std::nullopt;
    std::uint32_t rgb = 0;
    constexpr int kHexadecimal = 16;
    std::from_chars(layer.data() + kMark.size(), layer.data() + layer.size(), rgb, kHexadecimal);
    return colourFrom(rgb);
}

}  // namespace eyrie::import
