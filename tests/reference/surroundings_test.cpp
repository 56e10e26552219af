// Directions drawn by an environment's light: their density, and that they follow it.
#include "reference/surroundings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics/chi_square.h"
#include "statistics/lobes.h"
#include "statistics/sphere_cells.h"

namespace peelray {
namespace {

using test::pi;

/// A gradient with a bright spot, black in the lowest rows.
Environment image(uint32_t width, uint32_t height, float spot) {
    std::vector<glm::vec4> pixels;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            pixels.push_back(4 * y > 3 * height ? glm::vec4(0) : glm::vec4(float(x + 1) / width, 0.5f, 0.2f, 1));
    pixels[size_t(height / 3) * width + width / 5] = glm::vec4(spot, spot, spot / 2, 1);
    Environment environment = image_environment(width, height, pixels);
    environment.distribution = EnvironmentDistribution(environment);
    return environment;
}

std::vector<Environment> environments() {
    std::vector<Environment> all{image(64, 32, 2000), image(100, 37, 300), image(7, 3, 5), color_environment({1, 2, 3}),
                                 color_environment(glm::vec3(0))};
    for (Environment& environment : all) environment.distribution = EnvironmentDistribution(environment);
    return all;
}

/// Sums over rectangles of the map, `cells` times 2 · `cells` of them, from points that lie on no cell's edge.
std::vector<double> integrate(const Surroundings& surroundings, uint32_t cells, uint32_t points) {
    std::vector<double> sums(size_t(cells) * cells * 2);
    const uint32_t rows = cells * points;
    for (uint32_t j = 0; j < rows; j++) {
        const double theta = (j + 0.5) * pi / rows;
        const double area = (std::cos(j * pi / rows) - std::cos((j + 1) * pi / rows)) * pi / rows;
        for (uint32_t i = 0; i < 2 * rows; i++) {
            const double phi = ((i + 0.5) / (2 * rows) - 0.5) * 2 * pi;
            const glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            sums[size_t(j / points) * 2 * cells + i / points] += area * surroundings.density(d);
        }
    }
    return sums;
}

TEST(Surroundings, DrawnDirectionsFollowTheDensity) {
    constexpr uint32_t cells = 16;
    uint32_t seed = 1;
    for (const Environment& environment : environments()) {
        SCOPED_TRACE(environment.width);
        const Surroundings surroundings(environment);
        const uint32_t rows = 1u << environment.distribution.depth;
        std::vector<double> expected = integrate(surroundings, cells, std::max(1u, rows / cells));
        double mass = 0;
        for (const double e : expected) mass += e;
        EXPECT_NEAR(mass, 1, 1e-6);
        constexpr size_t count = 100000;
        std::vector<uint32_t> observed(expected.size());
        glm::dvec3 light(0), all(0);
        for (const glm::vec2& pair : test::independent_pairs(count, seed++)) {
            const auto [direction, density, place] = surroundings.draw(pair);
            EXPECT_NEAR(glm::length(direction), 1, 1e-12);
            // Or it has been rounded beyond an edge.
            const double again = surroundings.density(direction);
            EXPECT_TRUE(std::abs(density / again - 1) < 1e-9 || density == 0) << density << ", " << again;
            const double phi = std::atan2(direction.x, -direction.z), theta = std::acos(direction.y);
            const auto column = uint32_t(std::clamp((phi / (2 * pi) + 0.5) * 2 * cells, 0.0, 2 * cells - 1.0));
            observed[uint32_t(std::clamp(theta / pi * cells, 0.0, cells - 1.0)) * 2 * cells + column]++;
            light += surroundings.radiance(direction, 0) / density / double(count);
        }
        for (double& e : expected) e *= double(count) / mass;
        const test::ChiSquare fit = test::chi_square(observed, expected);
        EXPECT_GT(fit.p, test::sidak(0.01, 5)) << fit;
        // Mean of light over density: all the light.
        for (uint32_t j = 0; j < 512; j++)
            for (uint32_t i = 0; i < 1024; i++) {
                const double theta = (j + 0.5) / 512 * pi, phi = i / 1024.0 * 2 * pi;
                const glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
                all += surroundings.radiance(d, 0) * std::sin(theta) * 2.0 * pi * pi / (512.0 * 1024);
            }
        for (int k = 0; k < 3; k++) EXPECT_NEAR(light[k], all[k], 0.01 * all[k] + 1e-9);
    }
}

TEST(Surroundings, NoDirectionWeighsMuch) {
    // Cells are as large as the image's texels: what varies within them is all that the density misses. Beside the spot
    // light rises from 0 at a cell's middle to a quarter in its corner, where the mean is a quarter of a quarter of it.
    const Environment environment = image(64, 32, 2000);
    const Surroundings surroundings(environment);
    double mean = 0, most = 0;
    for (const glm::vec2& pair : test::independent_pairs(10000, 9)) {
        const auto [direction, density, place] = surroundings.draw(pair);
        const glm::dvec3 light = surroundings.radiance(direction, 0);
        const double weight = (light.x + light.y + light.z) / 3 / density;
        mean += weight / 10000;
        most = std::max(most, weight);
    }
    EXPECT_LT(most, 17 * mean);
}

}  // namespace
}  // namespace peelray
