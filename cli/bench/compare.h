// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/bench/summary_file.h"

/// Two reports side by side, and what of their difference is beyond noise.
namespace eyrie::cli::bench {

/// How many times as long B takes as A.
struct Ratio {
    double estimate = 1;
    double low = 1;
    double high = 1;
    double confidence = 0;  ///< that the true ratio is from low to high, 0 to 1
};

/// From the same figure of each pass. The passes of both are taken to be spread alike around a
/// level of their own; nothing is assumed of how. The estimate is the median of all pairs' ratios
/// b / a. Of these the k least and the k greatest are left out and the rest's ends are the
/// interval: of n and m passes with k = 0 it misses the truth in 2 of C(n + m, n) orders they may
/// come in, and k is as many as leave that under 1 in 100 (the rank sum's normal approximation).
/// With equal counts and k = 0 the interval leaves 1 out when all passes of one are faster than all
/// of the other.
/// Hodges and Lehmann, "Estimates of Location Based on Rank Tests" (1963); Mann and Whitney, "On a
/// Test of Whether one of Two Random Variables is Stochastically Larger than the Other" (1947).
/// Precondition: both have passes, all of them positive.
Ratio ratioOf(const std::vector<double>& a, const std::vector<double>& b);

/// Of intervals that a difference is told from; with fewer passes none is.
inline constexpr double kLeastConfidence = 0.95;

enum class Verdict {
    Equal,         ///< exactly
    WithinNoise,   ///< the interval holds 1; or, where no ratio can be formed, passes mingle
    Less,          ///< beyond noise, or an exact figure that is another
    More,          ///< the same
    TooFewPasses,  ///< to tell
    NotRepeated,   ///< one value a report: shown, not judged
};

struct Figure {
    std::string name;
    std::string unit;
    double a = 0;
    double b = 0;
    std::optional<Ratio> ratio;  ///< where passes were compared, all of them positive and finite
    Verdict verdict = Verdict::Equal;
};

struct RunComparison {
    WrittenRun a;
    WrittenRun b;
    std::vector<Figure> figures;
};

struct Comparison {
    WrittenReport a;
    WrittenReport b;
    std::vector<RunComparison> runs;  ///< that both have
    std::vector<std::string> notes;   ///< what a person should know before believing it
};

/// Lays runs of the same label, number of processes and compound, and at a frame time of the same
/// tau, side by side. InvalidArgument when
/// scene, flight, size or number of frames differ (`force` makes it a note) or no run is in both.
absl::StatusOr<Comparison> compare(WrittenReport a, WrittenReport b, bool force);

/// Figures that are beyond noise, or exact ones that differ.
int countBeyondNoise(const Comparison& comparison);

}  // namespace eyrie::cli::bench
