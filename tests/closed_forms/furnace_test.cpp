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

TEST_F(FurnaceTest, RoughMetalIsNeitherBlackNorBright) {
    for (float roughness : {0.2f, 0.5f, 1.f}) {
        SCOPED_TRACE(roughness);
        Material grey = metal("grey", {0.9f, 0.9f, 0.9f});
        grey.roughness = roughness;
        ball(grey, 0.4, 1.001, settings_).expect(0, 4000);
        // A saturated colour: the channels at 0 must not pull the whole pixel down.
        Material red = metal("red", {1, 0, 0});
        red.roughness = roughness;
        Stage stage;
        stage.add(sphere({0, 0, 0}, 1, 24), red);
        const RenderResult picture = render(stage, white, settings_);
        EXPECT_GT(radiance_at(picture, 48, 48).x, 0.4);
        EXPECT_LT(radiance_at(picture, 48, 48).y, 0.1);
    }
}

/// Share of white light that a GGX metal of reflectance 1 reflects towards a direction, by quadrature over its
/// microfacets.
double ggx_albedo(double cosine, double alpha) {
    const auto masking = [&](double c) { return 2 * c / (c + std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c)); };
    const glm::dvec3 view(std::sqrt(1 - cosine * cosine), 0, cosine);
    double sum = 0;
    const int n = 200;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const double theta = (i + 0.5) / n * kPi / 2, phi = (j + 0.5) / n * 2 * kPi, c = std::cos(theta),
                         k = c * c * (alpha * alpha - 1) + 1;
            const glm::dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), c);
            const double v_h = glm::dot(view, h), n_l = 2 * v_h * c - cosine;
            if (v_h <= 0 || n_l <= 0) continue;
            sum += alpha * alpha / (kPi * k * k) * masking(cosine) * masking(n_l) * v_h / cosine * std::sin(theta);
        }
    return sum * (kPi / 2 / n) * (2 * kPi / n);
}

TEST_F(FurnaceTest, SampledRoughMetalKeepsItsLight) {
    Stage stage;
    Material m = plane_mirror();
    m.roughness = 0.7f;
    stage.add(ground(50), m);
    for (double cosine : {0.95, 0.6, 0.3}) {
        const float sine = float(std::sqrt(1 - cosine * cosine));
        RenderSettings settings = settings_for(orthographic({5 * sine, float(5 * cosine), 0}, {0, 0, 0}, 1), 24);
        settings.spp = 32;
        const RenderResult picture = render(stage, white, settings);
        double mean = 0;
        for (const glm::vec4& p : picture.radiance) mean += p.x / double(picture.radiance.size());
        EXPECT_NEAR(mean, ggx_albedo(cosine, 0.49), 0.01) << cosine;
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
