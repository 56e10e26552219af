// Light that is found by drawing directions to it: EnvironmentMode::sampled, and lamps with a size. Its mean is what
// integrals over the whole sphere say.
#include <pictures.h>

#include "lobes.h"

namespace peelray {
namespace {

/// A mean over pictures of several seeds, and its standard error.
struct Estimate {
    glm::dvec3 mean{0}, error{0};
    /// Four standard errors are exceeded by chance once in some thousand.
    void expect(const glm::dvec3& want, double tolerance) const {
        for (int k = 0; k < 3; k++)
            EXPECT_NEAR(mean[k], want[k], 4 * error[k] + tolerance * want[k]) << "colour " << k << ", " << error[k];
    }
};

/// A surface whose normal is +z, and what it sends to a viewer of light from a direction, times the cosine.
struct Finish {
    std::string name;
    Material material;
    std::function<glm::dvec3(const glm::dvec3& view, const glm::dvec3& to_light)> sends;
};

class SampledLightTest : public PictureTest {
  protected:
    static constexpr double cosine_ = 0.6;

    static Environment with_distribution(Environment environment) {
        environment.distribution = EnvironmentDistribution(environment);
        return environment;
    }
    static RenderSettings sampled_settings(const Camera& camera, uint32_t size, uint32_t spp = 1) {
        RenderSettings settings = settings_for(camera, size);
        settings.env_mode = EnvironmentMode::sampled;
        settings.spp = spp;
        return settings;
    }
    Estimate estimate(const Stage& stage, const Environment& environment, RenderSettings settings, uint32_t seeds) {
        Estimate all;
        glm::dvec3 squares(0);
        for (settings.seed = 0; settings.seed < seeds; settings.seed++) {
            const glm::dvec3 mean = mean_radiance(render(stage, environment, settings));
            all.mean += mean / double(seeds);
            squares += mean * mean / double(seeds);
        }
        all.error = glm::sqrt(glm::max(squares - all.mean * all.mean, glm::dvec3(0)) / (seeds - 1.0));
        return all;
    }
    static Stage square_of(const Material& material) {
        Stage stage;
        stage.add(brushed_square(), material);
        return stage;
    }
};

// --- An environment with a small bright spot before the surface and one behind it ---

constexpr uint32_t kWidth = 32, kHeight = 16;

Environment spots() {
    std::vector<glm::vec4> pixels;
    for (uint32_t y = 0; y < kHeight; y++)
        for (uint32_t x = 0; x < kWidth; x++)
            pixels.push_back(
                glm::vec4(glm::vec3(light_of(environment_direction((x + 0.5f) / kWidth, (y + 0.5f) / kHeight))), 1));
    pixels[7 * kWidth + 4] = {60, 50, 40, 1};  // about where a mirror would show it
    pixels[5 * kWidth + 16] = {20, 5, 30, 1};  // behind
    return image_environment(kWidth, kHeight, pixels);
}

/// Between the texels' centres.
glm::dvec3 looked_up(const Environment& environment, double x, double y) {
    const int left = int(std::floor(x - 0.5)), top = int(std::floor(y - 0.5));
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    const auto texel = [&](int column, int row) {
        return glm::dvec3(environment.texels[size_t(std::clamp(row, 0, int(kHeight) - 1)) * kWidth +
                                             size_t((column + int(kWidth)) % int(kWidth))]);
    };
    return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), fx),
                    glm::mix(texel(left, top + 1), texel(left + 1, top + 1), fx), fy);
}

/// What comes back of the environment's light: a sum over directions all over the sphere.
glm::dvec3 integral(const Environment& environment, const Finish& finish, const glm::dvec3& view) {
    constexpr uint32_t across = 512, down = across / 2;
    glm::dvec3 sum(0);
    for (uint32_t j = 0; j < down; j++)
        for (uint32_t i = 0; i < across; i++) {
            const double u = (i + 0.5) / across, v = (j + 0.5) / down, phi = (u - 0.5) * 2 * kPi, theta = v * kPi;
            const glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            sum += finish.sends(view, d) * looked_up(environment, u * kWidth, v * kHeight) * std::sin(theta);
        }
    return sum * 2.0 * kPi * kPi / double(across * down);
}

// --- Surfaces ---

const glm::dvec3 kColor(0.8, 0.5, 0.2);

