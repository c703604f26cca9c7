// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "renderer/terrain/deviation_scan.h"
#include "renderer/terrain/floor_divide.h"

namespace eyrie::terrain {
namespace {

/// Distances of a drawn edge a-b from the source where the edge meets lines of the lattice.
/// A line is met at a + t (b - a) with t = num / den.
class EdgeCrossings {
public:
    EdgeCrossings(const HeightPatch& patch, const Corner& a, const Corner& b, double worst)
        : patch_(patch),
          a_(a),
          dx_(b.i - a.i),
          dy_(b.j - a.j),
          dz_(b.z - a.z),
          result_{worst, false} {}

    void atColumns() {
        const std::int64_t den = std::abs(dx_);
        forEachCrossing(den, [&](std::int64_t k) {
            const Split y = split(a_.j, dy_, k, den);
            const auto i = static_cast<std::int32_t>(a_.i + (dx_ < 0 ? -k : k));
            if (y.fraction != 0 && has(i, y.whole) && has(i, y.whole + 1))
                note(k, den, patch_.at(i, y.whole), patch_.at(i, y.whole + 1), y.fraction);
        });
    }

    void atRows() {
        const std::int64_t den = std::abs(dy_);
        forEachCrossing(den, [&](std::int64_t k) {
            const Split x = split(a_.i, dx_, k, den);
            const auto j = static_cast<std::int32_t>(a_.j + (dy_ < 0 ? -k : k));
            if (x.fraction != 0 && has(x.whole, j) && has(x.whole + 1, j))
                note(k, den, patch_.at(x.whole, j), patch_.at(x.whole + 1, j), x.fraction);
        });
    }

    /// Diagonals i - j = constant, from post (i, j) to (i + 1, j + 1).
    void atMainDiagonals() {
        const std::int64_t den = std::abs(dx_ - dy_);
        forEachCrossing(den, [&](std::int64_t k) {
            const Split x = split(a_.i, dx_, k, den);
            const Split y = split(a_.j, dy_, k, den);
            if (x.fraction != 0 && has(x.whole, y.whole) && has(x.whole + 1, y.whole + 1))
                note(k, den, patch_.at(x.whole, y.whole), patch_.at(x.whole + 1, y.whole + 1),
                     x.fraction);
        });
    }

    /// Diagonals i + j = constant, from post (i, j + 1) to (i + 1, j).
    void atOtherDiagonals() {
        const std::int64_t den = std::abs(dx_ + dy_);
        forEachCrossing(den, [&](std::int64_t k) {
            const Split x = split(a_.i, dx_, k, den);
            const Split y = split(a_.j, dy_, k, den);
            if (x.fraction != 0 && has(x.whole, y.whole) && has(x.whole + 1, y.whole + 1))
                note(k, den, patch_.at(x.whole, y.whole + 1), patch_.at(x.whole + 1, y.whole),
                     x.fraction);
        });
    }

    const Crossed& result() const { return result_; }

private:
    struct Split {
        std::int32_t whole;
        double fraction;
    };

    static Split split(std::int64_t start, std::int64_t delta, std::int64_t num, std::int64_t den) {
        const std::int64_t scaled = delta * num;
        const std::int64_t whole = floorDivide(scaled, den);
        return {static_cast<std::int32_t>(start + whole),
                static_cast<double>(scaled - whole * den) / static_cast<double>(den)};
    }

    bool has(std::int32_t i, std::int32_t j) const {
        return i >= patch_.i0 && i <= patch_.i1 && j >= patch_.j0 && j <= patch_.j1;
    }

