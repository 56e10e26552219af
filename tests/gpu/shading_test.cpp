// Fresnel, refraction, frames and colour against double precision.
#include "probe_fixture.h"

namespace peelray {
namespace {

using glm::dvec3;
using glm::vec3;

class ShadingProbe : public ProbeTest {};

// --- Colour ---

struct Colors {
    vec3 linear, srgb, aces, neutral;
};

double srgb_to_linear(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
double linear_to_srgb(double c) {
    return c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

TEST_F(ShadingProbe, SrgbCurvesBothWays) {
    std::vector<vec3> in;
    for (int i = 0; i <= 3000; i++) in.emplace_back(float(i) / 3000, float(i % 256) / 255, std::exp2(-float(i) / 200));
    for (const float c : {0.0f, 0.0031308f, 0.0031309f, 0.04045f, 0.04046f, 1.0f}) in.emplace_back(c);
    const auto out = probe<Colors>("probe_color", in);
    std::vector<vec3> encoded;
    for (size_t i = 0; i < in.size(); i++) {
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(out[i].linear[k], srgb_to_linear(in[i][k]), 2e-6) << in[i][k];
            ASSERT_NEAR(out[i].srgb[k], linear_to_srgb(in[i][k]), 2e-6) << in[i][k];
        }
        encoded.push_back(out[i].srgb);
    }
    const auto back = probe<Colors>("probe_color", encoded);
    for (size_t i = 0; i < in.size(); i++)
        for (int k = 0; k < 3; k++) ASSERT_NEAR(back[i].linear[k], in[i][k], 4e-6);
}

TEST_F(ShadingProbe, ToneCurvesAreMonotoneAndBounded) {
    std::vector<vec3> grey{vec3(0)};
    for (int i = 0; i < 4000; i++) grey.emplace_back(std::exp2(-12 + 32 * float(i) / 4000));
    const auto out = probe<Colors>("probe_color", grey);
    EXPECT_EQ(out[0].aces, vec3(0));
    EXPECT_EQ(out[0].neutral, vec3(0));
    for (size_t i = 1; i < grey.size(); i++)
        for (int k = 0; k < 3; k++) {
            ASSERT_GE(out[i].aces[k], out[i - 1].aces[k] - 1e-6f);
            ASSERT_GE(out[i].neutral[k], out[i - 1].neutral[k] - 1e-6f);
            ASSERT_TRUE(out[i].aces[k] >= 0 && out[i].aces[k] <= 1 && out[i].neutral[k] >= 0 && out[i].neutral[k] <= 1);
        }
    EXPECT_GT(out.back().neutral.x, 0.99f);
    EXPECT_EQ(out.back().aces.x, 1);
    // Narkowicz' curve at middle grey and at white.
    const auto known = probe<Colors>("probe_color", std::vector<vec3>{vec3(0.18f), vec3(1)});
    EXPECT_NEAR(known[0].aces.x, 0.18 * (2.51 * 0.18 + 0.03) / (0.18 * (2.43 * 0.18 + 0.59) + 0.14), 1e-6);
    EXPECT_NEAR(known[1].aces.x, 2.54 / 3.16, 1e-6);
}

TEST_F(ShadingProbe, TheNeutralCurveKeepsColoursUpToItsShoulder) {
    std::vector<vec3> in;
    for (int i = 0; i < 20000; i++) in.push_back(glm::abs(point(0, i % 2 ? 0.8 : 20)));
    const auto out = probe<Colors>("probe_color", in);
    int kept = 0, compressed = 0;
    for (size_t i = 0; i < in.size(); i++) {
        const dvec3 c(in[i]);
        // The specification: less 4 % of Fresnel reflection, in the dark less 6.25 x² of the smallest component.
        const double least = std::min({c.x, c.y, c.z}), offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
        const double peak = std::max({c.x, c.y, c.z}) - offset;
        const dvec3 got(out[i].neutral);
        if (peak < 0.76) {
            kept++;
            for (int k = 0; k < 3; k++) ASSERT_NEAR(got[k], c[k] - offset, 1e-6);
            continue;
        }
        compressed++;
        const double new_peak = 1 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
        ASSERT_NEAR(std::max({got.x, got.y, got.z}), new_peak, 2e-6)
            << "brightness is compressed, the peak keeps its channel";
        // Desaturation moves every channel towards the peak, by the same share.
        const double share = 1 - 1 / (0.15 * (peak - new_peak) + 1);
        for (int k = 0; k < 3; k++)
            ASSERT_NEAR(got[k], (c[k] - offset) * new_peak / peak * (1 - share) + new_peak * share, 1e-5);
    }
    EXPECT_GT(kept, 5000);
    EXPECT_GT(compressed, 5000);
}

// --- Fresnel and refraction ---

struct Incidence {
    vec3 incoming, normal;
    float eta;
};
struct Optics {
    float reflectance, schlick;
    uint32_t refracts;
    vec3 refracted;
};

/// From the amplitudes r_s and r_p with angles, not with the shader's algebra. n: index behind / before.
double fresnel(double angle, double n) {
    const double sine = std::sin(angle) / n;
    if (sine >= 1) return 1;
    const double behind = std::asin(sine);
    if (angle < 1e-6) return std::pow((n - 1) / (n + 1), 2);
    const double s = std::sin(angle - behind) / std::sin(angle + behind),
                 p = std::tan(angle - behind) / std::tan(angle + behind);
    return 0.5 * (s * s + p * p);
}

TEST_F(ShadingProbe, FresnelAtKnownAngles) {
    const double half_pi = 1.57079632679489662;
    std::vector<Incidence> in;
    std::vector<double> angles;
    for (const float eta : {1.5f, 1 / 1.5f, 1.33f, 1 / 1.33f, 2.42f, 1 / 2.42f, 1.0001f})
        for (int i = 0; i <= 500; i++) {
            angles.push_back(half_pi * i / 500);
            in.push_back({vec3(std::sin(angles.back()), 0, -std::cos(angles.back())), vec3(0, 0, 1), eta});
        }
    const auto out = probe<Optics>("probe_fresnel", in);
    for (size_t i = 0; i < in.size(); i++) {
        const double eta = in[i].eta, sine = std::sin(angles[i]) / eta;
        // Steep where total reflection begins and at grazing incidence.
        const double tolerance = 2e-5 + 1e-3 * (std::abs(sine - 1) < 1e-2) + 1e-3 * (angles[i] > 1.54);
        const double expected = angles[i] > half_pi - 1e-9 ? 1 : fresnel(angles[i], eta);
        ASSERT_NEAR(out[i].reflectance, expected, tolerance) << "eta " << eta << " angle " << angles[i];
        if (i % 501 == 0) {
            EXPECT_NEAR(out[i].reflectance, std::pow((eta - 1) / (eta + 1), 2), 1e-7) << "normal incidence";
        }
        const double m = 1 - std::cos(angles[i]);
        EXPECT_NEAR(out[i].schlick, 0.04 + 0.96 * std::pow(m, 5), 1e-6);
        if (std::abs(sine - 1) > 1e-6) {
            ASSERT_EQ(out[i].refracts, uint32_t(sine < 1));
        }
    }
    // Brewster's angle: no parallel light; what is left is half of the perpendicular.
    for (const double eta : {1.5, 1 / 1.5, 1.33}) {
        const double angle = std::atan(eta), perpendicular = std::cos(2 * angle);
        const auto at = probe<Optics>(
            "probe_fresnel",
            std::vector<Incidence>{{vec3(std::sin(angle), 0, -std::cos(angle)), vec3(0, 0, 1), float(eta)}});
        EXPECT_NEAR(at[0].reflectance, 0.5 * perpendicular * perpendicular, 1e-6);
    }
}

TEST_F(ShadingProbe, RefractionObeysSnell) {
    std::vector<Incidence> in;
    for (int i = 0; i < 20000; i++) {
        const dvec3 n = unit();
        dvec3 d = unit();
        if (glm::dot(d, n) > 0) d = -d;
        in.push_back({vec3(d), vec3(n), float(i % 2 ? uniform(1, 2.5) : 1 / uniform(1, 2.5))});
    }
    const auto out = probe<Optics>("probe_fresnel", in);
    int total = 0;
    for (size_t i = 0; i < in.size(); i++) {
        const dvec3 d = glm::normalize(dvec3(in[i].incoming)), n = glm::normalize(dvec3(in[i].normal)),
                    r(out[i].refracted);
        const double sine = glm::length(glm::cross(d, n)) / in[i].eta;
        if (std::abs(sine - 1) < 1e-5) continue;
        ASSERT_EQ(out[i].refracts, uint32_t(sine < 1));
        if (sine > 1) {
            total++;
            ASSERT_EQ(out[i].refracted, vec3(0));
            ASSERT_EQ(out[i].reflectance, 1);
            continue;
        }
        ASSERT_NEAR(glm::length(r), 1, 1e-6);
        ASSERT_LE(glm::dot(r, n), 0) << "on the other side";
        ASSERT_NEAR(glm::length(glm::cross(r, n)), sine, 1e-6 + 1e-6 / std::sqrt(1 - sine)) << "Snell";
        ASSERT_NEAR(glm::dot(glm::cross(d, n), r), 0, 2e-6) << "in the plane of incidence";
        ASSERT_GE(glm::dot(glm::cross(d, n), glm::cross(r, n)), -1e-6) << "not bent across the normal";
    }
    EXPECT_GT(total, 1500);
}

// --- Frames ---

struct FrameIn {
    vec3 normal, geometric, direction;
};
struct FrameOut {
    vec3 t, b, visible, above;
};

TEST_F(ShadingProbe, TangentsAreAnOrthonormalFrame) {
    std::vector<FrameIn> in;
    for (const vec3& n : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, -1, 0), vec3(1, 0, -0.0f),
                          vec3(1e-4f, 0, -1), vec3(0, 1e-7f, -1)})
        in.push_back({n, n, n});
    for (int i = 0; i < 20000; i++) in.push_back({vec3(unit()), vec3(0, 0, 1), vec3(0, 0, 1)});
    const auto out = probe<FrameOut>("probe_frames", in);
    for (size_t i = 0; i < in.size(); i++) {
        const dvec3 n(in[i].normal), t(out[i].t), b(out[i].b);
        ASSERT_NEAR(glm::length(t), 1, 2e-6);
        ASSERT_NEAR(glm::length(b), 1, 2e-6);
        ASSERT_NEAR(glm::dot(t, n), 0, 2e-6);
        ASSERT_NEAR(glm::dot(b, n), 0, 2e-6);
        ASSERT_NEAR(glm::dot(glm::cross(t, b), n), 1, 5e-6) << "right-handed";
    }
}

TEST_F(ShadingProbe, BentNormalsAreVisibleAndLiftedDirectionsLeave) {
    std::vector<FrameIn> in;
    for (int i = 0; i < 20000; i++) {
        dvec3 geometric = unit(), direction = unit();
        const dvec3 normal = i % 100 == 0 ? -direction : i % 100 == 1 ? direction : unit();
        if (i % 100 == 2) direction = -geometric;
        in.push_back({vec3(normal), vec3(geometric), vec3(direction)});
    }
    const auto out = probe<FrameOut>("probe_frames", in);
    int bent = 0, lifted = 0;
    for (size_t i = 0; i < in.size(); i++) {
        const dvec3 n(in[i].normal), g(in[i].geometric), d(in[i].direction), v(out[i].visible), a(out[i].above);
        ASSERT_NEAR(glm::length(v), 1, 1e-6);
        ASSERT_NEAR(glm::length(a), 1, 1e-6);
        if (glm::dot(n, d) >= 1.01e-3)
            ASSERT_EQ(out[i].visible, in[i].normal);
        else if (glm::dot(n, d) < 0.99e-3) {
            bent++;
            ASSERT_GE(glm::dot(v, d), 0.9e-3) << i;
            // No more than needed: still in the plane of normal and viewer.
            ASSERT_NEAR(glm::dot(glm::cross(n, d), v), 0, 2e-6);
        }
        if (glm::dot(d, g) >= 1.01e-3)
            ASSERT_EQ(out[i].above, in[i].direction);
        else if (glm::dot(d, g) < 0.99e-3) {
            lifted++;
            ASSERT_GE(glm::dot(a, g), 0.9e-3) << i;
            ASSERT_NEAR(glm::dot(glm::cross(d, g), a), 0, 2e-6);
        }
    }
    EXPECT_GT(bent, 8000);
    EXPECT_GT(lifted, 8000);
}

}  // namespace
}  // namespace peelray
