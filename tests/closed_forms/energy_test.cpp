// Rough surfaces lose nothing: what microfacets hide from each other comes out in the end (Turquin, Practical multiple
// scattering compensation for microfacet models, 2019). Without that the loss is known.
#include <pictures.h>

namespace peelray {
namespace {

class EnergyTest : public PictureTest {
  protected:
    /// Mean light of the pixels wholly on a ball in white surroundings.
    glm::dvec3 ball(const Material& material, const RenderSettings& settings) {
        Stage stage;
        stage.add(sphere({0, 0, 0}, 1, 24), material);
        const RenderResult picture = render(stage, white, settings);
        glm::dvec3 sum(0);
        double count = 0;
        for (const glm::vec4& p : picture.radiance) {
            if (p.w < 1) continue;
            sum += glm::dvec3(p);
            count++;
        }
        EXPECT_GT(count, 0.5 * double(picture.radiance.size()));
        return sum / count;
    }
    RenderSettings many(uint32_t size) {
        RenderSettings settings = settings_for(orthographic({1, 2, 4}, {0, 0, 0}, 2.2f), size);
        settings.spp = 32;
        return settings;
    }
};

TEST_F(EnergyTest, WhiteBodiesOfAnyRoughnessAreInvisible) {
    for (int i = 0; i <= 10; i++) {
        const float roughness = float(i) / 10;
        SCOPED_TRACE(roughness);
        for (const uint32_t spp : {1u, 32u}) {
            SCOPED_TRACE(spp);
            RenderSettings settings = many(24);
            settings.spp = spp;
            Material m = metal("white", glm::vec3(1));
            m.roughness = roughness;
            EXPECT_TRUE(near(ball(m, settings), glm::dvec3(1), 0.01)) << "metal: " << text(ball(m, settings));
            m.metallic = 0;
            EXPECT_TRUE(near(ball(m, settings), glm::dvec3(1), 0.01)) << "dielectric: " << text(ball(m, settings));
            settings.width = settings.height = 16;
            for (Material glass : {thin_glass(), clear_glass()}) {
                glass.roughness = roughness;
                const glm::dvec3 seen = ball(glass, settings);
                EXPECT_TRUE(near(seen, glm::dvec3(1), 0.01)) << "glass " << glass.thickness << ": " << text(seen);
            }
        }
    }
}

/// Of the lobe at this cosine: what a perfect mirror's microfacets keep.
double kept_of(double cosine, double roughness) {
    return ggx_mean(cosine, roughness, [](double) { return 1; });
}
double gain_of(double f0, double cosine, double roughness) {
    const double kept = kept_of(cosine, roughness);
    return 1 + f0 * (1 - kept) / kept;
}

TEST_F(EnergyTest, ColouredMetalIsCompensatedByItsReflectance) {
    const glm::dvec3 color(0.9, 0.5, 0.1);
    for (const double roughness : {0.3, 0.8})
        for (const double cosine : {1.0, 0.5, 0.15}) {
            Material m = metal("copper", glm::vec3(color));
            m.roughness = float(roughness);
            Stage stage;
            stage.add(texture_square(), m);
            for (const bool compensated : {true, false})
                for (const uint32_t spp : {1u, 64u}) {
                    RenderSettings settings = settings_for(slanted(cosine), 12);
                    settings.spp = spp;
                    settings.energy_compensation = compensated;
                    glm::dvec3 want;
                    for (int k = 0; k < 3; k++)
                        want[k] =
                            ggx_mean(cosine, roughness, [&](double c) { return schlick(double(color[k]), 1, c); }) *
                            (compensated ? gain_of(color[k], cosine, roughness) : 1);
                    const glm::dvec3 got = mean_radiance(render(stage, white, settings));
                    EXPECT_TRUE(near(got, want, spp == 1 ? 0.004 : 0.012))
                        << "roughness " << roughness << ", cosine " << cosine << ", compensated " << compensated
                        << ", samples " << spp << ": " << text(got) << ", expected " << text(want);
                }
        }
}

TEST_F(EnergyTest, DielectricIsCompensatedByItsReflectanceStraightOn) {
    const double roughness = 0.7, cosine = 0.5, f0 = std::pow(1.4 / 3.4, 2);
    Material m = lambert({0, 0, 0});
    m.ior = 2.4f;
    m.roughness = float(roughness);
    Stage stage;
    stage.add(texture_square(), m);
    const double want = ggx_mean(cosine, roughness, [](double c) { return fresnel(c, 1, 2.4); });
    for (const bool compensated : {true, false}) {
        RenderSettings settings = settings_for(slanted(cosine), 8);
        settings.energy_compensation = compensated;
        EXPECT_NEAR(mean_radiance(render(stage, white, settings)).x,
                    want * (compensated ? gain_of(f0, cosine, roughness) : 1), 1e-3);
    }
}

TEST_F(EnergyTest, HighlightsAreCompensatedAlike) {
    const double roughness = 0.6, cosine = 0.7, f0 = 0.8;
    Material m = metal("grey", glm::vec3(float(f0)));
    m.roughness = float(roughness);
    Stage stage;
    stage.add(texture_square(), m);
    const glm::dvec3 view = to_slanted(cosine), to_sun = glm::normalize(glm::dvec3(-0.3, 0.4, 1));
    stage.sun(-to_sun, glm::vec3(2));
    const double v_h = glm::dot(view, glm::normalize(view + to_sun));
    const double want = 2 * schlick(f0, 1, v_h) * ggx_lobe(view, to_sun, roughness);
    for (const bool compensated : {true, false}) {
        RenderSettings settings = settings_for(slanted(cosine), 8);
        settings.energy_compensation = compensated;
        EXPECT_NEAR(mean_radiance(render(stage, black, settings)).y,
                    want * (compensated ? gain_of(f0, cosine, roughness) : 1), 2e-3);
    }
}

TEST_F(EnergyTest, HighlightsOnGlassTakeTheirShareOfWhatIsKept) {
    const double roughness = 0.5, cosine = 0.7;
    const glm::dvec3 view = to_slanted(cosine), to_sun = glm::normalize(glm::dvec3(-0.9, 0.4, 1));
    const glm::dvec3 half = glm::normalize(view + to_sun);
    const double v_h = glm::dot(view, half), face = fresnel(v_h, 1, 1.5);
    // Snell's law in vectors.
    const glm::dvec3 refracted = -view / 1.5 + (v_h / 1.5 - std::sqrt(1 - (1 - v_h * v_h) / 2.25)) * half;
    for (const bool thin : {true, false}) {
        Material m = thin ? thin_glass() : clear_glass();
        m.roughness = float(roughness);
        Stage stage;
        stage.add(thin ? texture_square() : box({-1, -1, -0.5f}, {1, 1, 0}), m);
        stage.sun(-to_sun, glm::vec3(2));
        const double reflected = thin ? 2 * face / (1 + face) : face;  // of both faces
        const double onward = smith_masking(thin ? to_sun.z : -refracted.z, roughness);
        const double kept = reflected * smith_masking(to_sun.z, roughness) + (1 - reflected) * onward;
        for (const bool compensated : {true, false}) {
            RenderSettings settings = settings_for(slanted(cosine), 8);
            settings.spp = 4;
            settings.refraction = settings.shadow = false;  // the front alone
            settings.energy_compensation = compensated;
            EXPECT_NEAR(mean_radiance(render(stage, black, settings)).y,
                        2 * reflected * ggx_lobe(view, to_sun, roughness) / (compensated ? kept : 1), 1e-3)
                << "thin " << thin << ", compensated " << compensated;
        }
    }
}

TEST_F(EnergyTest, ThinRoughGlassBlursWhatIsBehind) {
    // Without reflection, seen straight on, the microfacets turn light by twice their slope: its mean direction is
    // that of all of them, those excepted that send it back, which goes along the surface.
    for (const double roughness : {0.2, 0.5}) {
        const double a2 = std::pow(roughness, 4);
        double along = 0;
        const int n = 20000;
        for (int i = 0; i < n; i++) {
            const double u = (i + 0.5) / n, c2 = 1 / (1 + a2 * u / (1 - u));
            along += std::max(0.0, 2 * c2 - 1) / n;
        }
        Stage stage;
        Material m = thin_glass(1);
        m.roughness = float(roughness);
        stage.add(texture_square(), m);
        RenderSettings settings = settings_for(orthographic({0, 0, 4}, {0, 0, 0}, 1), 16);
        const Environment directions = direction_image();
        const auto seen = [&](uint32_t spp) {
            settings.spp = spp;
            return mean_radiance(render(stage, directions, settings));
        };
        EXPECT_TRUE(near(seen(1), light_of({0, 0, -1}), 5e-3)) << text(seen(1));
        for (const bool compensated : {true, false}) {
            settings.energy_compensation = compensated;
            EXPECT_TRUE(near(seen(64), light_of({0, 0, -along}), 5e-3)) << text(seen(64)) << ", expected " << along;
        }
    }
}

TEST_F(EnergyTest, ThinRoughGlassReflectsWhatItsMicrofacetsReflect) {
    // Seen straight on, before a black wall: the microfacets that send light along the surface reflect their share,
    // too.
    for (const double roughness : {0.3, 0.7, 1.0}) {
        const double a2 = std::pow(roughness, 4);
        double want = 0;
        const int n = 20000;
        for (int i = 0; i < n; i++) {
            const double u = (i + 0.5) / n, face = fresnel(1 / std::sqrt(1 + a2 * u / (1 - u)), 1, 1.5);
            want += 2 * face / (1 + face) / n;
        }
        Material m = thin_glass();
        m.roughness = float(roughness);
        Stage stage;
        stage.add(texture_square(), m);
        stage.add(box({-50, -50, -2}, {50, 50, -1e-3f}), lambert({0, 0, 0}));
        RenderSettings settings = settings_for(orthographic({0, 0, 4}, {0, 0, 0}, 1), 16);
        settings.spp = 32;
        EXPECT_NEAR(mean_radiance(render(stage, white, settings)).y, want, 0.01) << roughness;
    }
}

}  // namespace
}  // namespace peelray
