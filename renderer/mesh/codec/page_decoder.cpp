// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/codec/bits.h"
#include "renderer/codec/rans.h"
#include "renderer/codec/symbol_shares.h"
#include "renderer/mesh/codec/normal_forecast.h"
#include "renderer/mesh/codec/page_codec.h"
#include "renderer/mesh/codec/page_model.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

constexpr std::size_t kSymbolsAtOnce = 1024;  ///< a multiple of the vertices' states

absl::Status damaged(std::string_view what) {
    return absl::DataLossError(fmt::format("its page is damaged: {}", what));
}

/// The shares of a number of contexts, made ready.
class Slots {
public:
    explicit Slots(std::size_t contexts) : slots_(contexts * codec::kAllShares) {}

    bool read(codec::BitReader& reader, std::size_t context, std::uint32_t symbols) {
        codec::SymbolShares shares;
        if (!shares.read(reader, symbols))
            return false;
        shares.fillSlots(std::span<std::uint32_t, codec::kAllShares>(
            slots_.data() + context * codec::kAllShares, std::size_t{codec::kAllShares}));
        return true;
    }
    const std::uint32_t* data() const { return slots_.data(); }

private:
    std::vector<std::uint32_t> slots_;
};

/// The triangles' symbols, one after the other.
class SymbolReader {
public:
    SymbolReader(std::span<const std::uint16_t> words, const Slots& slots)
        : rans_(words), slots_(slots.data()) {}

    std::uint32_t take(std::uint32_t context) {
        const codec::SlotEntry entry{slots_[(std::size_t{context} << codec::kSymbolBits) +
                                            rans_.slot(state_, codec::kSymbolBits)]};
        rans_.take(state_, entry, codec::kSymbolBits);
        state_ ^= 1;
        return entry.symbol();
    }
    bool isAtEnd() const { return rans_.isAtEnd(); }

private:
    codec::RansDecoder<2> rans_;
    const std::uint32_t* slots_;
    std::size_t state_ = 0;
};

/// The three parts of a page.
struct Parts {
    std::span<const std::uint8_t> bits;
    std::vector<std::uint16_t> words;  ///< aligned
    std::size_t triangleWords = 0;     ///< the first of them; the others are the vertices'
};

absl::StatusOr<Parts> partsOf(std::span<const std::byte> page) {
    std::array<std::uint32_t, 2> sizes{};
    if (page.size() < sizeof sizes || page.size() % 2 != 0)
        return damaged("it has no header");
    std::memcpy(sizes.data(), page.data(), sizeof sizes);
    const auto [bitBytes, triangleWords] = sizes;
    const std::size_t rest = page.size() - sizeof sizes;
    if (bitBytes % 2 != 0 || bitBytes > rest || triangleWords > (rest - bitBytes) / 2)
        return damaged("its parts do not fit into it");
    Parts parts;
    parts.bits = {reinterpret_cast<const std::uint8_t*>(page.data()) + sizeof sizes, bitBytes};
    parts.words.resize((rest - bitBytes) / 2);
    std::memcpy(parts.words.data(), page.data() + sizeof sizes + bitBytes, rest - bitBytes);
    parts.triangleWords = triangleWords;
    return parts;
}

class PageDecoder {
public:
    PageDecoder(const Parts& parts, const NodeArrays& arrays)
        : arrays_(arrays),
          numbers_(numbersOf(!arrays.colours.empty(), !arrays.textureCoordinates.empty())),
          bits_(parts.bits),
          triangleSlots_(kTriangleContexts),
          vertexSlots_(numbers_),
          triangles_(std::span(parts.words).first(parts.triangleWords), triangleSlots_),
          vertices_(std::span(parts.words).subspan(parts.triangleWords)),
          origins_(arrays.positions.size()) {}

    absl::Status run();

private:
    std::uint32_t number(std::uint32_t symbol) {
        return numberOf(symbol, bits_.get(restBitsOf(symbol)));
    }

    bool readShares();
    bool takeLoose(std::span<std::uint16_t, 3> corners);
    bool takeThird(std::uint32_t age, const OpenEdge& edge, std::uint16_t& corner);
    bool takeTriangles();
    void takeSymbols();
    void takeVertices();
    void takePosition(std::uint32_t v, const std::uint8_t* symbols);
    void takeColour(std::uint32_t v, const std::uint8_t* symbols);
    void takeTextureCoordinates(std::uint32_t v, const std::uint8_t* symbols);
    void addForecast();