double above(const glm::dvec3& direction) {
    return std::max(direction.z, 0.0);
}
double v_h(const glm::dvec3& view, const glm::dvec3& to_light) {
    return glm::dot(view, glm::normalize(view + to_light));
}

Finish lambertian() {
    return {"diffuse", lambert(glm::vec3(kColor)),
            [](const glm::dvec3&, const glm::dvec3& l) { return kColor * above(l) / kPi; }};
}

Finish rough_metal(double roughness = 0.3) {
    Finish finish{"metal", metal("gold", glm::vec3(kColor)), {}};
    finish.material.roughness = float(roughness);
    finish.sends = [roughness](const glm::dvec3& v, const glm::dvec3& l) {
        if (l.z <= 0) return glm::dvec3(0);
        glm::dvec3 fresnel;
        for (int k = 0; k < 3; k++) fresnel[k] = schlick(kColor[k], 1, v_h(v, l));
        return fresnel * ggx_lobe(v, l, roughness);
    };
    return finish;
}

Finish dielectric(double roughness, double cosine) {
    Finish finish{"dielectric", lambert(glm::vec3(kColor)), {}};
    finish.material.roughness = float(roughness);
    finish.material.ior = 1.5f;
    const double left = 1 - ggx_mean(cosine, roughness, [](double c) { return fresnel(c, 1, 1.5); });
    finish.sends = [=](const glm::dvec3& v, const glm::dvec3& l) {
        if (l.z <= 0) return glm::dvec3(0);
        return fresnel(v_h(v, l), 1, 1.5) * ggx_lobe(v, l, roughness) + left * kColor * l.z / kPi;
    };
    return finish;
}

/// It lets no light through, so that only what it mirrors is seen.
Finish dark_glass() {
    Finish finish{"glass", thin_glass(), {}};
    finish.material.roughness = 0.3f;
    finish.material.base_color = glm::vec3(0);
    finish.sends = [](const glm::dvec3& v, const glm::dvec3& l) {
        if (l.z <= 0) return glm::dvec3(0);
        const double face = fresnel(v_h(v, l), 1, 1.5);
        return glm::dvec3(2 * face / (1 + face) * ggx_lobe(v, l, 0.3));
    };
    return finish;
}

Finish coated(double cosine) {
    const Finish below = rough_metal(0.6);
    Finish finish{"coat", below.material, {}};
    finish.material.clearcoat = 0.8f;
    finish.material.coat_roughness = 0.25f;
    const auto mirrored = [](double c) { return 0.8 * schlick(0.04, 1, c); };
    const double left = 1 - ggx_mean(cosine, 0.25, mirrored);
    finish.sends = [=](const glm::dvec3& v, const glm::dvec3& l) {
        if (l.z <= 0) return glm::dvec3(0);
        return left * below.sends(v, l) + mirrored(v_h(v, l)) * ggx_lobe(v, l, 0.25);
    };
    return finish;
}

Finish cloth(double cosine) {
    const glm::dvec3 color(0.3, 0.6, 0.9);
    Finish finish{"sheen", lambert(glm::vec3(kColor)), {}};
    finish.material.sheen_color = glm::vec3(color);
    finish.material.sheen_roughness = 0.5f;
    const double left = 1 - 0.9 * fibre_albedo(0.5, cosine);
    finish.sends = [=](const glm::dvec3& v, const glm::dvec3& l) {
        return l.z > 0 ? (left * kColor / kPi + color * fibres(0.5, v, l)) * l.z : glm::dvec3(0);
    };
    return finish;
}

Finish leaf_of_paper() {
    const glm::dvec3 behind(0.1, 0.6, 0.9);
    Finish finish{"seeping", lambert(glm::vec3(kColor)), {}};
    finish.material.diffuse_transmission = 0.25f;
    finish.material.diffuse_transmission_color = glm::vec3(behind);
    finish.sends = [=](const glm::dvec3&, const glm::dvec3& l) {
        return (l.z > 0 ? 0.75 * kColor * l.z : 0.25 * behind * -l.z) / kPi;
    };
    return finish;
}

