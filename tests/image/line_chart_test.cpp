#include "image/line_chart.h"

#include <gtest/gtest.h>

#include <regex>

namespace peelray {
namespace {

size_t count(const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) found++;
    return found;
}

/// The corners of a picture's lines of data, from the left.
std::vector<std::vector<std::pair<double, double>>> lines_of(const std::string& svg) {
    std::vector<std::vector<std::pair<double, double>>> lines;
    const std::regex line("<polyline points=\"([^\"]*)\""), corner("([0-9.]+),([0-9.]+) ");
    for (auto it = std::sregex_iterator(svg.begin(), svg.end(), line); it != std::sregex_iterator(); ++it) {
        const std::string points = (*it)[1];
        lines.emplace_back();
        for (auto p = std::sregex_iterator(points.begin(), points.end(), corner); p != std::sregex_iterator(); ++p)
            lines.back().emplace_back(std::stod((*p)[1]), std::stod((*p)[2]));
    }
    return lines;
}

TEST(LineChart, BothAxesAreLogarithmic) {
    const std::string svg = svg_of(
        {"Speed", "triangles", "ms", {{"ours", {{1e4, 4}, {1e6, 1}, {1e5, 2}}}, {"theirs", {{1e4, 1}, {1e6, 4}}}}});
    EXPECT_TRUE(svg.starts_with("<svg xmlns=")) << svg.substr(0, 80);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    const auto lines = lines_of(svg);
    ASSERT_EQ(lines.size(), 2u);
    ASSERT_EQ(lines[0].size(), 3u);
    // Tenfold more triangles are as far apart everywhere, and so is half the time; points are in order.
    EXPECT_NEAR(lines[0][1].first - lines[0][0].first, lines[0][2].first - lines[0][1].first, 0.2);
    EXPECT_NEAR(lines[0][1].second - lines[0][0].second, lines[0][2].second - lines[0][1].second, 0.2);
    EXPECT_GT(lines[0][2].first, lines[0][0].first);
    EXPECT_GT(lines[0][2].second, lines[0][0].second);  // less is lower, and y counts downwards
    EXPECT_NEAR(lines[1][0].second, lines[0][2].second, 0.2);
    for (const char* part : {"Speed", "triangles", "ms", "ours", "theirs", "1 M", "100 K"})
        EXPECT_EQ(count(svg, std::string(">") + part + "<"), 1u) << part;
}

TEST(LineChart, WhatHasNoLogarithmIsLeftOut) {
    const std::string svg =
        svg_of({"", "", "", {{"a<b & c", {{1, 1}, {2, 0}, {-3, 4}, {4, 2}}}, {"nothing", {{0, 1}}}}});
    const auto lines = lines_of(svg);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].size(), 2u);
    EXPECT_NE(svg.find("a&lt;b &amp; c"), std::string::npos);
    EXPECT_EQ(svg.find("nothing"), std::string::npos);
}

TEST(LineChart, OnePointOrNoneIsAPictureToo) {
    EXPECT_EQ(count(svg_of({"t", "x", "y", {{"one", {{5, 7}}}}}), "<circle"), 1u);
    const std::string empty = svg_of({"t", "x", "y", {}});
    EXPECT_EQ(count(empty, "<circle"), 0u);
    for (const std::string& svg : {empty, svg_of({"t", "x", "y", {{"one", {{5, 7}}}}})})
        EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace peelray
