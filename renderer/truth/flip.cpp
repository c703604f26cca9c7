// SPDX-License-Identifier: Apache-2.0
// Constants are the paper's. Its two-dimensional kernels are products of one-dimensional ones, or
// sums of two such products, and are applied as these.
#include "renderer/truth/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "fabric/vec.h"

namespace eyrie::truth {
namespace {

using fabric::Vec3;

constexpr double kPixelsPerDegree = 67;
constexpr double kColourPower = 0.7;       ///< q_c
constexpr double kColourKnee = 0.4;        ///< p_c
constexpr double kColourAtKnee = 0.95;     ///< p_t
constexpr double kFeaturePower = 0.5;      ///< q_f
constexpr double kFeatureDegrees = 0.082;  ///< w

using Kernel = std::vector<double>;  ///< odd in length, about its middle

/// One number a pixel.
struct Plane {
    int width;
    int height;
    std::vector<float> values;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};

template <typename Function>
void forEachPixel(int width, int height, Function function) {
    tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const auto& rows) {
        for (int y = rows.begin(); y != rows.end(); ++y)
            for (int x = 0; x < width; ++x) function(x, y);
    });
}

/// Beyond its border a picture goes on as it ends.
Plane convolved(const Plane& plane, const Kernel& acrossX, const Kernel& acrossY) {
    Plane half{plane.width, plane.height, std::vector<float>(plane.values.size())};
    Plane out = half;
    const auto pass = [](const Plane& from, Plane& to, const Kernel& kernel, int dx, int dy) {
        const int radius = static_cast<int>(kernel.size() / 2);
        forEachPixel(from.width, from.height, [&](int x, int y) {
            double sum = 0;
            for (int k = -radius; k <= radius; ++k)
                sum += kernel[static_cast<std::size_t>(k + radius)] *
                       static_cast<double>(
                           from.values[from.index(std::clamp(x + k * dx, 0, from.width - 1),
                                                  std::clamp(y + k * dy, 0, from.height - 1))]);
            to.values[to.index(x, y)] = static_cast<float>(sum);
        });
    };
    pass(plane, half, acrossX, 1, 0);
    pass(half, out, acrossY, 0, 1);
    return out;
}

double sumOf(const Kernel& kernel) {
    double sum = 0;
    for (const double weight : kernel) sum += weight;
    return sum;
}

template <typename Weight>
Kernel kernelOf(int radius, Weight weight) {
    Kernel kernel;
    for (int k = -radius; k <= radius; ++k) kernel.push_back(weight(k));
    return kernel;
}

/// Contrast sensitivity of one channel: a sum of Gaussians a * sqrt(pi / b) * exp(-pi^2 x^2 / b),
/// x in degrees.
struct Sensitivity {
    struct Gaussian {
        double a;
        double b;
    };
    std::array<Gaussian, 2> gaussians;
};
constexpr std::array<Sensitivity, 3> kSensitivities = {{{{{{1, 0.0047}, {0, 1e-5}}}},
                                                        {{{{1, 0.0053}, {0, 1e-5}}}},
                                                        {{{{34.1, 0.04}, {13.5, 0.025}}}}}};
constexpr double kWidestGaussian = 0.04;

Plane asSeen(const Plane& plane, const Sensitivity& sensitivity) {
    const int radius = static_cast<int>(
        std::ceil(3 * std::sqrt(kWidestGaussian / 2) / std::numbers::pi * kPixelsPerDegree));
    Plane sum{plane.width, plane.height, std::vector<float>(plane.values.size())};
    double weights = 0;
    for (const auto& [a, b] : sensitivity.gaussians) {
        if (a == 0)
            continue;
        const Kernel kernel = kernelOf(radius, [&, b = b](int k) {
            const double x = k / kPixelsPerDegree;
            return std::exp(-std::numbers::pi * std::numbers::pi * x * x / b);
        });
        const double scale = a * std::sqrt(std::numbers::pi / b);
        const double oneWay = sumOf(kernel);
        weights += scale * oneWay * oneWay;
        const Plane part = convolved(plane, kernel, kernel);
        for (std::size_t i = 0; i < sum.values.size(); ++i)
            sum.values[i] += static_cast<float>(scale) * part.values[i];
    }
    for (float& value : sum.values) value /= static_cast<float>(weights);
    return sum;
}

