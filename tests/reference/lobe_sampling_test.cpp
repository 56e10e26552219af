// Every lobe that the reference samples: chi-square tests against the densities.
#include <gtest/gtest.h>

#include "reference/optics.h"
#include "scene/picture.h"
#include "statistics/lobes.h"

namespace peelray::optics {
namespace {

using test::fit_cosine, test::fit_lobe, test::fit_uniform, test::independent_pairs, test::lobe_cases, test::sidak;

/// If all is right, all tests of a kind pass with this chance whatever the seed; the seeds are fixed.
constexpr double level = 0.01;

std::vector<test::LobeSample> sample(const test::LobeCase& c, size_t count, uint32_t seed) {
    const Lobe lobe = c.stretch > 0 ? Lobe(c.normal, c.along, c.alpha) : Lobe(c.normal, c.alpha.x);
    std::vector<test::LobeSample> samples;
    for (const glm::vec2& random : independent_pairs(count, seed)) {
        const glm::dvec3 h = lobe.sample(c.view, random);
        const auto entering = refract_ray(-c.view, h, test::glass_index);
        const auto leaving = refract_ray(-c.view, h, 1 / test::glass_index);
        samples.push_back({h, 2 * glm::dot(c.view, h) * h - c.view, entering.value_or(glm::dvec3(0)),
                           leaving.value_or(glm::dvec3(0)), entering.has_value(), leaving.has_value()});
    }
    return samples;
}

TEST(LobeSampling, MicrofacetsAndWhatTheyReflectAndRefract) {
    const auto cases = lobe_cases();
    for (size_t i = 0; i < cases.size(); i++)
        for (const auto& [name, mass, fit] : fit_lobe(cases[i], sample(cases[i], 100000, uint32_t(i)))) {
            EXPECT_NEAR(mass, 1, 5e-4) << name << ": the density itself";
            EXPECT_GT(fit.p, sidak(level, 4 * int(cases.size()))) << name << ": " << fit;
        }
}

TEST(LobeSampling, DensitiesAreTheLobes) {
    // What the reference evaluates is what it samples: the same formulas as the tests', written apart.
    for (const test::LobeCase& c : lobe_cases()) {
        const Lobe lobe = c.stretch > 0 ? Lobe(c.normal, c.along, c.alpha) : Lobe(c.normal, c.alpha.x);
        for (const test::LobeSample& s : sample(c, 100, 1)) {
            const glm::dvec3 h(s.half);
            const double density =
                lobe.masking(c.view) * lobe.distribution(h) * glm::dot(c.view, h) / glm::dot(c.view, c.normal);
            EXPECT_NEAR(test::visible_density(c, h) / density, 1, 1e-9) << c.name;
        }
    }
}

TEST(LobeSampling, DirectionsToTheSky) {
    for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::dvec3(0.48, 0.6, 0.64), glm::dvec3(-0.36, 0.48, -0.8)}) {
        std::vector<glm::vec3> directions;
        for (const glm::vec2& pair : independent_pairs(100000, 77))
            directions.push_back(cosine_direction(normal, pair));
        const auto [name, mass, fit] = fit_cosine(normal, directions);
        EXPECT_NEAR(mass, 1, 1e-5);
        EXPECT_GT(fit.p, sidak(level, 3)) << fit;
    }
}

/// More even than chance.
TEST(LobeSampling, PlacesInThePixelAreUniform) {
    std::vector<glm::vec2> places;
    for (uint32_t i = 0; i < 100000; i++) places.push_back(sample_position(i));
    EXPECT_GT(fit_uniform(places).p, 0.999);
}

}  // namespace
}  // namespace peelray::optics
