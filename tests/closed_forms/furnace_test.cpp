// Bodies in uniform light: what is lost or made up shows at once.
#include <pictures.h>

namespace peelray {
namespace {

class FurnaceTest : public PictureTest {
  protected:
    /// Light of the ball's pixels in a white environment.
    Tally ball(const Material& material, double low, double high, RenderSettings settings) {
        Stage stage;
        stage.add(sphere({0, 0, 0}, 1, 24), material);
        const RenderResult picture = render(stage, white, settings);
        Tally result;
        for (uint32_t y = 0; y < picture.height; y++)
            for (uint32_t x = 0; x < picture.width; x++) {
                const glm::dvec3 got = radiance_at(picture, x, y);
                bool right = true;
                for (int c = 0; c < 3; c++) right &= got[c] >= low && got[c] <= high;
                if (picture.radiance[y * picture.width + x].w > 0)
                    result.add(right, [&] { return fmt::format("pixel {},{}: {}", x, y, text(got)); });
            }
        return result;
    }
    const RenderSettings settings_ = settings_for(perspective({0.5f, 0.7f, 3}, {0, 0, 0}, 45), 96);
};

TEST_F(FurnaceTest, WhiteDiffuseBallStaysWhite) {
    ball(lambert({1, 1, 1}), 0.99, 1.01, settings_).expect(0, 4000);
}

TEST_F(FurnaceTest, NoDielectricGainsLight) {
    for (float roughness : {0.f, 0.1f, 0.3f, 0.6f, 1.f}) {
        SCOPED_TRACE(roughness);
        Material m;
        m.roughness = roughness;
        ball(m, 0.9, 1.01, settings_).expect(0, 4000);
    }
}

TEST_F(FurnaceTest, MirrorBallIsInvisible) {
    ball(plane_mirror(), 0.999, 1.001, settings_).expect(0, 4000);
}

TEST_F(FurnaceTest, ClearGlassBallIsInvisible) {
    RenderSettings settings = settings_;
    for (uint32_t bounces : {2u, 8u, 12u}) {
        settings.bounces = bounces;
        ball(clear_glass(), 0.98, 1.001, settings).expect(0, 4000);
    }
}

TEST_F(FurnaceTest, ThinGlassBallIsInvisible) {
    ball(thin_glass(), 0.98, 1.001, settings_).expect(0, 4000);
}

/// Mean over the pixels that lie wholly on a ball and are not seen too obliquely, and what it should be: the mean of
/// the albedos, which are those at the cosines 0.01, 0.02, ..., 1.
std::pair<glm::dvec3, glm::dvec3> ball_means(const RenderResult& picture, const glm::dvec3& to_viewer,
                                             const std::vector<glm::dvec3>& steps) {
    glm::dvec3 got(0), want(0);
    double count = 0;
    for (size_t i = 0; i < picture.radiance.size(); i++) {
        const double cosine = glm::dot(glm::dvec3(picture.aovs.normal[i]), to_viewer) * 100;
        if (picture.radiance[i].w < 1 || cosine < 5) continue;
        const size_t lower = std::min(size_t(cosine), size_t(99));
        got += glm::dvec3(picture.radiance[i]);
        want += glm::mix(steps[lower - 1], steps[lower], cosine - double(lower));
        count++;
    }
    EXPECT_GT(count, 500);
    return {got / count, want / count};
}

TEST_F(FurnaceTest, RoughBallIsAsBrightAtOneSampleAsAtMany) {
    const Camera camera = orthographic({1, 2, 4}, {0, 0, 0}, 2.2f);
    const glm::dvec3 to_viewer = glm::normalize(glm::dvec3(1, 2, 4));
    const auto expect_means = [&](const Material& material, auto albedo, double tolerance) {
        Stage stage;
        stage.add(sphere({0, 0, 0}, 1, 24), material);
        std::vector<glm::dvec3> albedos;
        for (int i = 1; i <= 100; i++) albedos.push_back(albedo(i / 100.0));
        for (uint32_t spp : {1u, 64u}) {
            RenderSettings settings = settings_for(camera, 40);
            settings.spp = spp;
            settings.aovs = true;
            settings.energy_compensation = false;  // energy_test.cpp
            const auto [got, want] = ball_means(render(stage, white, settings), to_viewer, albedos);
            EXPECT_TRUE(near(got, want, tolerance)) << spp << " samples: " << text(got) << ", expected " << text(want);
        }
    };
    for (double roughness : {0.06, 0.4, 1.0}) {
        SCOPED_TRACE(roughness);
        Material red = metal("red", {1, 0.2f, 0});
        red.roughness = float(roughness);
        expect_means(
            red,
            [&](double cosine) {
                const auto of = [&](double f0) {
                    return ggx_mean(cosine, roughness, [&](double c) { return schlick(f0, 1, c); });
                };
                return glm::dvec3(of(1), of(0.2), of(0));
            },
            0.006);
        for (double ior : {1.5, 2.4}) {
            SCOPED_TRACE(ior);
            Material black_body;
            black_body.base_color = glm::vec3(0);
            black_body.roughness = float(roughness);
            black_body.ior = float(ior);
            expect_means(
                black_body,
                [&](double cosine) {
                    return glm::dvec3(ggx_mean(cosine, roughness, [&](double c) { return fresnel(c, 1, ior); }));
                },
                0.002);
        }
        Material specular;
        specular.base_color = glm::vec3(0);
        specular.roughness = float(roughness);
        specular.specular = 0.5f;
        specular.specular_color = {4, 1, 0};
        expect_means(
            specular,
            [&](double cosine) {
                const auto of = [&](double color) {
                    return ggx_mean(cosine, roughness, [&](double c) { return schlick(0.02 * color, 0.5, c); });
                };
                return glm::dvec3(of(4), of(1), of(0));
            },
            0.002);
    }
}

TEST_F(FurnaceTest, RoughSurfaceKeepsItsLightAtGrazingAngles) {
    for (double roughness : {0.3, 0.7, 1.0})
        for (double cosine : {0.95, 0.6, 0.3, 0.1, 0.04}) {
            Stage stage;
            Material m = plane_mirror();
            m.roughness = float(roughness);
            stage.add(ground(50), m);
            const float sine = float(std::sqrt(1 - cosine * cosine));
            RenderSettings settings = settings_for(orthographic({20 * sine, float(20 * cosine), 0}, {0, 0, 0}, 1), 16);
            settings.energy_compensation = false;
            for (uint32_t spp : {1u, 48u}) {
                settings.spp = spp;
                const RenderResult picture = render(stage, white, settings);
                double mean = 0;
                for (const glm::vec4& p : picture.radiance) mean += p.x / double(picture.radiance.size());
                EXPECT_NEAR(mean, ggx_mean(cosine, roughness, [](double) { return 1; }), spp == 1 ? 0.004 : 0.01)
                    << "roughness " << roughness << ", cosine " << cosine << ", samples " << spp;
            }
        }
}

TEST_F(FurnaceTest, WhiteDielectricLosesNothing) {
    // What is not reflected is scattered: with one sample exactly so at every pixel.
    for (float roughness : {0.f, 0.06f, 0.4f, 0.7f, 1.f})
        for (float ior : {1.f, 1.5f, 2.4f}) {
            SCOPED_TRACE(fmt::format("roughness {}, index {}", roughness, ior));
            Material m;
            m.roughness = roughness;
            m.ior = ior;
            ball(m, 0.999, 1.001, settings_).expect(0, 4000);
        }
}

TEST_F(FurnaceTest, InfiniteIndexReflectsAll) {
    Material m;
    m.base_color = glm::vec3(0);
    m.roughness = 0;
    m.ior = 0;
    ball(m, 0.999, 1.001, settings_).expect(0, 4000);
    m.transmission = 1;  // nothing gets in
    ball(m, 0.999, 1.001, settings_).expect(0, 4000);
    m.thickness = 1;
    ball(m, 0.999, 1.001, settings_).expect(0, 4000);
    m.base_color = glm::vec3(1);
    ball(m, 0.999, 1.001, settings_).expect(0, 4000);
    m.transmission = 0;
    m.roughness = 0.7f;
    ball(m, 0.999, 1.001, settings_).expect(0, 4000);  // the diffuse part gives back what masking takes
    // Samples scatter around the mean; without a diffuse part none gains light.
    m.base_color = glm::vec3(0);
    RenderSettings many = settings_;
    many.spp = 16;
    many.energy_compensation = false;
    ball(m, 0, 1.001, many).expect(0, 4000);
}

TEST_F(FurnaceTest, SpecularStatesTheReflection) {
    // KHR_materials_specular: Schlick's from min(((n - 1) / (n + 1))² color, 1) factor to the factor, for each channel.
    Stage stage;
    Material m;
    m.base_color = glm::vec3(0);
    m.roughness = 0;
    stage.add(ground(50), m);
    Material& made = stage.scene.materials[0];
    for (float ior : {0.f, 1.f, 1.5f, 1000.f})
        for (float factor : {0.f, 0.25f, 1.f})
            for (const glm::vec3& color : {glm::vec3(0.04f, 0.5f, 0), glm::vec3(1, 2, 30)})
                for (double cosine : {1.0, 0.5, 0.1}) {
                    made.ior = ior;
                    made.specular = factor;
                    made.specular_color = color;
                    const float sine = float(std::sqrt(1 - cosine * cosine));
                    const RenderSettings settings = settings_for(
                        orthographic({5 * sine, float(5 * cosine), 0}, {0, 0, 0}, 1, {-cosine, sine, 0}), 4);
                    const double normal = ior == 0 ? 1 : std::pow((ior - 1.0) / (ior + 1.0), 2);
                    glm::dvec3 want;
                    for (int k = 0; k < 3; k++)
                        want[k] = schlick(std::min(normal * color[k], 1.0) * factor, factor, cosine);
                    EXPECT_TRUE(near(radiance_at(render(stage, white, settings), 1, 1), want, 1e-4))
                        << "index " << ior << ", factor " << factor << ", cosine " << cosine << ": " << text(want);
                }
}

TEST_F(FurnaceTest, SpecularGlassLosesNothing) {
    for (float thickness : {0.f, 1.f})
        for (float factor : {0.f, 0.3f}) {
            Material m = clear_glass();
            m.thickness = thickness;
            m.specular = factor;
            m.specular_color = {1, 0.5f, 3};
            RenderSettings settings = settings_;
            settings.bounces = 12;
            ball(m, 0.98, 1.001, settings).expect(0, 4000);
        }
}

TEST_F(FurnaceTest, EmissionIsShownExactly) {
    Stage stage;
    Material lamp = lambert({0, 0, 0});
    lamp.emissive = {7, 0.25f, 1000};
    stage.add(ground(3), lamp);
    const Camera camera = from_above(2);
    tally(render(stage, black, settings_for(camera, 16)), camera, 1e-4, [](const ViewRay&) {
        return glm::dvec3(7, 0.25, 1000);
    }).expect(0, 256);
}

TEST_F(FurnaceTest, UnlitIgnoresAllLight) {
    Stage stage;
    stage.add(ground(3), unlit({0.3f, 0.6f, 2}));
    stage.sun({0, -1, 0}, {9, 9, 9});
    const Camera camera = from_above(2);
    tally(render(stage, white, settings_for(camera, 16)), camera, 1e-6, [](const ViewRay&) {
        return glm::dvec3(0.3f, 0.6f, 2);
    }).expect(0, 256);
}

TEST_F(FurnaceTest, AmbientRaysKnowAPit) {
    // A round pit of radius 0.5, 1 deep, black walls: its bottom's middle sees r² / (r² + h²) of a white sky.
    Stage stage;
    std::vector<std::vector<glm::vec3>> sides;
    const auto rim = [](int i, float radius, float y) {
        const double a = 2 * kPi * i / 64;
        return glm::vec3(radius * std::cos(a), y, radius * std::sin(a));
    };
    for (int i = 0; i < 64; i++) {
        sides.push_back({rim(i, 0.5f, -1), rim(i + 1, 0.5f, -1), rim(i + 1, 0.5f, 0), rim(i, 0.5f, 0)});
        sides.push_back({rim(i, 0.5f, 0), rim(i + 1, 0.5f, 0), rim(i + 1, 3, 0), rim(i, 3, 0)});
    }
    stage.add(faces(sides), lambert({1, 1, 1}));
    stage.add(disc({0, -1, 0}, 0.5f, 64), lambert({1, 1, 1}));
    const Camera camera = from_above(4);
    RenderSettings settings = settings_for(camera, 40);
    settings.spp = 48;
    const auto mean = [&](const RenderResult& picture, auto&& where) {
        double sum = 0, count = 0;
        for (uint32_t y = 0; y < 40; y++)
            for (uint32_t x = 0; x < 40; x++)
                if (where(std::hypot((x + 0.5) * 0.1 - 2, (y + 0.5) * 0.1 - 2)))
                    sum += radiance_at(picture, x, y).y, count++;
        return sum / count;
    };
    const auto middle = [](double r) { return r < 0.15; };
    const auto open = [](double r) { return r > 0.7; };
    const RenderResult plain = render(stage, white, settings);
    EXPECT_NEAR(mean(plain, middle), 1, 0.01);
    settings.ambient = true;
    const RenderResult occluded = render(stage, white, settings);
    EXPECT_NEAR(mean(occluded, open), 1, 0.01);
    EXPECT_NEAR(mean(occluded, middle), 0.2, 0.03);
    EXPECT_GE(occluded.rays.ambient, 40u * 40u * 48u);
}

}  // namespace
}  // namespace peelray
