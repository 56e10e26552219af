// Clear coats (KHR_materials_clearcoat): a second reflection on top, which takes its share from all that is below.
#include <pictures.h>

#include "scene/tangents.h"

namespace peelray {
namespace {

using CoatTest = PictureTest;

Material coated(Material m, float share, float roughness) {
    m.clearcoat = share;
    m.coat_roughness = roughness;
    return m;
}

TEST_F(CoatTest, MirrorsBySchlick) {
    for (const float share : {1.f, 0.4f})
        for (const double cosine : {1.0, 0.6, 0.2}) {
            Stage stage;
            stage.add(texture_square(), coated(lambert({0, 0, 0}), share, 0));
            const Camera camera = slanted(cosine);
            tally(render(stage, white, settings_for(camera, 16)), camera, 1e-4, [&](const ViewRay&) {
                return glm::dvec3(double(share) * schlick(0.04, 1, cosine));
            }).expect(0, 256);
        }
}

TEST_F(CoatTest, TakesItsShareFromBelow) {
    // Of a lamp: emission is below the coat as well.
    for (const double cosine : {1.0, 0.3}) {
        Stage stage;
        Material lamp = lambert({0, 0, 0});
        lamp.emissive = {2, 1, 0.5f};
        stage.add(texture_square(), coated(lamp, 0.8f, 0));
        const Camera camera = slanted(cosine);
        tally(render(stage, black, settings_for(camera, 16)), camera, 1e-4, [&](const ViewRay&) {
            return (1 - double(0.8f) * schlick(0.04, 1, cosine)) * glm::dvec3(2, 1, 0.5);
        }).expect(0, 256);
    }
}

TEST_F(CoatTest, NothingIsLostOrMadeUp) {
    // In white surroundings a coated white ball is white, with one sample exactly so.
    for (const float roughness : {0.f, 0.06f, 0.3f, 0.7f, 1.f})
        for (const uint32_t spp : {1u, 32u}) {
            SCOPED_TRACE(fmt::format("roughness {}, samples {}", roughness, spp));
            Stage stage;
            stage.add(sphere({0, 0, 0}, 1, 24), coated(lambert({1, 1, 1}), 0.9f, roughness));
            RenderSettings settings = settings_for(orthographic({1, 2, 4}, {0, 0, 0}, 2.2f), 48);
            settings.spp = spp;
            const RenderResult picture = render(stage, white, settings);
            double sum = 0, count = 0, worst = 0;
            for (const glm::vec4& p : picture.radiance) {
                if (p.w < 1) continue;
                sum += p.x;
                count++;
                worst = std::max(worst, std::abs(double(p.x) - 1));
            }
            EXPECT_GT(count, 1000);
            EXPECT_NEAR(sum / count, 1, spp == 1 ? 1e-3 : 4e-3);
            EXPECT_LT(worst, spp == 1 ? 2e-3 : 0.3);
        }
}

TEST_F(CoatTest, IsTheReflectionOfGlass) {
    // On black, a coat is what a dielectric reflects whose reflectance is stated as 0.04: in lamps, sky and mirror
    // images.
    for (const float roughness : {0.f, 0.1f, 0.35f, 0.8f}) {
        SCOPED_TRACE(roughness);
        const auto picture = [&](const Material& m) {
            Stage stage;
            stage.add(sphere({0, 0, 0}, 1, 24), m);
            stage.add(box({-3, -2, -2}, {3, -1.2f, 2}), unlit({0.2f, 0.7f, 0.9f}));
            stage.sun({-1, -1, -0.5f}, glm::vec3(3));
            return render(stage, white, settings_for(perspective({0.5f, 1, 4}, {0, -0.2f, 0}, 40), 64));
        };
        Material stated;
        stated.base_color = glm::vec3(0);
        stated.ior = 0;
        stated.specular_color = glm::vec3(0.04f);
        stated.roughness = roughness;
        tally(picture(coated(lambert({0, 0, 0}), 1, roughness)), picture(stated), 2e-3).expect(0.001, 4096);
    }
}

TEST_F(CoatTest, BothReflectionsAreFollowed) {
    // A rough metal would show a blurred wall; its coat shows the sharp one.
    Stage stage;
    Material metal_below = metal("copper", {0.9f, 0.5f, 0.3f});
    metal_below.roughness = 0;
    stage.add(turned(texture_square(), -45, {0, 1, 0}), coated(metal_below, 1, 0));
    for (const float side : {-1.f, 1.f}) {
        Material m = unlit({0.5f, 0.25f, 1});
        stage.add(parallelogram({3 * side, -4, 4}, {0, 0, -8}, {0, 8, 0}), m);
    }
    const Camera camera = orthographic({0, 0, 1.9f}, {0, 0, 0}, 0.8f);
    const RenderResult picture = render(stage, black, settings_for(camera, 16));
    const double coat = schlick(0.04, 1, std::sqrt(0.5));
    tally(picture, camera, 1e-4, [&](const ViewRay&) {
        glm::dvec3 below;
        for (int k = 0; k < 3; k++) below[k] = schlick(double(glm::vec3(0.9f, 0.5f, 0.3f)[k]), 1, std::sqrt(0.5));
        return (coat + (1 - coat) * below) * glm::dvec3(0.5, 0.25, 1);
    }).expect(0, 256);
    EXPECT_EQ(picture.rays.reflection, 2u * 256u);
    EXPECT_EQ(picture.rays.refraction, 0u);
}

TEST_F(CoatTest, TexturesSayWhereAndHowRough) {
    Stage stage;
    Material m = coated(lambert({0, 0, 0}), 0.5f, 0);
    m.clearcoat_texture = 0;
    stage.scene.textures = {two_texels({255, 0, 0}, {51, 0, 0})};
    stage.add(texture_square(), m);
    const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
    tally(render(stage, white, settings_for(camera, 32)), camera, 1e-4,
          left_and_right(glm::dvec3(0.5 * 0.04), glm::dvec3(0.2 * 0.5 * 0.04)))
        .expect(0, 1000);
}

TEST_F(CoatTest, HasANormalOfItsOwn) {
    // The surface's normal texture does not bend the coat, and the coat's own does not bend the surface. Seen from the
    // front, a coat that is bent by 30 degrees reflects by the cosine of that.
    Texture bent;
    bent.width = bent.height = 1;
    const auto code = [](double x) { return uint32_t(std::lround((x + 1) / 2 * 255)); };
    bent.texels = {code(0.5) | code(0) << 8 | code(std::sqrt(0.75)) << 16 | 0xff000000u};
    const glm::dvec3 stored = glm::normalize(glm::dvec3(code(0.5), code(0), code(std::sqrt(0.75))) / 127.5 - 1.0);
    for (const bool coat : {false, true}) {
        SCOPED_TRACE(coat);
        Stage stage;
        Material m = coated(lambert({0, 0, 0}), 1, 0);
        (coat ? m.coat_normal_texture : m.normal_texture) = 0;
        stage.scene.textures = {bent};
        stage.add(texture_square(), m);
        complete_tangents(stage.scene);
        const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
        tally(render(stage, white, settings_for(camera, 16)), camera, 1e-4, [&](const ViewRay&) {
            return glm::dvec3(schlick(0.04, 1, coat ? stored.z : 1));
        }).expect(0, 256);
    }
}

TEST_F(CoatTest, OnGlassItBrightensTheReflection) {
    Stage stage;
    stage.add(texture_square(), coated(thin_glass(1), 1, 0));  // an index of 1 reflects nothing by itself
    stage.add(parallelogram({-2, -2, -1}, {4, 0, 0}, {0, 4, 0}), unlit({0.3f, 0.3f, 0.3f}));
    const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
    tally(render(stage, white, settings_for(camera, 16)), camera, 1e-4, [](const ViewRay&) {
        return glm::dvec3(0.04 + 0.96 * 0.3f);
    }).expect(0, 256);
}

TEST_F(CoatTest, BlendedSurfacesKeepTheirCoat) {
    // Whatever the surface below: its own reflection is too wide to be traced, or it has none.
    for (const uint32_t spp : {1u, 8u}) {
        Stage stage;
        Material m = coated(lambert({0, 0, 0}), 1, 0);
        m.blended = true;
        m.alpha = 0.5f;
        stage.add(texture_square(), m);
        stage.add(parallelogram({-2, -2, -1}, {4, 0, 0}, {0, 4, 0}), unlit({0.3f, 0.3f, 0.3f}));
        const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
        RenderSettings settings = settings_for(camera, 16);
        settings.spp = spp;
        tally(render(stage, white, settings), camera, 1e-4, [](const ViewRay&) {
            return glm::dvec3(0.5 * 0.04 + 0.5 * 0.3f);
        }).expect(0, 256);
    }
}

TEST_F(CoatTest, RoughnessIsTheTexturesChannel) {
    Stage stage;
    Material m = coated(lambert({0, 0, 0}), 1, 0.5f);
    m.coat_roughness_texture = 0;
    m.coat_roughness_texture.channel = 1;
    stage.scene.textures = {two_texels({0, 0, 0}, {0, 255, 0})};
    stage.add(texture_square(), m);
    const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
    const double rough = ggx_mean(1, 0.5, [](double c) { return schlick(0.04, 1, c); });
    tally(render(stage, white, settings_for(camera, 32)), camera, 1e-3,
          left_and_right(glm::dvec3(0.04), glm::dvec3(rough)))
        .expect(0, 1000);
}

}  // namespace
}  // namespace peelray
