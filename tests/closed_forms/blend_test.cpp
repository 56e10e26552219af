// Blended surfaces (glTF's alphaMode BLEND): each covers what is behind it by its alpha, in the order along the ray.
#include <pictures.h>

#include "scene/encoding.h"

namespace peelray {
namespace {

using BlendTest = PictureTest;

const Camera kSheets = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);

Material blended(Material m, float alpha) {
    m.alpha = alpha;
    m.blended = true;
    return m;
}

std::function<std::optional<glm::dvec3>(const ViewRay&)> everywhere(const glm::dvec3& value) {
    return [=](const ViewRay&) { return value; };
}

const glm::dvec3 kRed(0.9f, 0.1f, 0), kGreen(0, 0.8f, 0.1f), kBack(0.2f, 0.3f, 0.4f);

TEST_F(BlendTest, TheNearerCoversTheFarther) {
    // In either order of the file, and without noise at one sample.
    for (const bool near_first : {false, true}) {
        SCOPED_TRACE(near_first);
        Stage stage;
        if (near_first) stage.add(texture_square(1), blended(unlit(kRed), 0.25f));
        stage.add(texture_square(-1), unlit(kBack));
        stage.add(texture_square(0), blended(unlit(kGreen), 0.5f));
        if (!near_first) stage.add(texture_square(1), blended(unlit(kRed), 0.25f));
        const glm::dvec3 want = 0.25 * kRed + 0.75 * (0.5 * kGreen + 0.5 * kBack);
        tally(render(stage, white, settings_for(kSheets, 32)), kSheets, 1e-4, everywhere(want)).expect(0, 1024);
    }
}

TEST_F(BlendTest, LightOnASheetIsItsShare) {
    Stage stage;
    stage.add(texture_square(0), blended(lambert({0.6f, 0.6f, 0.6f}), 0.4f));
    stage.add(texture_square(-1), unlit(kBack));
    stage.sun({0, 0, -1}, glm::vec3(2));
    tally(render(stage, black, settings_for(kSheets, 32)), kSheets, 1e-4, everywhere(0.4 * 0.6 * 2 / kPi + 0.6 * kBack))
        .expect(0, 1024);
}

TEST_F(BlendTest, MirrorsShowIt) {
    // A mirror at 45 degrees shows the sheet and what is behind it, which stand to the right.
    Stage stage;
    stage.add(turned(texture_square(0), -45, {0, 1, 0}), plane_mirror());
    const auto right = [](float distance) { return parallelogram({distance, -3, 3}, {0, 0, -6}, {0, 6, 0}); };
    for (auto [distance, material] : {std::pair(-2.0f, blended(unlit(kRed), 0.3f)), {-4.0f, unlit(kBack)}})
        for (const float side : {-1.0f, 1.0f}) {
            Material m = material;
            m.double_sided = true;
            stage.add(right(side * distance), m);
        }
    const Camera camera = orthographic({0, 0, 1.9f}, {0, 0, 0}, 1);
    tally(render(stage, black, settings_for(camera, 32)), camera, 1e-4, everywhere(0.3 * kRed + 0.7 * kBack))
        .expect(0, 1024);
}

TEST_F(BlendTest, ShadowsAreAsDeepAsWhatCovers) {
    Stage stage;
    stage.add(ground(5), lambert({1, 1, 1}));
    stage.add(disc({0, 1, 0}, 4), blended(unlit({1, 1, 1}), 0.3f));
    stage.add(disc({0, 1.5f, 0}, 4), blended(lambert({0, 0, 0}), 0.5f));
    stage.sun({0, -1, 0}, glm::vec3(3));
    const Camera camera = orthographic({0, 0.5f, 0}, {0, 0, 0}, 1, {0, 0, -1});
    tally(render(stage, black, settings_for(camera, 32)), camera, 1e-4, everywhere(glm::dvec3(3 / kPi * 0.7 * 0.5)))
        .expect(0, 1024);
}

TEST_F(BlendTest, PassingIsNoBounce) {
    // Through six sheets to a mirror, which takes the only bounce, and through six again.
    Stage stage;
    for (int i = 0; i < 6; i++) stage.add(texture_square(0.1f * float(i)), blended(unlit({0, 0, 0}), 0.1f));
    Primitive mirror = texture_square(-1);
    stage.add(mirror, plane_mirror());
    RenderSettings settings = settings_for(kSheets, 16);
    settings.bounces = 1;
    // After eight sheets the rest counts as bounces: two of the way back are passed, then the sky is seen.
    tally(render(stage, white, settings), kSheets, 1e-3, everywhere(glm::dvec3(std::pow(0.9, 9)))).expect(0, 256);
    settings.bounces = 8;
    tally(render(stage, white, settings), kSheets, 1e-3, everywhere(glm::dvec3(std::pow(0.9, 12)))).expect(0, 256);
}

TEST_F(BlendTest, WithoutBouncesSheetsAreSeenThrough) {
    Stage stage;
    stage.add(texture_square(0), blended(unlit(kRed), 0.5f));
    stage.add(texture_square(-1), unlit(kBack));
    RenderSettings settings = settings_for(kSheets, 16);
    settings.bounces = 0;
    settings.shadow = false;
    tally(render(stage, white, settings), kSheets, 1e-4, everywhere(0.5 * kRed + 0.5 * kBack)).expect(0, 256);
}

TEST_F(BlendTest, AlphaIsFactorTimesTextureTimesVertex) {
    Stage stage;
    Material m = blended(unlit({1, 1, 1}), 0.8f);
    m.base_color_texture = 0;
    stage.scene.textures = {two_texels({255, 255, 255, 128}, {255, 255, 255, 51})};
    Primitive quad = texture_square(0);
    quad.colors.assign(4, glm::vec4(1, 0.5f, 1, 0.5f));
    stage.add(quad, m);
    stage.add(texture_square(-1), unlit(kBack));
    tally(render(stage, black, settings_for(kSheets, 32)), kSheets, 1e-4,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              if (std::abs(ray.origin.x) < 1e-3) return {};
              const double alpha = 0.8 * 0.5 * (ray.origin.x < 0 ? 128 : 51) / 255;
              return alpha * glm::dvec3(1, 0.5, 1) + (1 - alpha) * kBack;
          })
        .expect(0, 1000);
}

