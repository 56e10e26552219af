#include "image/line_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace peelray {
namespace {

constexpr double width = 760, height = 460, left = 72, right = 178, top = 44, bottom = 56;
/// Told apart by those who see no red or green as well (Okabe, Ito 2008).
constexpr std::array<const char*, 8> colors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                               "#E69F00", "#56B4E9", "#000000", "#999999"};

std::string svg_text(const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return out;
}

/// 1500000 → "1.5 M".
std::string tick_text(double value) {
    if (value >= 1e6) return fmt::format("{:g} M", value / 1e6);
    if (value >= 1e4) return fmt::format("{:g} K", value / 1e3);
    return fmt::format("{:g}", value);
}

/// A logarithmic axis over some values.
class Axis {
  public:
    /// `from`, `to`: where it begins and ends in the picture.
    Axis(std::vector<double> values, double from, double to) : from_(from), to_(to) {
        std::sort(values.begin(), values.end());
        const double least = values.empty() ? 1 : values.front(), most = values.empty() ? 10 : values.back();
        const double margin = std::max(0.04 * std::log10(most / least), 0.05);
        low_ = std::log10(least) - margin;
        high_ = std::log10(most) + margin;
    }

    double at(double value) const { return from_ + (std::log10(value) - low_) / (high_ - low_) * (to_ - from_); }

    /// Values to label: 1, 2 and 5 of each decade where there is room, else powers of ten alone.
    std::vector<double> ticks() const {
        std::vector<double> out;
        const bool wide = high_ - low_ > 3;
        for (int decade = int(std::floor(low_)); decade <= int(std::ceil(high_)); decade++)
            for (const double step : {1.0, 2.0, 5.0}) {
                const double value = step * std::pow(10.0, decade), place = std::log10(value);
                if (place >= low_ && place <= high_ && !(wide && step != 1)) out.push_back(value);
            }
        return out;
    }

  private:
    double from_, to_, low_, high_;
};

std::string text_at(double x, double y, const std::string& text, const char* more) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, more, svg_text(text));
}

std::string grid(const Axis& x, const Axis& y) {
    const std::string line = "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>\n";
    std::string out;
    for (const double value : x.ticks()) {
        const double at = x.at(value);
        out += fmt::format(fmt::runtime(line), at, top, at, height - bottom);
        out += text_at(at, height - bottom + 18, tick_text(value), "text-anchor=\"middle\"");
    }
    for (const double value : y.ticks()) {
        const double at = y.at(value);
        out += fmt::format(fmt::runtime(line), left, at, width - right, at);
        out += text_at(left - 7, at + 4, tick_text(value), "text-anchor=\"end\"");
    }
    return out + fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#666\"/>\n",
                             left, top, width - right - left, height - bottom - top);
}

std::string draw(const ChartSeries& series, size_t index, const Axis& x, const Axis& y) {
    const char* color = colors[index % colors.size()];
    // The ninth and later ones repeat the colours, dashed.
    const char* dash = index < colors.size() ? "" : " stroke-dasharray=\"5 3\"";
    std::string line, marks;
    for (const auto& [px, py] : series.points) {
        line += fmt::format("{:.1f},{:.1f} ", x.at(px), y.at(py));
        marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x.at(px), y.at(py), color);
    }
    const double at = top + 12 + 20 * double(index), legend = width - right + 14;
    return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>\n", line, color,
                       dash) +
           marks +
           fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"2\"{}/>\n", legend,
                       at, legend + 22, at, color, dash) +
           text_at(legend + 28, at + 4, series.name, "");
}

}  // namespace

std::string svg_of(const LineChart& chart) {
    std::vector<ChartSeries> drawn;
    std::vector<double> xs, ys;
    for (ChartSeries series : chart.series) {
        std::erase_if(series.points, [](const auto& p) { return !(p.first > 0 && p.second > 0); });
        std::sort(series.points.begin(), series.points.end());
        for (const auto& [x, y] : series.points) xs.push_back(x), ys.push_back(y);
        if (!series.points.empty()) drawn.push_back(std::move(series));
    }
    const Axis x(xs, left, width - right), y(ys, height - bottom, top);
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
        width, height);
    out += text_at(left, 26, chart.title, "font-size=\"15\" font-weight=\"bold\"");
    out += grid(x, y);
    out += text_at((left + width - right) / 2, height - 14, chart.x_label, "text-anchor=\"middle\"");
    out += fmt::format("<g transform=\"translate(18 {:.1f}) rotate(-90)\">{}</g>\n", (top + height - bottom) / 2,
                       text_at(0, 0, chart.y_label, "text-anchor=\"middle\""));
    for (size_t i = 0; i < drawn.size(); i++) out += draw(drawn[i], i, x, y);
    return out + "</svg>\n";
}

}  // namespace peelray
