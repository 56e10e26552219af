// Every lobe that the shaders sample, and their random numbers: chi-square tests against the densities.
#include "probe_fixture.h"
#include "statistics/lobes.h"

namespace peelray {
namespace {

using test::fit_cosine, test::fit_lobe, test::fit_uniform, test::independent_pairs, test::lobe_cases, test::sidak;

/// If all is right, all tests of a kind pass with this chance whatever the seed; the seeds are fixed.
constexpr double level = 0.01;

class LobeProbe : public ProbeTest {
  protected:
    struct In {
        glm::vec3 normal, along;
        float stretch, roughness;
        glm::vec3 view;
        float index;
        glm::vec2 random;
    };

    std::vector<test::LobeSample> sample(const test::LobeCase& lobe, size_t count, uint32_t seed) {
        std::vector<In> in(count, {lobe.normal,
                                   lobe.along,
                                   float(lobe.stretch),
                                   float(lobe.roughness),
                                   lobe.view,
                                   float(test::glass_index),
                                   {}});
        const auto pairs = independent_pairs(count, seed);
        for (size_t i = 0; i < count; i++) in[i].random = pairs[i];
        return probe<test::LobeSample>("probe_lobe", in);
    }
};

TEST_F(LobeProbe, MicrofacetsAndWhatTheyReflectAndRefract) {
    const auto cases = lobe_cases();
    for (size_t i = 0; i < cases.size(); i++)
        for (const auto& [name, mass, fit] : fit_lobe(cases[i], sample(cases[i], 100000, uint32_t(i)))) {
            EXPECT_NEAR(mass, 1, 5e-4) << name << ": the density itself";
            EXPECT_GT(fit.p, sidak(level, 4 * int(cases.size()))) << name << ": " << fit;
        }
}

TEST_F(LobeProbe, DirectionsToTheSky) {
    struct Cosine {
        glm::vec3 normal;
        glm::vec2 random;
    };
    for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::dvec3(0.48, 0.6, 0.64), glm::dvec3(0.6, 0, -0.8)}) {
        std::vector<Cosine> in;
        for (const glm::vec2& pair : independent_pairs(100000, 77)) in.push_back({normal, pair});
        const auto [name, mass, fit] = fit_cosine(normal, probe<glm::vec3>("probe_cosine", in));
        EXPECT_NEAR(mass, 1, 1e-5);
        EXPECT_GT(fit.p, sidak(level, 3)) << fit;
    }
}

/// Over the pixels, for every purpose and for several samples; together with those of the next pixel and of another
/// purpose.
TEST_F(LobeProbe, RandomPairsOfManySeeds) {
    struct In {
        glm::uvec2 pixel;
        uint32_t index, purpose;
    };
    struct Out {
        glm::uvec3 hash;
        glm::vec2 pair;
    };
    const auto pairs = [&](uint32_t index, uint32_t purpose) {
        std::vector<In> in;
        for (uint32_t i = 0; i < 102400; i++) in.push_back({{i % 320, i / 320}, index, purpose});
        std::vector<glm::vec2> out;
        for (const Out& o : probe<Out>("probe_random", in)) out.push_back(o.pair);
        return out;
    };
    const double least = sidak(level, 12);
    for (const uint32_t index : {0u, 1u, 1000u}) {
        const auto facet = pairs(index, 1), sky = pairs(index, 2);
        EXPECT_GT(fit_uniform(facet).p, least) << fit_uniform(facet);
        EXPECT_GT(fit_uniform(sky).p, least) << fit_uniform(sky);
        std::vector<glm::vec2> both, neighbours;
        for (size_t i = 0; i < facet.size(); i++) {
            both.emplace_back(facet[i].x, sky[i].x);
            neighbours.emplace_back(facet[i].x, facet[(i + 1) % facet.size()].x);
        }
        EXPECT_GT(fit_uniform(both).p, least) << fit_uniform(both);
        EXPECT_GT(fit_uniform(neighbours).p, least) << fit_uniform(neighbours);
    }
}

}  // namespace
}  // namespace peelray