    const NodeArrays& arrays_;
    const std::size_t numbers_;  ///< a vertex
    codec::BitReader bits_;
    Slots triangleSlots_;
    Slots vertexSlots_;
    SymbolReader triangles_;
    codec::RansDecoder<4> vertices_;
    std::vector<Origin> origins_;
    std::vector<std::uint8_t> symbols_;  ///< of the vertices' numbers
    OpenEdges edges_;
    std::uint32_t seen_ = 0;  ///< vertices
};

bool PageDecoder::readShares() {
    for (std::uint32_t context = 0; context < kTriangleContexts; ++context)
        if (!triangleSlots_.read(bits_, context, symbolsOf(context)))
            return false;
    for (std::size_t context = 0; context < numbers_; ++context)
        if (!vertexSlots_.read(bits_, context, kNumberSymbols))
            return false;
    return true;
}

bool PageDecoder::takeLoose(std::span<std::uint16_t, 3> corners) {
    const std::uint32_t firstNew = seen_;
    for (std::uint16_t& corner : corners) {
        const std::uint32_t ago = number(triangles_.take(kLooseCorner));
        if (ago > seen_ || (ago == 0 && seen_ == arrays_.positions.size()))
            return false;
        corner = static_cast<std::uint16_t>(seen_ - ago);
        seen_ += ago == 0 ? 1 : 0;
    }
    originsOfLoose(corners, firstNew,
                   [this](std::uint16_t vertex, const Origin& from) { origins_[vertex] = from; });
    edges_.openAll(corners);
    return true;
}

bool PageDecoder::takeThird(std::uint32_t age, const OpenEdge& edge, std::uint16_t& corner) {
    const std::uint32_t symbol = triangles_.take(thirdContext(age));
    const auto third = static_cast<ThirdCorner>(std::min(symbol, kElsewhere));
    if (third == ThirdCorner::IsNew) {
        if (seen_ == arrays_.positions.size())
            return false;
        origins_[seen_] = {edge.from, edge.to, edge.opposite};
        corner = static_cast<std::uint16_t>(seen_++);
    } else if (third == ThirdCorner::IsElsewhere) {
        const std::uint32_t ago = number(symbol - kElsewhere);
        if (ago == 0 || ago > seen_)
            return false;
        corner = static_cast<std::uint16_t>(seen_ - ago);
    } else {
        const bool isNext = third == ThirdCorner::ClosesNext;
        const std::uint32_t other = isNext ? edges_.youngestFrom(edge.to, edge.from)
                                           : edges_.youngestTo(edge.from, edge.to);
        if (other == OpenEdges::kNone)
            return false;
        corner = isNext ? edges_.at(other).to : edges_.at(other).from;
        edges_.close(other);
    }
    edges_.openSides(edge, corner, third);
    return true;
}

bool PageDecoder::takeTriangles() {
    if (arrays_.indices.empty()) {
        originsOfPoints(origins_);
        return triangles_.isAtEnd();
    }
    for (std::size_t i = 0; i < arrays_.indices.size(); i += 3) {
        const std::span<std::uint16_t, 3> corners(arrays_.indices.data() + i, 3);
        const std::uint32_t met = triangles_.take(kMetEdge);
        const std::uint32_t age = met / 3;
        const std::uint32_t turn = met % 3;
        if (age == OpenEdges::kNone) {
            if (!takeLoose(corners))
                return false;
            continue;
        }
        if (age >= edges_.count())
            return false;
        const OpenEdge edge = edges_.at(age);
        edges_.close(age);
        corners[turn] = edge.from;
        corners[(turn + 1) % 3] = edge.to;
        if (!takeThird(age, edge, corners[(turn + 2) % 3]))
            return false;
    }
    return seen_ == arrays_.positions.size() && triangles_.isAtEnd();
}