TEST_F(BlendTest, ThinGlassIsThereByItsAlpha) {
    Stage stage;
    Material glass = blended(thin_glass(1), 0.5f);
    glass.base_color = {0.5f, 1, 1};
    stage.add(texture_square(0), glass);
    stage.add(texture_square(-1), unlit(kBack));
    tally(render(stage, black, settings_for(kSheets, 16)), kSheets, 1e-4, everywhere(kBack * glm::dvec3(0.75, 1, 1)))
        .expect(0, 256);
}

TEST_F(BlendTest, OnlyTheUnlitShareSkipsTheToneCurve) {
    Stage stage;
    stage.add(texture_square(0), blended(unlit(kRed), 0.5f));
    Material lamp = lambert({0, 0, 0});
    lamp.emissive = glm::vec3(3, 2, 1);
    stage.add(texture_square(-1), lamp);
    const RenderSettings settings = settings_for(kSheets, 16);
    const uint32_t want = encode(0.5 * glm::dvec3(3, 2, 1), settings.exposure, settings.tonemap, 0.5 * kRed);
    const RenderResult picture = render(stage, black, settings);
    for (const uint32_t got : picture.encoded)
        for (int k = 0; k < 24; k += 8) EXPECT_NEAR(int(got >> k & 255), int(want >> k & 255), 1);
}

TEST_F(BlendTest, CutRaysAreThoseThatBouncesWouldFollow) {
    // Behind the sheet a mirror faces it: with one bounce its image is cut at the second one.
    Stage stage;
    stage.add(texture_square(0), blended(unlit(kRed), 0.5f));
    stage.add(texture_square(-1), plane_mirror());
    RenderSettings settings = settings_for(kSheets, 16);
    settings.bounces = 0;
    const RenderResult none = render(stage, white, settings);
    EXPECT_EQ(none.rays.refraction, 256u);
    EXPECT_EQ(none.rays.reflection, 0u);
    EXPECT_EQ(none.rays.cut_reflection + none.rays.cut_refraction, 0u);  // nobody asked for them
    settings.bounces = 1;
    const RenderResult one = render(stage, white, settings);
    EXPECT_EQ(one.rays.refraction, 512u);  // there and back
    EXPECT_EQ(one.rays.reflection, 256u);
    EXPECT_EQ(one.rays.cut_reflection, 0u);
    settings.bounces = 16;  // no level is left for more
    tally(render(stage, white, settings), kSheets, 1e-4, everywhere(0.75 * kRed + 0.25)).expect(0, 256);
}

}  // namespace
}  // namespace peelray
