// Diffuse transmission (KHR_materials_diffuse_transmission): leaves and paper, lit from behind.
#include <pictures.h>

namespace peelray {
namespace {

class DiffuseTransmissionTest : public PictureTest {
  protected:
    glm::dvec3 seen(const Stage& stage, const Environment& environment, double cosine = 1) {
        return mean_radiance(render(stage, environment, settings_for(slanted(cosine), 4)));
    }
};

const glm::dvec3 kLit(0.8, 0.5, 0.2), kShining(0.1, 0.6, 0.9);

/// A quarter of the light comes through.
Material leaf() {
    Material m = lambert(glm::vec3(kLit));
    m.diffuse_transmission = 0.25f;
    m.diffuse_transmission_color = glm::vec3(kShining);
    return m;
}

Stage square_of(const Material& m) {
    Stage stage;
    stage.add(texture_square(), m);
    return stage;
}

void expect_near(const glm::dvec3& got, const glm::dvec3& want, double tolerance) {
    EXPECT_TRUE(near(got, want, tolerance)) << text(got) << ", expected " << text(want);
}

TEST_F(DiffuseTransmissionTest, LampsShineThrough) {
    const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.3, 0.5, 1));
    for (const float side : {1.f, -1.f}) {
        Stage stage = square_of(leaf());
        stage.sun(-side * glm::vec3(to_sun), glm::vec3(3));
        expect_near(seen(stage, black), 3 * to_sun.z / kPi * (side > 0 ? 0.75 * kLit : 0.25 * kShining), 1e-4);
    }
    // From the back the same holds, and a lamp is as near as it is.
    for (const float side : {1.f, -1.f}) {
        Stage stage;
        stage.add(turned(texture_square(), 180, {0, 1, 0}), leaf());
        stage.lamp({0, 0, 2 * side}, glm::vec3(12));
        const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 0.01f);
        expect_near(mean_radiance(render(stage, black, settings_for(camera, 4))),
                    12 / 4.0 / kPi * (side > 0 ? 0.75 * kLit : 0.25 * kShining), 1e-4);
    }
}

TEST_F(DiffuseTransmissionTest, WhatIsBetweenCastsItsShadow) {
    for (const float z : {-0.5f, 0.5f}) {
        Stage stage = square_of(leaf());
        stage.sun({0, 0, 1}, glm::vec3(1));
        stage.add(parallelogram({-3, -3, z}, {6, 0, 0}, {0, 6, 0}), lambert({1, 1, 1}));
        const Camera camera = orthographic({0, 0, 0.25f}, {0, 0, 0}, 0.5f);
        expect_near(mean_radiance(render(stage, black, settings_for(camera, 4))),
                    z < 0 ? glm::dvec3(0) : 0.25 / kPi * kShining, 1e-5);
    }
}

TEST_F(DiffuseTransmissionTest, TheSkyOfBothSidesIsSeen) {
    // A sky of 0.5 + 0.4 d lights a surface of normal n by pi (0.5 + 0.4 · 2/3 n).
    const glm::dvec3 front(0.5, 0.5, 0.5 + 0.8 / 3), behind(0.5, 0.5, 0.5 - 0.8 / 3);
    const glm::dvec3 want = 0.75 * kLit * front + 0.25 * kShining * behind;
    const Stage stage = square_of(leaf());
    const Environment directions = direction_image();
    expect_near(seen(stage, directions), want, 2e-3);
    RenderSettings settings = settings_for(slanted(1), 4);
    settings.ambient = true;
    settings.spp = 4;
    const RenderResult open = render(stage, directions, settings);
    expect_near(mean_radiance(open), want, 2e-3);
    EXPECT_EQ(open.rays.ambient, 2u * 16u * 4u);
    // Each side's rays see what stands there.
    for (const float z : {-0.1f, 0.1f}) {
        Stage hidden = square_of(leaf());
        hidden.add(parallelogram({-50, -50, z}, {100, 0, 0}, {0, 100, 0}), lambert({0, 0, 0}));
        settings.camera = orthographic({0, 0, 0.05f}, {0, 0, 0}, 0.3f);
        expect_near(mean_radiance(render(hidden, directions, settings)),
                    z < 0 ? 0.75 * kLit * front : 0.25 * kShining * behind, 4e-3);
    }
}

