// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/silhouette.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace eyrie::truth {
namespace {

/// Larger than any squared distance in a picture, and still exact with one added to it.
constexpr double kFar = 1e12;

/// For each place of a line the least of (place - p)^2 + line[p] over all p: the lower envelope of
/// parabolas. `apexes` and `starts` are room for as many entries as the line has, and one more.
void transformLine(std::vector<double>& line, std::vector<std::size_t>& apexes,
                   std::vector<double>& starts, std::vector<double>& out) {
    const auto crossing = [&](std::size_t p, std::size_t q) {
        const auto a = static_cast<double>(p);
        const auto b = static_cast<double>(q);
        return (line[q] + b * b - line[p] - a * a) / (2 * (b - a));
    };
    std::size_t count = 0;
    for (std::size_t q = 0; q < line.size(); ++q) {
        while (count > 0 && crossing(apexes[count - 1], q) <= starts[count - 1]) --count;
        starts[count] = count == 0 ? -kFar : crossing(apexes[count - 1], q);
        apexes[count++] = q;
    }
    std::size_t k = 0;
    for (std::size_t at = 0; at < line.size(); ++at) {
        while (k + 1 < count && starts[k + 1] < static_cast<double>(at)) ++k;
        const double aside = static_cast<double>(at) - static_cast<double>(apexes[k]);
        out[at] = aside * aside + line[apexes[k]];
    }
}

class Masks {
public:
    Masks(std::size_t width, std::size_t height) : width_(width), height_(height) {}

    /// The farthest that a pixel of `from` is from any of `to`; the diagonal if that is empty.
    template <typename From, typename To>
    double farthest(const From& from, const To& to) const {
        std::vector<double> squared(width_ * height_);
        for (std::size_t i = 0; i < squared.size(); ++i) squared[i] = to(i) ? 0 : kFar;
        alongLines(squared, width_, height_, 1, width_);
        alongLines(squared, height_, width_, width_, 1);
        double most = 0;
        for (std::size_t i = 0; i < squared.size(); ++i)
            if (from(i))
                most = std::max(most, squared[i]);
        const auto w = static_cast<double>(width_);
        const auto h = static_cast<double>(height_);
        return std::sqrt(std::min(most, w * w + h * h));
    }

private:
    static void alongLines(std::vector<double>& squared, std::size_t length, std::size_t lines,
                           std::size_t step, std::size_t lineStep) {
        std::vector<double> line(length);
        std::vector<double> out(length);
        std::vector<double> starts(length + 1);
        std::vector<std::size_t> apexes(length + 1);
        for (std::size_t k = 0; k < lines; ++k) {
            for (std::size_t i = 0; i < length; ++i) line[i] = squared[k * lineStep + i * step];
            transformLine(line, apexes, starts, out);
            for (std::size_t i = 0; i < length; ++i) squared[k * lineStep + i * step] = out[i];
        }
    }

    std::size_t width_;
    std::size_t height_;
};

}  // namespace

double silhouettePixels(const ReferenceView& view, std::span<const float> depth) {
    const auto isDrawn = [&](std::size_t i) { return std::isfinite(depth[i]); };
    const auto mayBeHit = [&](std::size_t i) { return view.hits[i].first != kNoHit; };
    const auto isHit = [&](std::size_t i) { return view.hits[i].last != kNoHit; };
    const Masks masks(static_cast<std::size_t>(view.camera.width()),
                      static_cast<std::size_t>(view.camera.height()));
    return std::max(masks.farthest(isDrawn, mayBeHit), masks.farthest(isHit, isDrawn));
}

}  // namespace eyrie::truth
