// SPDX-License-Identifier: Apache-2.0
#include "bench/simulator/plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace eyrie::simulator {
namespace {

constexpr double kWidth = 420;
constexpr double kHeight = 260;
constexpr double kLeft = 60;
constexpr double kTop = 50;
constexpr std::array<const char*, 6> kColours = {"#2563eb", "#dc2626", "#16a34a",
                                                 "#9333ea", "#ea580c", "#475569"};

/// Both axes by powers of two.
class Panel {
public:
    Panel(double x, const std::vector<Curve>& curves) : x_(x) {
        for (const Curve& curve : curves)
            for (const auto& [renderers, value] : curve.points) {
                most_ = std::max(most_, std::log2(renderers));
                low_ = std::min(low_, std::floor(std::log2(value)));
                high_ = std::max(high_, std::ceil(std::log2(value)));
            }
        high_ = std::max(high_, low_ + 1);
    }

    std::string draw(const std::string& title, const std::vector<Curve>& curves) const {
        std::string svg = fmt::format("<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text>\n",
                                      x_, kTop - 12, title);
        for (double value = low_; value <= high_; ++value)
            svg += fmt::format(
                "<path d=\"M{0} {1}h{2}\" stroke=\"#e2e8f0\"/><text x=\"{3}\" y=\"{4}\" "
                "text-anchor=\"end\">{5:g}</text>\n",
                x_, y(value), kWidth, x_ - 6, y(value) + 4, std::exp2(value));
        for (double renderers = 0; renderers <= most_; ++renderers)
            svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{:g}</text>\n",
                               x(renderers), kTop + kHeight + 16, std::exp2(renderers));
        for (std::size_t i = 0; i < curves.size(); ++i) {
            std::string path;
            for (const auto& [renderers, value] : curves[i].points)
                path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L",
                                    x(std::log2(renderers)), y(std::log2(value)));
            svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n",
                               path, kColours[i % kColours.size()]);
        }
        return svg;
    }

private:
    double x(double renderers) const { return x_ + kWidth * renderers / std::max(most_, 1.0); }
    double y(double value) const { return kTop + kHeight * (high_ - value) / (high_ - low_); }

    double x_;
    double most_ = 0;
    double low_ = 1e9;
    double high_ = -1e9;
};

}  // namespace

std::string plot(const std::string& title, const std::vector<Curve>& milliseconds,
                 const std::vector<Curve>& speedups) {
    constexpr double kSecond = kLeft + kWidth + 80;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
        "{1}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#0f172a\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        "<text x=\"{2}\" y=\"20\" font-size=\"14\">{3}</text>\n",
        kSecond + kWidth + 30, kTop + kHeight + 60, kLeft, title);
    svg += Panel(kLeft, milliseconds).draw("milliseconds a frame", milliseconds);
    svg += Panel(kSecond, speedups).draw("frames a second, for each of one renderer's", speedups);
    for (std::size_t i = 0; i < speedups.size(); ++i)
        svg += fmt::format(
            "<path d=\"M{0} {1}h24\" stroke=\"{2}\" stroke-width=\"2\"/><text x=\"{3}\" "
            "y=\"{4}\">{5}</text>\n",
            kLeft + 150 * static_cast<double>(i), kTop + kHeight + 40,
            kColours[i % kColours.size()], kLeft + 150 * static_cast<double>(i) + 30,
            kTop + kHeight + 44, speedups[i].name);
    return svg + "</svg>\n";
}

}  // namespace eyrie::simulator