Finish brushed_steel() {
    Finish finish{"stretched", metal("steel", glm::vec3(1)), {}};
    finish.material.roughness = 0.3f;
    finish.material.anisotropy = 0.6f;
    finish.material.anisotropy_rotation = 0.5f;
    finish.sends = [lobe = TwoWidths(0.3, 0.6, 0.5)](const glm::dvec3& v, const glm::dvec3& l) {
        return glm::dvec3(l.z > 0 ? lobe.lobe(v, l) : 0);
    };
    return finish;
}

std::vector<Finish> finishes(double cosine) {
    return {lambertian(),   rough_metal(), dielectric(0.4, cosine), dielectric(0.8, cosine), dark_glass(),
            coated(cosine), cloth(cosine), leaf_of_paper(),         brushed_steel()};
}

TEST_F(SampledLightTest, MeanIsTheIntegralOverTheSphere) {
    const Environment environment = with_distribution(spots());
    ASSERT_EQ(environment.lights.size(), 1u);  // which must not count twice
    for (const Finish& finish : finishes(cosine_)) {
        SCOPED_TRACE(finish.name);
        RenderSettings settings = sampled_settings(slanted(cosine_), 16);
        settings.energy_compensation = false;
        const glm::dvec3 want = integral(environment, finish, to_slanted(cosine_));
        const Estimate got = estimate(square_of(finish.material), environment, settings, 16);
        got.expect(want, 2e-3);
        EXPECT_LT(got.error.y, 0.02 * want.y);
        settings.bounces = 0;  // lobes that no ray follows see the environment
        estimate(square_of(finish.material), environment, settings, 16).expect(want, 2e-3);
    }
}

TEST_F(SampledLightTest, WhiteSurfacesLoseNothing) {
    Material glossy, paper = lambert({1, 1, 1}), varnished = lambert({1, 1, 1}), velvet = lambert({1, 1, 1});
    glossy.roughness = 0.5f;
    paper.diffuse_transmission = 0.4f;
    varnished.clearcoat = 0.7f;
    varnished.coat_roughness = 0.3f;
    velvet.sheen_color = {1, 1, 1};
    velvet.sheen_roughness = 0.4f;
    Material steel = plane_mirror(), brushed = plane_mirror();
    steel.roughness = 0.5f;
    brushed.roughness = 0.3f;
    brushed.anisotropy = 0.5f;
    const Environment everywhere = with_distribution(white);
    for (const Material& m : {lambert({1, 1, 1}), glossy, paper, varnished, velvet, steel, brushed})
        for (const double cosine : {0.8, 0.3}) {
            SCOPED_TRACE(fmt::format("sheen {}, coat {}, metal {}, stretch {}, cosine {}", m.sheen_color.x, m.clearcoat,
                                     m.metallic, m.anisotropy, cosine));
            double want = 1;
            if (m.anisotropy > 0) {
                // Energy is compensated as of the round lobe that masks the viewer as much.
                const TwoWidths lobe(m.roughness, m.anisotropy, 0);
                const glm::dvec3 view = to_slanted(cosine);
                want = lobe.kept(view) / ggx_mean(cosine, lobe.mean_roughness(view), [](double) { return 1; });
            }
            estimate(square_of(m), everywhere, sampled_settings(slanted(cosine), 32), 6).expect(glm::dvec3(want), 4e-3);
        }
}

TEST_F(SampledLightTest, EnvironmentIsBehindWhatIsInTheWay) {
    // A black disc of radius 1 at height 1 hides half of the cosine's weight from the point below its middle.
    Stage stage;
    Material chalk = lambert({1, 1, 1});
    chalk.occlusion_texture = 0;  // says that nothing arrives, which rays know better
    stage.scene.textures = {two_texels({0, 0, 0}, {0, 0, 0})};
    Primitive floor = ground(8);
    floor.uvs.assign(floor.positions.size(), {0, 0});
    stage.add(floor, chalk);
    stage.add(disc({0, 1, 0}, 1), emitting({0, 0, 0}));
    const Environment everywhere = with_distribution(white);
    const Camera below = orthographic({0, 0.5f, 0}, {0, 0, 0}, 0.02f, {0, 0, -1});
    RenderSettings settings = sampled_settings(below, 16);
    estimate(stage, everywhere, settings, 8).expect(glm::dvec3(0.5), 3e-3);
    settings.shadow = false;
    estimate(stage, everywhere, settings, 8).expect(glm::dvec3(1), 3e-3);
}

