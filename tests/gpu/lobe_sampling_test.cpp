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

    template <typename Out>
    std::vector<Out> sample(std::string_view shader, const test::LobeCase& lobe, size_t count, uint32_t seed) {
        In first{lobe.normal, lobe.along, float(lobe.stretch), float(lobe.roughness), lobe.view};
        first.index = float(test::glass_index);
        std::vector<In> in(count, first);
        const auto pairs = independent_pairs(count, seed);
        for (size_t i = 0; i < count; i++) in[i].random = pairs[i];
        return probe<Out>(shader, in);
    }
};

TEST_F(LobeProbe, MicrofacetsAndWhatTheyReflectAndRefract) {
    const auto cases = lobe_cases();
    for (size_t i = 0; i < cases.size(); i++)
        for (const auto& [name, mass, fit] :
             fit_lobe(cases[i], sample<test::LobeSample>("probe_lobe", cases[i], 100000, uint32_t(i)))) {
            EXPECT_NEAR(mass, 1, 5e-4) << name << ": the density itself";
            EXPECT_GT(fit.p, sidak(level, 4 * int(cases.size()))) << name << ": " << fit;
        }
}

TEST_F(LobeProbe, LampsSeeTheLobeThatIsSampled) {
    struct Out {
        glm::vec3 half;
        float highlight, masking;
    };
    for (const test::LobeCase& lobe : lobe_cases())
        for (const Out& o : sample<Out>("probe_highlight", lobe, 1000, 3)) {
            const glm::dvec3 h(o.half);
            if (o.masking == 0) {
                ASSERT_EQ(o.highlight, 0) << lobe.name << ": reflected into the surface";
                continue;
            }
            // Density of the reflected direction, and what masking leaves of a sample.
            const double density = test::visible_density(lobe, h) / (4 * glm::dot(lobe.view, h));
            // The half vector's rounding counts for more the narrower the lobe is.
            const double rounding = 1e-6 / (lobe.alpha.x * lobe.alpha.y);
            ASSERT_NEAR(o.highlight / (density * o.masking), 1, 1e-4 + rounding) << lobe.name;
        }
}

TEST_F(LobeProbe, DirectionsToTheSky) {
    struct Cosine {
        glm::vec3 normal;
        glm::vec2 random;
    };
    for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::dvec3(0.48, 0.6, 0.64), glm::dvec3(-0.36, 0.48, -0.8)}) {
        std::vector<Cosine> in;
        for (const glm::vec2& pair : independent_pairs(100000, 77)) in.push_back({normal, pair});
        const auto [name, mass, fit] = fit_cosine(normal, probe<glm::vec3>("probe_cosine", in));
        EXPECT_NEAR(mass, 1, 1e-5);
        EXPECT_GT(fit.p, sidak(level, 3)) << fit;
    }
}

}  // namespace
}  // namespace peelray
