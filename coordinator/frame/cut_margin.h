// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::coordinator {

/// How many times as long as foreseen the first frames of new views take: about the kQuantile of
/// all there were, by steps up where one took longer and down where it did not, in a proportion
/// that comes to rest there (H. Robbins, S. Monro, "A Stochastic Approximation Method", 1951; steps
/// stay as long as they are, since scenes and machines change).
class CutMargin {
public:
    static constexpr double kQuantile = 0.6;

    double factor() const;  ///< 1 to 2

    /// A new view's first frame. Times are told apart less where they are short for the budget.
    void record(double foreseenMilliseconds, double milliseconds, double budgetMilliseconds);

private:
    double logarithm_ = 0;  ///< of the factor
};

}  // namespace eyrie::coordinator
