// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "renderer/codec/bits.h"
#include "renderer/codec/rans.h"
#include "renderer/codec/symbol_shares.h"
#include "renderer/mesh/codec/normal_forecast.h"
#include "renderer/mesh/codec/page_codec.h"
#include "renderer/mesh/codec/page_model.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Symbols in the order of decoding, each with its context.
class SymbolList {
public:
    explicit SymbolList(std::size_t contexts) : counts_(contexts) {}

    void put(std::uint32_t context, std::uint32_t symbol) {
        ++counts_[context][symbol];
        symbols_.push_back(static_cast<std::uint16_t>(context << 8 | symbol));
    }

    void writeShares(codec::BitWriter& writer) {
        for (const auto& counts : counts_) {
            shares_.emplace_back(counts);
            shares_.back().write(writer);
        }
    }

    /// Precondition: writeShares was called.
    template <std::size_t kStates>
    std::vector<std::uint16_t> words() const {
        codec::RansEncoder<kStates> rans;
        for (std::size_t k = symbols_.size(); k-- > 0;)
            rans.put(k % kStates, shares_[symbols_[k] >> 8].of(symbols_[k] & 0xFF),
                     codec::kSymbolBits);
        return std::move(rans).finish();
    }

private:
    std::vector<std::array<std::uint32_t, 256>> counts_;
    std::vector<std::uint16_t> symbols_;
    std::vector<codec::SymbolShares> shares_;
};

class PageEncoder {
public:
    explicit PageEncoder(const NodeGeometry& geometry)
        : geometry_(geometry),
          triangles_(kTriangleContexts),
          vertices_(numbersOf(!geometry.colours.empty(), !geometry.textureCoordinates.empty())),
          origins_(geometry.positions.size()) {}

    std::vector<std::byte> run();

private:
    struct Rest {
        std::uint32_t bits;
        int count;
    };

    void putNumber(SymbolList& list, std::uint32_t context, std::uint32_t number,
                   std::uint32_t firstSymbol = 0) {
        const NumberCode code = codeOf(number);
        list.put(context, firstSymbol + code.symbol);
        if (code.restBits > 0)
            rests_.push_back({number & ((1U << code.restBits) - 1), code.restBits});
    }

    void addLoose(std::span<const std::uint16_t, 3> corners);
    void addThird(std::uint32_t age, const OpenEdge& edge, std::uint16_t corner);
    void addTriangles();
    void addVertices();
    void addColour(std::uint32_t v, std::uint32_t& context);
    void addTextureCoordinates(std::uint32_t v, std::uint32_t& context);

    const NodeGeometry& geometry_;
    SymbolList triangles_;
    SymbolList vertices_;
    std::vector<Rest> rests_;
    std::vector<Origin> origins_;
    OpenEdges edges_;
    std::uint32_t seen_ = 0;  ///< vertices
};

void PageEncoder::addLoose(std::span<const std::uint16_t, 3> corners) {
    originsOfLoose(corners, seen_,
                   [this](std::uint16_t vertex, const Origin& from) { origins_[vertex] = from; });
    for (const std::uint16_t corner : corners) {
        putNumber(triangles_, kLooseCorner, seen_ - corner);
        seen_ += corner == seen_ ? 1 : 0;
    }
    edges_.openAll(corners);
}

void PageEncoder::addThird(std::uint32_t age, const OpenEdge& edge, std::uint16_t corner) {
    const bool isNew = corner == seen_;
    const ThirdCorner third = edges_.join(edge, corner, isNew);
    if (third == ThirdCorner::IsElsewhere)
        putNumber(triangles_, thirdContext(age), seen_ - corner, kElsewhere);
    else
        triangles_.put(thirdContext(age), static_cast<std::uint32_t>(third));
    if (isNew)
        origins_[seen_++] = {edge.from, edge.to, edge.opposite};
}

