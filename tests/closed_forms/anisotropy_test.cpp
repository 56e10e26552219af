// Anisotropy (KHR_materials_anisotropy): brushed surfaces, whose highlights are stretched along a direction.
#include <pictures.h>

#include "lobes.h"

namespace peelray {
namespace {

using AnisotropyTest = PictureTest;

Material brushed(double roughness, double anisotropy, double rotation = 0) {
    Material m = metal("steel", glm::vec3(1));
    m.roughness = float(roughness);
    m.anisotropy = float(anisotropy);
    m.anisotropy_rotation = float(rotation);
    return m;
}

const glm::dvec3 kToSun = glm::normalize(glm::dvec3(-0.4, 0.35, 1));

TEST_F(AnisotropyTest, HighlightsAreStretched) {
    for (const double roughness : {0.0, 0.5})
        for (const double anisotropy : {0.4, 0.9})
            for (const double rotation : {0.0, 0.6, 4.0}) {
                const TwoWidths lobe(roughness, anisotropy, rotation);
                Stage stage;
                stage.add(brushed_square(), brushed(roughness, anisotropy, rotation));
                stage.sun(-kToSun, glm::vec3(1));
                for (const double cosine : {0.9, 0.5}) {
                    const double want = lobe.lobe(to_slanted(cosine), kToSun);
                    const double kept =
                        ggx_mean(cosine, lobe.mean_roughness(to_slanted(cosine)), [](double) { return 1; });
                    for (const bool compensated : {true, false}) {
                        RenderSettings settings = settings_for(slanted(cosine), 2);
                        settings.energy_compensation = compensated;
                        const double got = mean_radiance(render(stage, black, settings)).x,
                                     expected = want / (compensated ? kept : 1);
                        EXPECT_NEAR(got, expected, 2e-3 + 4e-3 * expected)
                            << "roughness " << roughness << ", anisotropy " << anisotropy << ", rotation " << rotation
                            << ", cosine " << cosine << ", compensated " << compensated;
                    }
                }
            }
}

TEST_F(AnisotropyTest, TextureTurnsAndScales) {
    // Red and green: the direction; blue: how much. The rotation comes on top.
    Material m = brushed(0.3, 0.8, 0.5);
    m.anisotropy_texture = 0;
    Stage stage;
    stage.scene.textures = {two_texels({255, 128, 255}, {38, 218, 102})};
    stage.add(brushed_square(), m);
    stage.sun(-kToSun, glm::vec3(1));
    const auto light = [&](double r, double g, double b) {
        const double angle = std::atan2(g / 127.5 - 1, r / 127.5 - 1);
        return glm::dvec3(TwoWidths(0.3, 0.8 * b / 255, angle + 0.5).lobe({0, 0, 1}, kToSun));
    };
    const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
    RenderSettings settings = settings_for(camera, 16);
    settings.energy_compensation = false;
    tally(render(stage, black, settings), camera, 2e-3, left_and_right(light(255, 128, 255), light(38, 218, 102)))
        .expect(0, 200);
}

TEST_F(AnisotropyTest, WithoutTangentsTheLobeIsRound) {
    const auto picture = [&](double anisotropy) {
        Stage stage;
        stage.add(texture_square(), brushed(0.4, anisotropy));
        stage.sun(-kToSun, glm::vec3(1));
        RenderSettings settings = settings_for(orthographic({0, 0, 4}, {0, 0, 0}, 1), 8);
        settings.spp = 4;
        return render(stage, direction_image(), settings);
    };
    tally(picture(0.9), picture(0), 1e-3).expect(0, 64);
}

TEST_F(AnisotropyTest, SamplesFollowTheLobe) {
    for (const double rotation : {0.0, kPi / 2, 0.7})
        for (const double cosine : {0.9, 0.3}) {
            const TwoWidths lobe(0.3, 0.7, rotation);
            Stage stage;
            stage.add(brushed_square(), brushed(0.3, 0.7, rotation));
            RenderSettings settings = settings_for(slanted(cosine), 8);
            settings.spp = 64;
            const double kept = lobe.kept(to_slanted(cosine)),
                         round = ggx_mean(cosine, lobe.mean_roughness(to_slanted(cosine)), [](double) { return 1; });
            for (const bool compensated : {true, false}) {
                settings.energy_compensation = compensated;
                EXPECT_NEAR(mean_radiance(render(stage, white, settings)).x, kept / (compensated ? round : 1), 5e-3)
                    << "rotation " << rotation << ", cosine " << cosine << ", compensated " << compensated;
            }
        }
}

TEST_F(AnisotropyTest, BrushedGlassLosesNothing) {
    for (const float thickness : {0.f, 1.f})
        for (const double cosine : {0.9, 0.3}) {
            Material m = brushed(0.3, 0.7, 0.4);
            m.metallic = 0;
            m.transmission = 1;
            m.thickness = thickness;
            Stage stage;
            stage.add(brushed_square(), m);
            RenderSettings settings = settings_for(slanted(cosine), 4);
            settings.spp = 16;
            EXPECT_NEAR(mean_radiance(render(stage, white, settings)).x, 1, 1e-3) << thickness << ", " << cosine;
        }
}

TEST_F(AnisotropyTest, OneSampleLooksWhereTheStreakComesFrom) {
    // The normal turns towards the viewer, across the lobe.
    const double roughness = 0.1, anisotropy = 0.3, cosine = 0.6;
    const glm::dvec3 view = to_slanted(cosine), normal(0, 0, 1);
    for (const double rotation : {0.0, kPi / 2, 0.8}) {
        const glm::dvec3 across(-std::sin(rotation), std::cos(rotation), 0);
        const glm::dvec3 facing = glm::normalize(view - glm::dot(view, across) * across);
        const double straight = std::pow(1 - anisotropy * (1 - roughness), 4);
        const glm::dvec3 half = glm::normalize(glm::mix(facing, normal, straight));
        const glm::dvec3 want = light_of(2 * glm::dot(view, half) * half - view);
        Stage stage;
        stage.add(brushed_square(), brushed(roughness, anisotropy, rotation));
        const glm::dvec3 got = mean_radiance(render(stage, direction_image(), settings_for(slanted(cosine), 4)));
        EXPECT_TRUE(near(got, want, 6e-3)) << rotation << ": " << text(got) << ", expected " << text(want);
    }
}

}  // namespace
}  // namespace peelray