TEST_F(DiffuseTransmissionTest, NothingIsLostOrMadeUp) {
    for (const float roughness : {0.f, 0.5f, 1.f})
        for (const float share : {0.3f, 1.f}) {
            Material m;
            m.roughness = roughness;
            m.diffuse_transmission = share;
            m.clearcoat = 0.5f;
            m.sheen_color = glm::vec3(1);
            m.sheen_roughness = 0.4f;
            expect_near(seen(square_of(m), white, 0.5), glm::dvec3(1), 2e-3);
        }
}

TEST_F(DiffuseTransmissionTest, WhatIsMirroredIsMissing) {
    const double cosine = 0.4;
    Material m = leaf();
    m.ior = 1.8f;
    m.roughness = 0;
    Stage stage = square_of(m);
    stage.sun({0, 0, 1}, glm::vec3(1));
    expect_near(seen(stage, black, cosine), (1 - fresnel(cosine, 1, 1.8)) * 0.25 / kPi * kShining, 1e-4);
    stage.scene.materials[0].clearcoat = 1;
    const double coat = schlick(0.04, 1, cosine);
    expect_near(seen(stage, black, cosine), (1 - coat) * (1 - fresnel(cosine, 1, 1.8)) * 0.25 / kPi * kShining, 1e-4);
}

TEST_F(DiffuseTransmissionTest, TexturesSayHowMuchAndInWhichColour) {
    Material m = lambert({1, 1, 1});
    m.diffuse_transmission = 0.5f;
    m.diffuse_transmission_texture = 0;
    m.diffuse_transmission_texture.channel = 3;
    m.diffuse_transmission_color_texture = 0;
    Stage stage = square_of(m);
    stage.scene.textures = {two_texels({255, 0, 255, 255}, {255, 188, 255, 51})};
    stage.sun({0, 0, 1}, glm::vec3(2));
    const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
    const double half = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
    tally(render(stage, black, settings_for(camera, 16)), camera, 1e-4,
          left_and_right(2 / kPi * 0.5 * glm::dvec3(1, 0, 1), 2 / kPi * 0.1 * glm::dvec3(1, half, 1)))
        .expect(0, 200);
}

TEST_F(DiffuseTransmissionTest, ThicknessAbsorbs) {
    Material m = leaf();
    m.thickness = 0.6f;
    m.attenuation_color = {0.3f, 0.5f, 0.9f};
    m.attenuation_distance = 1.5f;
    Stage stage = square_of(m);
    stage.sun({0, 0, 1}, glm::vec3(1));
    expect_near(seen(stage, black), 0.25 / kPi * kShining * glm::pow(glm::dvec3(0.3, 0.5, 0.9), glm::dvec3(0.4)), 1e-4);
}

TEST_F(DiffuseTransmissionTest, RaysToBehindStartInTheVolume) {
    // A slab, half of whose light passes: its front is lit through the medium and the back, the back from air.
    Material m = lambert({1, 1, 1});
    m.transmission = 0.5f;
    m.diffuse_transmission = 1;
    m.thickness = 1e-6f;  // what the light crosses counts, not this
    m.attenuation_color = {0.3f, 0.5f, 0.9f};
    m.attenuation_distance = 1;
    Stage stage;
    stage.add(box({-4, -4, -2}, {4, 4, 0}), m);
    stage.sun({0, 0, 1}, glm::vec3(1));
    const glm::dvec3 crossed = glm::dvec3(0.3, 0.5, 0.9) * glm::dvec3(0.3, 0.5, 0.9);
    expect_near(seen(stage, black), 2 * 0.5 * 0.5 / kPi * crossed, 1e-4);
}

}  // namespace
}  // namespace peelray