void PageEncoder::addTriangles() {
    if (geometry_.indices.empty())
        originsOfPoints(origins_);
    for (std::size_t i = 0; i < geometry_.indices.size(); i += 3) {
        const std::span<const std::uint16_t, 3> corners(geometry_.indices.data() + i, 3);
        std::uint32_t turn = 0;
        const std::uint32_t age = edges_.find(corners, turn);
        if (age == OpenEdges::kNone) {
            triangles_.put(kMetEdge, 3 * OpenEdges::kReach);
            addLoose(corners);
            continue;
        }
        triangles_.put(kMetEdge, 3 * age + turn);
        const OpenEdge edge = edges_.at(age);
        edges_.close(age);
        addThird(age, edge, corners[(turn + 2) % 3]);
    }
}

void PageEncoder::addVertices() {
    std::vector<std::uint32_t> forecast(geometry_.normals.size());
    if (geometry_.indices.empty())
        std::copy(geometry_.normals.begin(), geometry_.normals.end() - 1, forecast.begin() + 1);
    else
        forecastNormals(geometry_.positions, geometry_.indices, forecast);
    const auto position = [this](std::uint32_t v) {
        return unpackPosition(geometry_.positions[v]);
    };
    for (std::uint32_t v = 0; v < geometry_.positions.size(); ++v) {
        const Origin& from = origins_[v];
        std::uint32_t context = 0;
        const glm::uvec3 guess =
            v == 0 ? glm::uvec3(0U)
                   : foreseen(position(from.a), position(from.b), position(from.opposite));
        const glm::uvec3 left = position(v) - guess;
        for (int axis = 0; axis < 3; ++axis)
            putNumber(vertices_, context++, zigzag(wrapped<kLatticeBits>(left[axis])));
        for (const int shift : {0, 16})
            putNumber(
                vertices_, context++,
                zigzag(wrapped<16>((geometry_.normals[v] >> shift) - (forecast[v] >> shift))));
        if (!geometry_.colours.empty())
            addColour(v, context);
        if (!geometry_.textureCoordinates.empty())
            addTextureCoordinates(v, context);
    }
}

void PageEncoder::addColour(std::uint32_t v, std::uint32_t& context) {
    const Origin& from = origins_[v];
    const std::uint32_t mean =
        v == 0 ? 0 : meanColour(geometry_.colours[from.a], geometry_.colours[from.b]);
    for (const int shift : {0, 8, 16, 24})
        putNumber(vertices_, context++,
                  zigzag(wrapped<8>((geometry_.colours[v] >> shift) - (mean >> shift))));
}

void PageEncoder::addTextureCoordinates(std::uint32_t v, std::uint32_t& context) {
    const Origin& from = origins_[v];
    const auto& places = geometry_.textureCoordinates;
    const glm::uvec2 guess =
        v == 0 ? glm::uvec2(0U) : foreseen(places[from.a], places[from.b], places[from.opposite]);
    const glm::uvec2 left = glm::uvec2(places[v]) - guess;
    for (int axis = 0; axis < 2; ++axis)
        putNumber(vertices_, context++, zigzag(wrapped<32>(left[axis])));
}

std::vector<std::byte> PageEncoder::run() {
    addTriangles();
    addVertices();
    codec::BitWriter writer;
    triangles_.writeShares(writer);
    vertices_.writeShares(writer);
    for (const Rest& rest : rests_) writer.put(rest.bits, rest.count);
    std::vector<std::uint8_t> bits = std::move(writer).finish();
    bits.resize(bits.size() + bits.size() % 2);
    const std::vector<std::uint16_t> triangles = triangles_.words<2>();
    const std::vector<std::uint16_t> vertices = vertices_.words<4>();
    const std::array<std::uint32_t, 2> sizes = {static_cast<std::uint32_t>(bits.size()),
                                                static_cast<std::uint32_t>(triangles.size())};
    std::vector<std::byte> page(sizeof sizes + bits.size() +
                                (triangles.size() + vertices.size()) * sizeof(std::uint16_t));
    std::byte* end = page.data();
    const auto append = [&end](const auto& values) {
        const auto bytes = std::as_bytes(std::span(values));
        std::memcpy(end, bytes.data(), bytes.size());
        end += bytes.size();
    };
    append(sizes);
    append(bits);
    append(triangles);
    append(vertices);
    return page;
}

}  // namespace

std::vector<std::byte> encodePage(const NodeGeometry& geometry) {
    return PageEncoder(geometry).run();
}

}  // namespace eyrie::mesh
