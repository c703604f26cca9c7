// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include <absl/status/status.h>

/// Holding a frame time by choosing the error tau. The coordinator learns what drawing costs and
/// sends that with the frame data; renderers know how many triangles the new view's cut has at
/// which tau, before anything is drawn, and all choose the same (docs/decisions/0034).
namespace eyrie::fabric {

inline constexpr double kMinBudgetMilliseconds = 1;
inline constexpr double kMaxBudgetMilliseconds = 10'000;

/// A budget raises tau no further than this, or than what was asked for: after that pictures get
/// smaller.
inline constexpr double kBudgetTauPixels = 16;

/// What is aimed at when tau changes, as a share of the budget. It goes finer only when less than
/// this is foreseen and coarser only when more than the budget is, so that it stays where it is
/// while the times of equal frames differ.
inline constexpr double kBudgetAim = 0.85;

/// How long a frame may take, and what is known of how long it would.
struct FrameBudget {
    double milliseconds = 0;           ///< kMinBudgetMilliseconds to kMaxBudgetMilliseconds
    double fixedMilliseconds = 0;      ///< of a picture that is covered all over; 0 or more
    double millisecondsATriangle = 0;  ///< of the whole view's cut, whoever draws it; 0 or more
    double lastTauPixels = 0;          ///< what the frame before was drawn at; 0: there was none

    bool operator==(const FrameBudget&) const = default;

    double predict(double covered, std::uint64_t triangles) const {
        return fixedMilliseconds * fixedShare(covered) +
               millisecondsATriangle * static_cast<double>(triangles);
    }

    /// How much of fixedMilliseconds a frame takes of which `covered`, 0 to 1, of the pixels are
    /// covered: mostly that is shading and reading these back; some is there whatever is seen.
    static double fixedShare(double covered) { return 0.1 + 0.9 * covered; }
};

/// InvalidArgument unless `milliseconds` is a time that may be asked for.
absl::Status validateBudgetMilliseconds(double milliseconds);

/// InvalidArgument, naming the field.
absl::Status validate(const FrameBudget& budget);

/// What became of a budget in a frame.
struct BudgetUse {
    double milliseconds = 0;           ///< asked for
    double predictedMilliseconds = 0;  ///< of the frame, before it was drawn
    double tauPixels = 0;              ///< chosen; at least what was asked for
    std::uint64_t triangles = 0;       ///< of the whole view's cut at that tau
    double covered = 1;                ///< share of the view's pixels where something may be

    /// False where even the coarsest tau was foreseen to take longer.
    bool isMet() const { return predictedMilliseconds <= milliseconds; }

    bool operator==(const BudgetUse&) const = default;
};

/// How many triangles the whole view's cut has at a tau; fewer the larger that is.
using CutTriangles = std::function<std::uint64_t(double tauPixels)>;

/// The smallest tau of a ladder (`tauAskedPixels` times powers of 2^(1/4), up to kBudgetTauPixels)
/// whose cut is foreseen to fit, or the ladder's last. Depends on its arguments alone. `triangles`
/// is called once where nothing changes, and about three times where something does: the search
/// goes from the frame before, by how much too large or small its cut is. `covered`:
/// BudgetUse::covered.
BudgetUse tauForBudget(double tauAskedPixels, const FrameBudget& budget, double covered,
                       const CutTriangles& triangles);

}  // namespace eyrie::fabric
