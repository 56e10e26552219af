// Line charts as SVG: both axes logarithmic, a legend, units in the labels.
#pragma once

#include <string>
#include <vector>

namespace peelray {

struct ChartSeries {
    std::string name;
    std::vector<std::pair<double, double>> points;  ///< those that are not above 0 are left out
};

struct LineChart {
    std::string title, x_label, y_label;
    std::vector<ChartSeries> series;  ///< at most eight have colours of their own
};

/// A whole SVG file; readable in any browser, without scripts or fonts of its own.
std::string svg_of(const LineChart& chart);

}  // namespace peelray