double linear(std::uint8_t srgb) {
    const double c = srgb / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// Of the white that linear RGB (1, 1, 1) is.
const Vec3 kWhite(0.950428545377181, 1.0, 1.088900370798128);

/// Over that of white.
Vec3 xyzOf(const Vec3& rgb) {
    return Vec3(10135552.0 / 24577794 * rgb.r + 8788810.0 / 24577794 * rgb.g +
                    4435075.0 / 24577794 * rgb.b,
                2613072.0 / 12288897 * rgb.r + 8788810.0 / 12288897 * rgb.g +
                    887015.0 / 12288897 * rgb.b,
                1425312.0 / 73733382 * rgb.r + 8788810.0 / 73733382 * rgb.g +
                    70074185.0 / 73733382 * rgb.b) /
           kWhite;
}

Vec3 rgbOf(const Vec3& xyzOverWhite) {
    const Vec3 c = xyzOverWhite * kWhite;
    return {3.241003275 * c.x - 1.537398934 * c.y - 0.498615861 * c.z,
            -0.969224334 * c.x + 1.875930071 * c.y + 0.041554224 * c.z,
            0.055639423 * c.x - 0.204011202 * c.y + 1.057148933 * c.z};
}

Vec3 yCxCzOf(const Vec3& rgb) {
    const Vec3 c = xyzOf(rgb);
    return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}

Vec3 rgbOfYCxCz(const Vec3& v) {
    const double y = (v.x + 16) / 116;
    return rgbOf({y + v.y / 500, y, y - v.z / 200});
}

/// CIELAB with the chroma of dark colours reduced (the Hunt effect).
Vec3 huntLab(const Vec3& rgb) {
    const auto f = [](double t) {
        constexpr double kDelta = 6.0 / 29;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
    };
    const Vec3 c = xyzOf(rgb);
    const double lightness = 116 * f(c.y) - 16;
    return {lightness, 0.01 * lightness * 500 * (f(c.x) - f(c.y)),
            0.01 * lightness * 200 * (f(c.y) - f(c.z))};
}

double distance(const Vec3& a, const Vec3& b) {
    return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), kColourPower);
}

double colourDifference(const Vec3& a, const Vec3& b) {
    static const double most = distance(huntLab({0, 1, 0}), huntLab({0, 0, 1}));
    const double knee = kColourKnee * most;
    const double difference = distance(a, b);
    return difference < knee
               ? kColourAtKnee / knee * difference
               : kColourAtKnee + (difference - knee) / (most - knee) * (1 - kColourAtKnee);
}

/// Positive weights sum to 1, negative ones to -1.
Kernel balanced(Kernel kernel) {
    double positive = 0;
    double negative = 0;
    for (const double weight : kernel) (weight > 0 ? positive : negative) += weight;
    for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
    return kernel;
}

/// Strength of edges and points.
struct Features {
    std::vector<float> edges;
    std::vector<float> points;
};

std::vector<float> lengths(const Plane& x, const Plane& y) {
    std::vector<float> out(x.values.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(x.values[i], y.values[i]);
    return out;
}

Features featuresOf(const Plane& lightness) {
    const double sigma = 0.5 * kFeatureDegrees * kPixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto gaussian = [&](int k) { return std::exp(-k * k / (2 * sigma * sigma)); };
    Kernel smooth = kernelOf(radius, gaussian);
    const double sum = sumOf(smooth);
    for (double& weight : smooth) weight /= sum;
    const Kernel edge = balanced(kernelOf(radius, [&](int k) { return -k * gaussian(k); }));
    const Kernel point = balanced(
        kernelOf(radius, [&](int k) { return (k * k / (sigma * sigma) - 1) * gaussian(k); }));
    return {lengths(convolved(lightness, edge, smooth), convolved(lightness, smooth, edge)),
            lengths(convolved(lightness, point, smooth), convolved(lightness, smooth, point))};
}

/// What of a picture is compared.
struct Seen {
    std::vector<Vec3> colours;  ///< huntLab
    Features features;
};

Seen seen(const fabric::Image& image) {
    const int width = image.area.width;
    const int height = image.area.height;
    std::array<Plane, 3> planes;
    planes.fill({width, height, std::vector<float>(image.colour.size())});
    Plane lightness = planes[0];
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        const fabric::Rgba& c = image.colour[i];
        const Vec3 v = yCxCzOf({linear(c.r), linear(c.g), linear(c.b)});
        for (int k = 0; k < 3; ++k)
            planes[static_cast<std::size_t>(k)].values[i] = static_cast<float>(v[k]);
        lightness.values[i] = static_cast<float>((v.x + 16) / 116);
    }
    for (std::size_t k = 0; k < 3; ++k) planes[k] = asSeen(planes[k], kSensitivities[k]);
    Seen result{std::vector<Vec3>(image.colour.size()), featuresOf(lightness)};
    for (std::size_t i = 0; i < result.colours.size(); ++i) {
        const Vec3 rgb =
            rgbOfYCxCz({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
        result.colours[i] = huntLab({std::clamp(rgb.r, 0.0, 1.0), std::clamp(rgb.g, 0.0, 1.0),
                                     std::clamp(rgb.b, 0.0, 1.0)});
    }
    return result;
}

}  // namespace

double meanFlip(const fabric::Image& reference, const fabric::Image& test) {
    const Seen a = seen(reference);
    const Seen b = seen(test);
    double sum = 0;
    for (std::size_t i = 0; i < a.colours.size(); ++i) {
        const double colour = colourDifference(a.colours[i], b.colours[i]);
        const double feature =
            static_cast<double>(std::max(std::abs(a.features.edges[i] - b.features.edges[i]),
                                         std::abs(a.features.points[i] - b.features.points[i])));
        sum += std::pow(colour, 1 - std::pow(feature / std::numbers::sqrt2, kFeaturePower));
    }
    return sum / static_cast<double>(a.colours.size());
}

}  // namespace eyrie::truth
