// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/image_quality.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace eyrie::truth {
namespace {

constexpr double kPeak = 255;
constexpr int kRadius = 5;
constexpr double kSigma = 1.5;

double squared(double value) { return value * value; }

/// Rec. 601.
double luma(const fabric::Rgba& c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; }

/// One number a pixel.
struct Plane {
    int width;
    int height;
    std::vector<double> values;

    double at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

using Window = std::vector<double>;

/// Of a side that is not longer than the picture's.
Window windowOf(int pictureSide) {
    const int side = std::min(2 * kRadius + 1, pictureSide);
    Window weights;
    double sum = 0;
    for (int i = 0; i < side; ++i) {
        weights.push_back(std::exp(-squared(i - (side - 1) / 2.0) / (2 * kSigma * kSigma)));
        sum += weights.back();
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Weighted means of all windows wholly inside.
Plane filtered(const Plane& plane, const Window& columns, const Window& rows) {
    Plane narrow{plane.width - static_cast<int>(columns.size()) + 1, plane.height, {}};
    for (int y = 0; y < narrow.height; ++y)
        for (int x = 0; x < narrow.width; ++x) {
            double sum = 0;
            for (std::size_t i = 0; i < columns.size(); ++i)
                sum += columns[i] * plane.at(x + static_cast<int>(i), y);
            narrow.values.push_back(sum);
        }
    Plane small{narrow.width, plane.height - static_cast<int>(rows.size()) + 1, {}};
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            double sum = 0;
            for (std::size_t i = 0; i < rows.size(); ++i)
                sum += rows[i] * narrow.at(x, y + static_cast<int>(i));
            small.values.push_back(sum);
        }
    return small;
}

}  // namespace

double psnrDb(const fabric::Image& a, const fabric::Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i) {
        const fabric::Rgba& p = a.colour[i];
        const fabric::Rgba& q = b.colour[i];
        sum += squared(p.r - q.r) + squared(p.g - q.g) + squared(p.b - q.b);
    }
    if (sum == 0)
        return std::numeric_limits<double>::infinity();
    const double mean = sum / (3 * static_cast<double>(a.colour.size()));
    return 10 * std::log10(kPeak * kPeak / mean);
}

double ssim(const fabric::Image& a, const fabric::Image& b) {
    const int width = a.area.width;
    const int height = a.area.height;
    const Window columns = windowOf(width);
    const Window rows = windowOf(height);
    const auto meanOf = [&](auto value) {
        Plane plane{width, height, {}};
        for (std::size_t i = 0; i < a.colour.size(); ++i)
            plane.values.push_back(value(luma(a.colour[i]), luma(b.colour[i])));
        return filtered(plane, columns, rows).values;
    };
    const auto meanA = meanOf([](double p, double) { return p; });
    const auto meanB = meanOf([](double, double q) { return q; });
    const auto meanAA = meanOf([](double p, double) { return p * p; });
    const auto meanBB = meanOf([](double, double q) { return q * q; });
    const auto meanAB = meanOf([](double p, double q) { return p * q; });
    const double c1 = squared(0.01 * kPeak);
    const double c2 = squared(0.03 * kPeak);
    double sum = 0;
    for (std::size_t i = 0; i < meanA.size(); ++i) {
        const double ab = meanA[i] * meanB[i];
        const double squares = squared(meanA[i]) + squared(meanB[i]);
        sum += (2 * ab + c1) * (2 * (meanAB[i] - ab) + c2) /
               ((squares + c1) * (meanAA[i] + meanBB[i] - squares + c2));
    }
    return sum / static_cast<double>(meanA.size());
}

}  // namespace eyrie::truth