    /// Calls visit(k) for 0 < k < den, at least where the edge passes the patch.
    template <typename Visit>
    void forEachCrossing(std::int64_t den, Visit visit) const {
        if (den < 2)
            return;
        double first = 0;
        double last = 1;
        const auto narrow = [&](std::int64_t delta, std::int32_t start, std::int32_t low,
                                std::int32_t high) {
            if (delta == 0)
                return;
            const double t0 = static_cast<double>(low - 1 - start) / static_cast<double>(delta);
            const double t1 = static_cast<double>(high + 1 - start) / static_cast<double>(delta);
            first = std::max(first, std::min(t0, t1));
            last = std::min(last, std::max(t0, t1));
        };
        narrow(dx_, a_.i, patch_.i0, patch_.i1);
        narrow(dy_, a_.j, patch_.j0, patch_.j1);
        const auto scale = static_cast<double>(den);
        const auto from =
            std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(first * scale)) - 1);
        const auto to =
            std::min<std::int64_t>(den - 1, static_cast<std::int64_t>(std::ceil(last * scale)) + 1);
        for (std::int64_t k = from; k <= to; ++k) visit(k);
    }

    void note(std::int64_t num, std::int64_t den, float h0, float h1, double fraction) {
        const double drawn = a_.z + dz_ * (static_cast<double>(num) / static_cast<double>(den));
        const auto low = static_cast<double>(h0);
        const double d = std::abs(drawn - (low + (static_cast<double>(h1) - low) * fraction));
        if (d != d)
            result_.meetsNodata = true;
        else
            result_.worst = std::max(result_.worst, d);
    }

    const HeightPatch& patch_;
    Corner a_;
    std::int64_t dx_;
    std::int64_t dy_;
    double dz_;
    Crossed result_;
};

}  // namespace

double scanDiagonalEdges(const HeightPatch& patch, const Triangle& triangle, double worst) {
    for (std::size_t e = 0; e < 3; ++e) {
        const Corner& a = triangle[e];
        const Corner& b = triangle[(e + 1) % 3];
        const std::int32_t length = std::abs(b.i - a.i);
        if (length != std::abs(b.j - a.j))
            continue;
        const std::int32_t di = b.i > a.i ? 1 : -1;
        const std::int32_t dj = b.j > a.j ? 1 : -1;
        const double slope = (b.z - a.z) / length;
        // Cells from k to k + 1 whose four posts the patch has.
        const auto within = [](std::int32_t start, std::int32_t step, std::int32_t low,
                               std::int32_t high) {
            return step > 0 ? std::pair{low - start, high - start - 1}
                            : std::pair{start - high, start - low - 1};
        };
        const auto [fromI, toI] = within(a.i, di, patch.i0, patch.i1);
        const auto [fromJ, toJ] = within(a.j, dj, patch.j0, patch.j1);
        for (std::int32_t k = std::max({0, fromI, fromJ}); k <= std::min({length - 1, toI, toJ});
             ++k) {
            const std::int32_t i = a.i + di * k;
            const std::int32_t j = a.j + dj * k;
            const double other = (static_cast<double>(patch.at(i + di, j)) +
                                  static_cast<double>(patch.at(i, j + dj))) /
                                 2;
            const double d = std::abs(a.z + slope * (k + 0.5) - other);
            worst = d > worst ? d : worst;  // NaN never wins
        }
    }
    return worst;
}

Crossed scanCrossings(const HeightPatch& patch, const Triangle& triangle, double worst) {
    Crossed all{worst, false};
    for (std::size_t e = 0; e < 3; ++e) {
        const Corner& a = triangle[e];
        const Corner& b = triangle[(e + 1) % 3];
        if (a.i == b.i || a.j == b.j)
            continue;  // meets all lines at posts
        EdgeCrossings crossings(patch, a, b, all.worst);
        if (std::abs(b.i - a.i) != std::abs(b.j - a.j)) {  // else at posts
            crossings.atColumns();
            crossings.atRows();
        }
        crossings.atMainDiagonals();
        crossings.atOtherDiagonals();
        all = {crossings.result().worst, all.meetsNodata || crossings.result().meetsNodata};
    }
    return all;
}

}  // namespace eyrie::terrain
