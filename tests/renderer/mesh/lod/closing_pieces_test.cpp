// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/closing_pieces.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// A mesh of pieces, each of rectangles over corners of its own.
class Pieces {
public:
    /// Begins another.
    Pieces& piece() {
        ++count_;
        return *this;
    }
    /// From `corner` along `a` and `b`, in lattice steps.
    Pieces& rectangle(glm::ivec3 corner, glm::ivec3 a, glm::ivec3 b) {
        const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
        for (const glm::ivec3 at : {corner, corner + a, corner + a + b, corner + b}) {
            mesh_.positions.push_back(packPosition(glm::uvec3(at)));
            pieceOf_.push_back(count_ - 1);
        }
        mesh_.triangles.push_back({first, first + 1, first + 2});
        mesh_.triangles.push_back({first, first + 2, first + 3});
        return *this;
    }
    std::vector<bool> closing() const {
        return closingPieces(mesh_, SheetEnds(mesh_), pieceOf_, count_);
    }

private:
    PackedMesh mesh_;
    std::vector<std::uint32_t> pieceOf_;
    std::uint32_t count_ = 0;
};

/// A road of four parts and a lawn, 40 steps apart.
Pieces roadAndLawn() {
    Pieces pieces;
    pieces.piece();
    for (const int x : {0, 1000, 2000, 3000})
        pieces.rectangle({x, 0, 0}, {1000, 0, 0}, {0, 500, 0});
    pieces.piece().rectangle({0, 540, 0}, {4000, 0, 0}, {0, 2000, 0});
    return pieces;
}

TEST(ClosingPieces, AreKerbsBetweenRoadAndLawn) {
    Pieces pieces = roadAndLawn();
    pieces.piece();  // whose corners share none of theirs
    for (const int x : {300, 1700})
        pieces.rectangle({x, 500, 0}, {1400, 0, 0}, {0, 20, 15})
            .rectangle({x, 520, 15}, {1400, 0, 0}, {0, 20, -15});
    EXPECT_EQ(pieces.closing(), std::vector({false, false, true}));
}

TEST(ClosingPieces, ArePanesInTheirFrames) {
    Pieces pieces;
    pieces.piece()
        .rectangle({0, 0, 0}, {1000, 0, 0}, {0, 0, 100})
        .rectangle({0, 0, 900}, {1000, 0, 0}, {0, 0, 100})
        .rectangle({0, 0, 100}, {100, 0, 0}, {0, 0, 800})
        .rectangle({900, 0, 100}, {100, 0, 0}, {0, 0, 800});
    pieces.piece().rectangle({95, 10, 95}, {810, 0, 0}, {0, 0, 810});
    EXPECT_TRUE(pieces.closing()[1]);
}

TEST(ClosingPieces, AreNotWhatStandsOnOthersOrLiesOnThem) {
    Pieces pieces = roadAndLawn();
    pieces.piece().rectangle({100, 500, 0}, {200, 0, 0}, {0, 0, 300});  // a sign at the road's end
    pieces.piece().rectangle({100, 100, 1}, {800, 0, 0}, {0, 50, 0});   // paint
    pieces
        .piece()  // a box on the road without a floor
        .rectangle({500, 200, 0}, {90, 0, 0}, {0, 0, 90})
        .rectangle({500, 290, 0}, {90, 0, 0}, {0, 0, 90})
        .rectangle({500, 200, 0}, {0, 90, 0}, {0, 0, 90})
        .rectangle({590, 200, 0}, {0, 90, 0}, {0, 0, 90})
        .rectangle({500, 200, 90}, {90, 0, 0}, {0, 90, 0});
    EXPECT_EQ(pieces.closing(), std::vector<bool>(5, false));
}

TEST(ClosingPieces, AreNotSolids) {
    Pieces pieces = roadAndLawn();
    pieces.piece()
        .rectangle({300, 500, 0}, {40, 0, 0}, {0, 40, 0})
        .rectangle({300, 500, 40}, {40, 0, 0}, {0, 40, 0})
        .rectangle({300, 500, 0}, {40, 0, 0}, {0, 0, 40})
        .rectangle({300, 540, 0}, {40, 0, 0}, {0, 0, 40})
        .rectangle({300, 500, 0}, {0, 40, 0}, {0, 0, 40})
        .rectangle({340, 500, 0}, {0, 40, 0}, {0, 0, 40});
    EXPECT_FALSE(pieces.closing()[2]);
}

}  // namespace
}  // namespace eyrie::mesh
