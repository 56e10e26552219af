// Microfacets and random numbers: distributions against quadrature.
#include <array>

#include "probe_fixture.h"
#include "reference/random_numbers.h"

namespace peelray {
namespace {

using glm::dvec3;
using glm::uvec2;
using glm::uvec3;
using glm::vec2;
using glm::vec3;

constexpr double kPi = 3.14159265358979323846;

struct GgxIn {
    vec3 view;
    float alpha;
    vec2 random;
};
struct GgxOut {
    vec3 half_vector;
    float density, masking;
};
struct RandomIn {
    uvec2 pixel;
    uint32_t level, index, bits, purpose, picture;
};
struct RandomOut {
    uvec3 hash;
    uint32_t branch;
    vec2 pair;
};

class SamplingProbe : public ProbeTest {
  protected:
    /// A grid of count² jittered points in the unit square: little noise, no help from the code under test.
    std::vector<GgxIn> samples(const vec3& view, float alpha, int count) {
        std::vector<GgxIn> in;
        for (int y = 0; y < count; y++)
            for (int x = 0; x < count; x++)
                in.push_back(
                    {view, alpha,
                     glm::min(vec2((x + uniform(0, 1)) / count, (y + uniform(0, 1)) / count), vec2(0.99999994f))});
        return in;
    }
};

double distribution(double cosine, double alpha) {
    const double tan2 = 1 / (cosine * cosine) - 1;
    return 1 / (kPi * alpha * alpha * std::pow(cosine, 4) * std::pow(1 + tan2 / (alpha * alpha), 2));
}
/// Smith's masking by way of Lambda.
double masking(double cosine, double alpha) {
    const double tan2 = 1 / (cosine * cosine) - 1;
    return 1 / (1 + 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1));
}
vec3 view_at(double cosine, double phi) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return vec3(sine * std::cos(phi), sine * std::sin(phi), cosine);
}

/// Sums f(half vector, weight) over the hemisphere, the weights being solid angles. The polar step follows GGX, so that
/// mirrors are resolved as well.
template <typename F>
void integrate(double alpha, F&& f) {
    const int rings = 600, slices = 300;
    for (int i = 0; i < rings; i++) {
        const auto cosine = [&](double u) { return std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)); };
        const double low = cosine((i + 1.0) / rings), high = cosine(double(i) / rings), c = cosine((i + 0.5) / rings),
                     s = std::sqrt(1 - c * c);
        for (int k = 0; k < slices; k++) {
            const double phi = 2 * kPi * (k + 0.5) / slices;
            f(dvec3(s * std::cos(phi), s * std::sin(phi), c), (high - low) * 2 * kPi / slices);
        }
    }
}

TEST_F(SamplingProbe, NormalsAreUnitAndUpAtTheEdges) {
    std::vector<GgxIn> in;
    for (const float alpha : {1e-4f, 0.0025f, 0.1f, 0.5f, 1.0f})
        for (const double cosine : {1e-3, 0.01, 0.5, 0.9999, 1.0})
            for (const float x : {0.0f, 1e-7f, 0.3f, 0.99999994f})
                for (const float y : {0.0f, 0.25f, 0.5f, 0.7f, 0.99999994f})
                    in.push_back({view_at(cosine, 7 * x + y), alpha, {x, y}});
    const auto out = probe<GgxOut>("probe_ggx", in);
    for (size_t i = 0; i < in.size(); i++) {
        const dvec3 h(out[i].half_vector);
        ASSERT_NEAR(glm::length(h), 1, 2e-6) << i;
        ASSERT_GT(h.z, 0) << i;
        ASSERT_GE(glm::dot(h, dvec3(in[i].view)), -2e-3) << i << ": a visible normal faces the viewer";
        ASSERT_TRUE(std::isfinite(out[i].density) && out[i].density > 0);
        ASSERT_NEAR(out[i].masking, masking(in[i].view.z, in[i].alpha), 2e-5) << i;
    }
}

TEST_F(SamplingProbe, DensityIsGgxAndIntegratesToOne) {
    for (const float alpha : {0.05f, 0.3f, 1.0f}) {
        const auto in = samples(vec3(0, 0, 1), alpha, 100);
        const auto out = probe<GgxOut>("probe_ggx", in);
        for (const auto& o : out)
            ASSERT_NEAR(o.density / distribution(o.half_vector.z, alpha), 1, 3e-4 / (alpha * alpha));
        double sum = 0;
        integrate(alpha,
                  [&](const dvec3& h, double solid_angle) { sum += distribution(h.z, alpha) * h.z * solid_angle; });
        EXPECT_NEAR(sum, 1, 1e-2);
    }
}

