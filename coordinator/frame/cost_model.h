// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::coordinator {

/// What a frame took, and what it was like.
struct FrameCost {
    double fixedShare = 1;  ///< fabric::FrameBudget::fixedShare: above 0, at most 1
    double triangles = 0;   ///< of the whole view's cut
    double milliseconds = 0;
    /// Drawn as finely and as large as was asked for, in a small part of the time there was.
    bool isEasy = false;
    bool isOfNewView = false;  ///< the first after a cut: nothing like it was there before
};

/// How long frames take, learned from those before: a share of `fixed`, which depends on how many
/// pixels are covered (fabric::FrameBudget::fixedShare), and `slope` x triangles of the view's cut.
///
/// A Kalman filter (R. E. Kalman, "A New Approach to Linear Filtering and Prediction Problems",
/// 1960) of the two, both of which drift. While the camera rests nothing is learned of how they
/// share a time, and the filter keeps what it knew. It departs from the textbook in that one frame
/// is never believed to be off by more than kOutlier: a page fault or a neighbour's process is no
/// news of the scene. Two in turn that are off the same way are, and both parameters are scaled at
/// once by the lesser of the two ratios, up to threefold; or one, which is the first of a new view.
///
/// Easy frames teach nothing, once the machine is known: nothing would be drawn otherwise for it,
/// and a few triangles in a corner cost less each than those that fill a picture. What was learned
/// where time was short is kept until it is short again.
class CostModel {
public:
    static constexpr double kOutlier = 1.3;

    /// Both are 0 or more, whatever was recorded. Before any frame: guesses.
    double fixedMilliseconds() const { return fixed_; }
    double millisecondsATriangle() const { return slope_ / kTriangles; }

    /// A time that is not positive and less than an hour is left out.
    void record(const FrameCost& frame);

    /// The picture has `factor` times the pixels from now on. What does not depend on triangles is
    /// taken to grow with them by as much, and to fall by half as much: rather too long than too
    /// short.
    void resized(double factor);

private:
    static constexpr double kTriangles = 100'000;  ///< the unit of slope_, for even numbers

    double predict(double share, double x) const;
    void set(double fixed, double slope);
    void scaleCovariance(double fixed, double slope);
    double news(const FrameCost& frame, double ratio) const;
    void follow(const FrameCost& frame);

    double fixed_ = 4;
    double slope_ = 10;
    /// Covariance of the two.
    double ff_ = 16;
    double fs_ = 0;
    double ss_ = 100;
    int frames_ = 0;
    double lastRatio_ = 1;  ///< measured over foreseen
};

}  // namespace eyrie::coordinator