void PageDecoder::takeSymbols() {
    // One more round than a row has, so that a row may begin with any context.
    std::vector<std::uint8_t> contexts(kSymbolsAtOnce + numbers_);
    for (std::size_t k = 0; k < contexts.size(); ++k)
        contexts[k] = static_cast<std::uint8_t>(k % numbers_);
    symbols_.resize(arrays_.positions.size() * numbers_);
    for (std::size_t first = 0; first < symbols_.size(); first += kSymbolsAtOnce)
        vertices_.takeRow<codec::kSymbolBits>(
            vertexSlots_.data(), contexts.data() + first % numbers_,
            std::min(kSymbolsAtOnce, symbols_.size() - first), symbols_.data() + first);
}

void PageDecoder::takePosition(std::uint32_t v, const std::uint8_t* symbols) {
    const Origin& from = origins_[v];
    const auto position = [this](std::uint32_t u) { return unpackPosition(arrays_.positions[u]); };
    const glm::uvec3 guess =
        v == 0 ? glm::uvec3(0U)
               : foreseen(position(from.a), position(from.b), position(from.opposite));
    glm::uvec3 point;
    for (int axis = 0; axis < 3; ++axis)
        point[axis] = (guess[axis] + unzigzag(number(symbols[axis]))) & kMaxLatticeCoordinate;
    arrays_.positions[v] = packPosition(point);
}

/// Normals are left as differences from the forecast, which needs all positions.
void PageDecoder::takeVertices() {
    for (std::uint32_t v = 0; v < arrays_.positions.size(); ++v) {
        const std::uint8_t* symbols = symbols_.data() + v * numbers_;
        takePosition(v, symbols);
        const std::uint32_t low = unzigzag(number(symbols[3]));
        const std::uint32_t high = unzigzag(number(symbols[4]));
        arrays_.normals[v] = (low & 0xFFFFU) | high << 16;
        symbols += 5;
        if (!arrays_.colours.empty()) {
            takeColour(v, symbols);
            symbols += 4;
        }
        if (!arrays_.textureCoordinates.empty())
            takeTextureCoordinates(v, symbols);
    }
}

void PageDecoder::takeColour(std::uint32_t v, const std::uint8_t* symbols) {
    const Origin& from = origins_[v];
    const std::uint32_t mean =
        v == 0 ? 0 : meanColour(arrays_.colours[from.a], arrays_.colours[from.b]);
    std::uint32_t colour = 0;
    for (int channel = 0; channel < 4; ++channel)
        colour |= (((mean >> 8 * channel) + unzigzag(number(symbols[channel]))) & 0xFFU)
                  << 8 * channel;
    arrays_.colours[v] = colour;
}

void PageDecoder::takeTextureCoordinates(std::uint32_t v, const std::uint8_t* symbols) {
    const Origin& from = origins_[v];
    const auto places = arrays_.textureCoordinates;
    glm::uvec2 place =
        v == 0 ? glm::uvec2(0U) : foreseen(places[from.a], places[from.b], places[from.opposite]);
    for (int axis = 0; axis < 2; ++axis) place[axis] += unzigzag(number(symbols[axis]));
    places[v] = glm::ivec2(place);
}

void PageDecoder::addForecast() {
    std::vector<std::uint32_t> forecast(arrays_.normals.size());
    const bool areOfPoints = arrays_.indices.empty();
    if (!areOfPoints)
        forecastNormals(arrays_.positions, arrays_.indices, forecast);
    for (std::size_t v = 0; v < forecast.size(); ++v) {
        if (areOfPoints && v > 0)
            forecast[v] = arrays_.normals[v - 1];
        const std::uint32_t left = arrays_.normals[v];
        arrays_.normals[v] =
            ((forecast[v] + left) & 0xFFFFU) | ((forecast[v] & 0xFFFF0000U) + (left & 0xFFFF0000U));
    }
}

absl::Status PageDecoder::run() {
    if (!readShares())
        return damaged("its symbols have no shares");
    if (!takeTriangles())
        return damaged("its triangles cannot be followed");
    takeSymbols();
    takeVertices();
    if (!vertices_.isAtEnd() || bits_.isPastEnd())
        return damaged("its vertices end early or late");
    addForecast();
    return absl::OkStatus();
}

}  // namespace

absl::Status decodePage(std::span<const std::byte> page, const NodeArrays& arrays) {
    ASSIGN_OR_RETURN(const Parts parts, partsOf(page));
    return PageDecoder(parts, arrays).run();
}

}  // namespace eyrie::mesh
