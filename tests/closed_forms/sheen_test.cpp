// The sheen of cloth (KHR_materials_sheen): light that it takes is missing below, and nothing else.
#include <pictures.h>

#include "lobes.h"

namespace peelray {
namespace {

class SheenTest : public PictureTest {
  protected:
    glm::dvec3 seen(const Stage& stage, const Environment& environment, double cosine) {
        return mean_radiance(render(stage, environment, settings_for(slanted(cosine), 4)));
    }
    Stage square(const Material& m) {
        Stage stage;
        stage.add(texture_square(), m);
        return stage;
    }
};

Material with_sheen(Material m, const glm::vec3& color, float roughness) {
    m.sheen_color = color;
    m.sheen_roughness = roughness;
    return m;
}

TEST_F(SheenTest, OnBlackItSendsItsAlbedo) {
    for (const double roughness : {0.0, 0.2, 0.5, 1.0})
        for (const double cosine : {1.0, 0.5, 0.16}) {
            const Material m = with_sheen(lambert({0, 0, 0}), {1, 0.5f, 0}, float(roughness));
            const double albedo = fibre_albedo(roughness, cosine);
            const glm::dvec3 got = seen(square(m), white, cosine);
            EXPECT_TRUE(near(got, albedo * glm::dvec3(1, 0.5, 0), 6e-3))
                << "roughness " << roughness << ", cosine " << cosine << ": " << text(got) << ", expected " << albedo;
        }
}

TEST_F(SheenTest, NothingIsLostOrMadeUp) {
    // On white cloth, on a mirror and on rough glass; a coloured one takes from all colours what it takes of its own.
    for (const float roughness : {0.1f, 1.f})
        for (const double cosine : {0.8, 0.16}) {
            SCOPED_TRACE(fmt::format("roughness {}, cosine {}", roughness, cosine));
            Material glass = thin_glass();
            glass.roughness = 0.4f;
            for (const Material& m : {lambert({1, 1, 1}), plane_mirror(), glass}) {
                const glm::dvec3 got = seen(square(with_sheen(m, {1, 1, 1}, roughness)), white, cosine);
                EXPECT_TRUE(near(got, glm::dvec3(1), 2e-3)) << text(got);
            }
            const double albedo = fibre_albedo(roughness, cosine);
            const glm::dvec3 got =
                seen(square(with_sheen(lambert({1, 1, 1}), {0.8f, 0.4f, 0}, roughness)), white, cosine);
            EXPECT_TRUE(near(got, 1.0 - albedo * glm::dvec3(0, 0.4, 0.8), 6e-3)) << text(got);
        }
}

TEST_F(SheenTest, LampsAreReflectedByTheFibres) {
    for (const double roughness : {0.1, 0.5, 1.0})
        for (const double cosine : {0.9, 0.3}) {
            const glm::dvec3 view = to_slanted(cosine), to_sun = glm::normalize(glm::dvec3(0.9, 0.6, 0.5));
            const glm::dvec3 color(0.9, 0.5, 0.2);
            const double left = 1 - 0.9 * std::max(fibre_albedo(roughness, cosine), fibre_albedo(roughness, to_sun.z));
            const glm::dvec3 want = 2 * to_sun.z * (left * 0.5 / kPi + color * fibres(roughness, view, to_sun));
            Stage stage = square(with_sheen(lambert(glm::vec3(0.5f)), glm::vec3(color), float(roughness)));
            stage.sun(-to_sun, glm::vec3(2));
            const glm::dvec3 got = seen(stage, black, cosine);
            EXPECT_TRUE(near(got, want, 4e-3)) << "roughness " << roughness << ", cosine " << cosine << ": "
                                               << text(got) << ", expected " << text(want);
        }
}

TEST_F(SheenTest, EmissionShinesThrough) {
    const Stage stage = square(with_sheen(emitting({3, 2, 1}), {1, 1, 1}, 0.5f));
    EXPECT_TRUE(near(seen(stage, black, 0.2), {3, 2, 1}, 1e-4));
}

TEST_F(SheenTest, LiesBelowTheCoat) {
    Material m = with_sheen(lambert({0, 0, 0}), {1, 1, 1}, 0.5f);
    m.clearcoat = 1;
    const double cosine = 0.3, coat = schlick(0.04, 1, cosine);
    EXPECT_NEAR(seen(square(m), white, cosine).x, coat + (1 - coat) * fibre_albedo(0.5, cosine), 4e-3);
}

TEST_F(SheenTest, AmbientRaysDecideAboutItsSky) {
    // A black wall all along one side hides half of the sky, of which the sheen is taken to see as much as Lambert.
    Stage stage = square(with_sheen(lambert({0, 0, 0}), {1, 1, 1}, 0.5f));
    stage.add(parallelogram({0, -99, 0}, {0, 198, 0}, {0, 0, 99}), unlit({0, 0, 0}));
    RenderSettings settings = settings_for(orthographic({0.5f, 0, 4}, {0.5f, 0, 0}, 0.01f), 4);
    settings.spp = 64;
    settings.ambient = true;
    const RenderResult picture = render(stage, white, settings);
    EXPECT_NEAR(mean_radiance(picture).x, fibre_albedo(0.5, 1) / 2, 0.01);
    EXPECT_EQ(picture.rays.ambient, 16u * 64u);
}

TEST_F(SheenTest, TexturesScaleColourAndRoughness) {
    Stage stage;
    Material m = with_sheen(lambert({0, 0, 0}), {1, 1, 1}, 1);
    m.sheen_color_texture = 0;
    m.sheen_roughness_texture = 0;
    m.sheen_roughness_texture.channel = 3;
    stage.scene.textures = {two_texels({255, 255, 0, 102}, {188, 255, 255, 204})};  // 188: 0.5029 of sRGB
    stage.add(texture_square(), m);
    const Camera camera = orthographic({4, 0, 2}, {0, 0, 0}, 0.5f);
    const double cosine = 1 / std::sqrt(5), wide = fibre_albedo(0.8, cosine), narrow = fibre_albedo(0.4, cosine);
    const double half = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
    // Seen from the right: the picture's left is the square's.
    tally(render(stage, white, settings_for(camera, 16)), camera, 6e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const double x = ray.at_plane(2, 0).x;
              if (std::abs(x) < 0.01 || std::abs(x) > 0.99) return {};
              return x < 0 ? narrow * glm::dvec3(1, 1, 0) : wide * glm::dvec3(half, 1, 1);
          })
        .expect(0, 150);
}

TEST_F(SheenTest, LampsBehindTheViewerAreSeenOnEverySlope) {
    // Where light, view and normal are one direction, rounding makes cosines above 1.
    const glm::vec3 eye(1, 2, 4);
    Material m = lambert(glm::vec3(0.5f));
    m.sheen_color = glm::vec3(0.5f);
    m.sheen_roughness = 0.6f;
    Stage stage;
    for (int i = 0; i < 64; i++) {
        const glm::vec3 normal = glm::normalize(eye + glm::vec3(0.01f * float(i), 0.003f * float(i * i), 0));
        const glm::vec3 right = glm::normalize(glm::cross({0, 1, 0}, normal)), up = glm::cross(normal, right);
        const glm::vec3 middle((float(i % 8) - 3.5f) / 4, (float(i / 8) - 3.5f) / 4, 0);
        Primitive square = texture_square();
        for (size_t k = 0; k < 4; k++) {
            const glm::vec3 p = square.positions[k] * 0.1f;
            square.positions[k] = middle + right * p.x + up * p.y;
            square.normals[k] = normal;
        }
        stage.add(square, m);
        stage.sun(-normal, glm::vec3(0.1f));
    }
    RenderSettings settings = settings_for(orthographic(eye, {0, 0, 0}, 2.5f), 64);
    settings.shadow = false;
    for (const glm::vec4& pixel : render(stage, black, settings).radiance)
        EXPECT_TRUE(pixel.w == 0 || pixel.x > 0.3f) << pixel.x;
}

}  // namespace
}  // namespace peelray