TEST_F(SampledLightTest, RoughGlassInTheWayIsCountedOnce) {
    // Light rays go straight through the sheet, the metal's own rays scatter in it: together they bring all light.
    Material metal = plane_mirror(), glass = thin_glass();
    metal.roughness = 0.5f;
    glass.roughness = 0.3f;
    Stage stage;
    stage.add(ground(60), metal);
    stage.add(ground(60, 1), glass);
    RenderSettings settings = sampled_settings(orthographic({0.3f, 0.5f, 0}, {0, 0, 0}, 0.02f), 16);
    settings.bounces = 12;
    estimate(stage, with_distribution(white), settings, 8).expect(glm::dvec3(1), 0.03);
}

TEST_F(SampledLightTest, MirrorsAndTheCameraSeeMeansOfTheImage) {
    // Columns of one texel, black and white by turns, of which a pixel sees ten.
    std::vector<glm::vec4> pixels;
    for (uint32_t i = 0; i < 256 * 128; i++) pixels.push_back(glm::vec4(glm::vec3(float(i % 2)), 1));
    const Environment columns = with_distribution(image_environment(256, 128, pixels));
    Stage stage;
    stage.add(parallelogram({-8, -8, -2}, {8, 0, 0}, {0, 16, 0}), plane_mirror());
    const Camera camera = perspective({0, 0, 0}, {0, 0, -1}, 60);
    tally(render(stage, columns, sampled_settings(camera, 8)), camera, 0.03, [](const ViewRay&) {
        return glm::dvec3(0.5);
    }).expect(0, 64);
}

// --- Lamps with a size ---

TEST_F(SampledLightTest, BallShinesAsItsCentreDoes) {
    // Above the horizon as a whole: I cos(theta) / d², whatever its size.
    const Camera above = orthographic({0, 0.5f, 0}, {0, 0, 0}, 0.02f, {0, 0, -1});
    for (const float radius : {0.2f, 1.f, 1.9f})
        for (const float aside : {0.f, 1.5f}) {
            SCOPED_TRACE(fmt::format("radius {}, {} aside", radius, aside));
            Stage stage;
            stage.add(ground(8), lambert({1, 1, 1}));
            stage.lamp({aside, 2, 0.3f}, {9, 6, 3}).radius = radius;
            const glm::dvec3 to_lamp(aside, 2, 0.3f);
            const double distance = glm::length(to_lamp), strength = 2 / distance / (distance * distance) / kPi;
            RenderSettings settings = settings_for(above, 16);
            settings.spp = 4;
            estimate(stage, black, settings, 6).expect(strength * glm::dvec3(9, 6, 3), 1e-3);
        }
    Stage stage;
    stage.add(ground(8), lambert({1, 1, 1}));
    stage.sun({0.5f, -1, 0.2f}, {3, 2, 1});
    stage.scene.lights[0].radius = 0.6f;
    RenderSettings settings = settings_for(above, 16);
    settings.spp = 4;
    estimate(stage, black, settings, 6).expect(glm::dvec3(3, 2, 1) / std::sqrt(1.29) / kPi, 1e-3);
}

TEST_F(SampledLightTest, ShadowsOfBallsAreSoft) {
    const Camera above = orthographic({0, 0.5f, 0}, {0, 0, 0}, 0.02f, {0, 0, -1});
    Stage stage;
    stage.add(ground(8), lambert({1, 1, 1}));
    stage.lamp({0, 4, 0}, glm::vec3(16 * float(kPi))).radius = 1;
    // A sheet up to the middle hides half of the ball; what is inside the ball hides nothing.
    stage.add(parallelogram({-4, 2, 4}, {4, 0, 0}, {0, 0, -8}), emitting({0, 0, 0}));
    stage.add(disc({0, 3.3f, 0}, 0.4f), emitting({0, 0, 0}));
    RenderSettings settings = settings_for(above, 16);
    settings.spp = 4;
    estimate(stage, black, settings, 6).expect(glm::dvec3(0.5), 0.02);
    // One sample looks for the centre, unless the environment is sampled too.
    settings.spp = 1;
    EXPECT_TRUE(near(mean_radiance(render(stage, black, settings)), glm::dvec3(0), 1e-6));
    settings.env_mode = EnvironmentMode::sampled;
    estimate(stage, with_distribution(black), settings, 6).expect(glm::dvec3(0.5), 0.04);
}

}  // namespace
}  // namespace peelray
