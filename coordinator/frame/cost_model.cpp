// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/cost_model.h"

#include <algorithm>
#include <cmath>

namespace eyrie::coordinator {
namespace {

constexpr double kLongest = 3.6e6;       ///< milliseconds
constexpr double kNoise = 0.15;          ///< of a frame's time, relative
constexpr double kTrustInNewView = 0.8;  ///< in the logarithm of how far its first frame is off
constexpr double kFixedDrift = 0.02;     ///< a frame, of its time
constexpr double kSlopeDrift = 0.03;     ///< a frame, relative
constexpr double kMostUncertain = 0.5;   ///< of a parameter's part of a frame's time
constexpr double kMostAtOnce = 3;        ///< by which both are scaled after two frames
constexpr int kFirstFrames = 3;          ///< each of which counts wholly
constexpr double kLeast = 1e-4;          ///< milliseconds of a parameter; of a time, a hundredfold
constexpr double kMost = 1e6;

double square(double value) { return value * value; }

}  // namespace

void CostModel::record(const FrameCost& frame) {
    const bool isTime = frame.milliseconds > 0 && frame.milliseconds < kLongest;
    if (!isTime || !(frame.triangles >= 0 && std::isfinite(frame.triangles)))
        return;
    if (++frames_ > kFirstFrames && frame.isEasy)
        return;
    const double ratio =
        frame.milliseconds / predict(frame.fixedShare, frame.triangles / kTriangles);
    const double factor = news(frame, ratio);
    set(fixed_ * factor, slope_ * factor);
    scaleCovariance(factor, factor);
    lastRatio_ = ratio / factor;
    follow(frame);
}

/// By what both parameters are off, says a frame that took `ratio` times as long as foreseen.
double CostModel::news(const FrameCost& frame, double ratio) const {
    if (frames_ <= kFirstFrames)
        return ratio;
    if (frame.isOfNewView)
        return std::clamp(std::pow(ratio, kTrustInNewView), 1 / kMostAtOnce, kMostAtOnce);
    if (std::min(ratio, lastRatio_) > kOutlier)
        return std::min({ratio, lastRatio_, kMostAtOnce});
    if (std::max(ratio, lastRatio_) < 1 / kOutlier)
        return std::max({ratio, lastRatio_, 1 / kMostAtOnce});
    return 1;
}

void CostModel::resized(double factor) {
    set(fixed_ * (factor < 1 ? (1 + factor) / 2 : factor), slope_);
    lastRatio_ = 1;
}

double CostModel::predict(double share, double x) const {
    return std::max(fixed_ * share + slope_ * x, 100 * kLeast);
}

void CostModel::set(double fixed, double slope) {
    fixed_ = std::clamp(fixed, 0.0, kMost);
    slope_ = std::clamp(slope, kLeast, kMost);
}

/// From both sides, so that it stays a covariance.
void CostModel::scaleCovariance(double fixed, double slope) {
    ff_ *= fixed * fixed;
    fs_ *= fixed * slope;
    ss_ *= slope * slope;
}

/// One step of the filter, with what was measured brought within kOutlier of what was foreseen.
void CostModel::follow(const FrameCost& frame) {
    const double share = frame.fixedShare;
    const double x = frame.triangles / kTriangles;
    const double foreseen = predict(share, x);
    const double error =
        std::clamp(frame.milliseconds, foreseen / kOutlier, foreseen * kOutlier) - foreseen;
    ff_ += square(kFixedDrift * std::max(foreseen, fixed_));
    ss_ += square(kSlopeDrift * slope_);
    const double most = kMostUncertain * foreseen;
    scaleCovariance(std::min(1.0, std::max(most / share, kMostUncertain * fixed_) / std::sqrt(ff_)),
                    std::min(1.0, std::max(most / std::max(x, kLeast), slope_) / std::sqrt(ss_)));

    const double ofFixed = share * ff_ + x * fs_;
    const double ofSlope = share * fs_ + x * ss_;
    const double variance = share * ofFixed + x * ofSlope + square(kNoise * foreseen);
    double fixed = fixed_ + ofFixed / variance * error;
    double slope = slope_ + ofSlope / variance * error;
    if (fixed < 0 && x > 0) {  // there is no such thing: it is the triangles'
        slope += fixed * share / x;
        fixed = 0;
    }
    set(fixed, slope);
    ff_ = std::max(ff_ - ofFixed * ofFixed / variance, 0.0);
    fs_ -= ofFixed * ofSlope / variance;
    ss_ = std::max(ss_ - ofSlope * ofSlope / variance, 0.0);
}

}  // namespace eyrie::coordinator