TEST_F(SamplingProbe, FromAboveTheHistogramIsTheAnalyticOne) {
    for (const float alpha : {0.02f, 0.25f, 1.0f}) {
        const auto out = probe<GgxOut>("probe_ggx", samples(vec3(0, 0, 1), alpha, 200));
        std::array<int, 20> polar{}, azimuth{};
        for (const auto& o : out) {
            const dvec3 h(o.half_vector);
            // The cumulative distribution of the polar angle under D·cosine is uniform in [0, 1].
            const double c2 = h.z * h.z, u = (1 - c2) / (1 + (double(alpha) * alpha - 1) * c2);
            polar[size_t(std::clamp(u * 20, 0.0, 19.0))]++;
            azimuth[size_t(std::clamp((std::atan2(h.y, h.x) / (2 * kPi) + 0.5) * 20, 0.0, 19.0))]++;
        }
        for (int k = 0; k < 20; k++) {
            EXPECT_NEAR(polar[size_t(k)], 2000, 150) << "alpha " << alpha << " bin " << k;
            EXPECT_NEAR(azimuth[size_t(k)], 2000, 150) << "alpha " << alpha << " bin " << k;
        }
    }
}

TEST_F(SamplingProbe, ObliqueNormalsAreVisibleNormals) {
    for (const float alpha : {0.1f, 0.4f, 1.0f})
        for (const double cosine : {0.1, 0.4, 0.8}) {
            const vec3 view = view_at(cosine, 1.1);
            const dvec3 v(view);
            // Means of the half vector, and of its squares: D_v(h) = G1(v) max(0, v·h) D(h) / v.z.
            dvec3 mean(0), square(0), got(0), got_square(0);
            double mass = 0;
            integrate(alpha, [&](const dvec3& h, double solid_angle) {
                const double weight =
                    masking(v.z, alpha) * std::max(0.0, glm::dot(v, h)) * distribution(h.z, alpha) / v.z * solid_angle;
                mass += weight;
                mean += weight * h;
                square += weight * h * h;
            });
            EXPECT_NEAR(mass, 1, 1e-2) << "the reference itself";
            const auto out = probe<GgxOut>("probe_ggx", samples(view, alpha, 200));
            for (const auto& o : out)
                got += dvec3(o.half_vector), got_square += dvec3(o.half_vector) * dvec3(o.half_vector);
            for (int k = 0; k < 3; k++) {
                EXPECT_NEAR(got[k] / double(out.size()), mean[k] / mass, 6e-3)
                    << "alpha " << alpha << " cosine " << cosine << " axis " << k;
                EXPECT_NEAR(got_square[k] / double(out.size()), square[k] / mass, 6e-3)
                    << "alpha " << alpha << " cosine " << cosine << " axis " << k;
            }
        }
}

TEST_F(SamplingProbe, WhiteFurnaceLosesLightButNeverGainsAny) {
    for (const float alpha : {0.05f, 0.3f, 1.0f})
        for (const double cosine : {0.05, 0.3, 1.0}) {
            const vec3 view = view_at(cosine, 0.3);
            const dvec3 v(view);
            const auto out = probe<GgxOut>("probe_ggx", samples(view, alpha, 200));
            double sum = 0;
            for (const auto& o : out) {
                const dvec3 h(o.half_vector), l = 2 * glm::dot(v, h) * h - v;
                if (l.z > 0) sum += masking(l.z, alpha);  // G2/G1, separable: what one sample weighs
            }
            const double albedo = sum / double(out.size());
            EXPECT_LE(albedo, 1 + 1e-6);
            // The same by quadrature of D·G1(v)·G1(l)/(4 v.z) over directions: dl = 4 (v·h) dh.
            double expected = 0;
            integrate(alpha, [&](const dvec3& h, double solid_angle) {
                const double v_h = glm::dot(v, h);
                const dvec3 l = 2 * v_h * h - v;
                if (v_h > 0 && l.z > 0)
                    expected +=
                        distribution(h.z, alpha) * masking(v.z, alpha) * masking(l.z, alpha) * v_h / v.z * solid_angle;
            });
            EXPECT_NEAR(albedo, expected, 1.5e-2) << "alpha " << alpha << " cosine " << cosine;
        }
}

/// Bit for bit: a picture does not depend on who draws its random numbers.
TEST_F(SamplingProbe, RandomNumbersAreTheReferences) {
    std::vector<RandomIn> in{{{0, 0}, 0, 0, 0, 0, 0}, {{1, 2}, 0, 0, 0, 3, 0}, {{5, 7}, 1, 65535, 16, 2, 9}};
    for (int i = 0; i < 1000; i++) {
        const uint32_t width = bits() % 17;
        in.push_back({{bits(), bits()}, bits() % 17, bits() & ((1u << width) - 1), width, bits(), bits()});
    }
    const auto out = probe<RandomOut>("probe_random", in);
    for (size_t i = 0; i < in.size(); i++) {
        const RandomIn& x = in[i];
        ASSERT_EQ(out[i].hash, hash3({x.pixel, x.purpose}));
        const uint32_t pixel = path_seed(x.pixel.x, x.pixel.y), branch = branch_seed(pixel, x.level & 3, x.level);
        ASSERT_EQ(out[i].branch, branch);
        const PixelSample sample{x.index, x.bits, x.picture};
        ASSERT_EQ(glm::dvec2(out[i].pair), random_pair(x.level == 0 ? pixel : branch, x.level, x.purpose, sample));
    }
}

}  // namespace
}  // namespace peelray
