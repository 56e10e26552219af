// --tracer cubemap: where a cube map is right it must be exactly right; where it is wrong, wrong as documented.
#include "pictures.h"

namespace peelray {
namespace {

/// A room seen from inside, whose light at p is light(p).
Primitive room(float half, const std::function<glm::vec3(glm::vec3)>& light) {
    Primitive walls = inside_out(box(glm::vec3(-half), glm::vec3(half)));
    for (const glm::vec3& p : walls.positions) walls.colors.push_back(glm::vec4(light(p), 1));
    return walls;
}

Material rough_metal(float roughness) {
    Material m = plane_mirror();
    m.roughness = roughness;
    return m;
}

class CubemapTracerTest : public PictureTest {
  protected:
    RenderResult cubemap(const Stage& stage, const Environment& environment, RenderSettings settings) {
        settings.tracer = Tracer::cubemap;
        return render(stage, environment, settings);
    }
    const Camera ball_ = perspective({0.8f, 1.1f, 3}, {0, 0, 0}, 40);
};

TEST_F(CubemapTracerTest, AloneUnderTheSkyNothingIsWrong) {
    // The environment is infinitely far away: a lookup by direction is the truth, sun's disc included.
    Stage stage;
    stage.add(sphere({0.3f, -0.2f, 0.1f}, 0.7f, 16), plane_mirror({0.9f, 0.7f, 0.5f}));
    const Environment sky = sky_environment(default_sun_direction()), image = direction_image();
    for (const Environment* environment : {&sky, &image})
        for (const Camera& camera : {ball_, orthographic({2, 1, 3}, {0, 0, 0}, 2.5f)}) {
            const RenderSettings settings = settings_for(camera, 96);
            const RenderResult looked_up = cubemap(stage, *environment, settings);
            tally(looked_up, render(stage, *environment, settings), 1e-5).expect(0, 96 * 96);
            EXPECT_EQ(looked_up.stats.maps.probes, 1u);
            EXPECT_EQ(looked_up.rays.secondary(), 0u);
        }
}

TEST_F(CubemapTracerTest, MirrorBallShowsALargeRoom) {
    // In every direction the room has a light of its own; the ball is small, so that where on it a ray starts hardly
    // matters.
    const float half = 50;
    Stage stage;
    stage.add(sphere({0, 0, 0}, 0.25f, 32), plane_mirror());
    stage.add(room(half, [&](glm::vec3 p) { return 1.f + 0.8f * p / half; }), unlit({1, 1, 1}));
    for (const glm::vec3& eye : {glm::vec3(0.2f, 0.3f, 1), {-1, 0.1f, -0.2f}, {0.1f, -1, 0.05f}}) {
        const RenderSettings settings = settings_for(perspective(eye, {0, 0, 0}, 25), 96);
        // Two ball radii of 50 metres, and a texel. At the ball's outline a ray may bounce along its facets until it
        // ends.
        tally(cubemap(stage, black, settings), render(stage, black, settings), 0.012).expect(0.001, 96 * 96);
    }
}

TEST_F(CubemapTracerTest, ProbesSeeThroughHoles) {
    // Between the room and the ball there is a shell with holes, which the camera looks through as well.
    Stage stage;
    stage.add(sphere({0, 0, 0}, 0.1f, 32), plane_mirror());
    stage.add(room(50, [&](glm::vec3) { return glm::vec3(0.1f, 0.2f, 0.9f); }), unlit({1, 1, 1}));
    stage.add(room(40, [&](glm::vec3) { return glm::vec3(0.9f, 0.3f, 0.1f); }), masked(stage, unlit({1, 1, 1})));
    const RenderSettings settings = settings_for(perspective({0.2f, 0.3f, 1}, {0, 0, 0}, 10), 96);
    const RenderResult traced = render(stage, black, settings);
    size_t through = 0, onto = 0;
    for (const glm::vec4& pixel : traced.radiance) (pixel.z > pixel.x ? through : onto)++;
    EXPECT_GT(through, 1500u);
    EXPECT_GT(onto, 1500u);
    // Texels blur the outlines of the holes.
    tally(cubemap(stage, black, settings), traced, 0.02).expect(0.08, 96 * 96);
}

TEST_F(CubemapTracerTest, ProbesSeeNoBacksOfSingleSidedMaterials) {
    // A wall beside the ball, whose box does not hold the probe.
    for (const bool faces_ball : {false, true}) {
        SCOPED_TRACE(faces_ball);
        Stage stage;
        stage.add(sphere({0, 0, 0}, 0.1f, 32), plane_mirror());
        stage.add(room(50, [&](glm::vec3) { return glm::vec3(0.1f, 0.2f, 0.9f); }), unlit({1, 1, 1}));
        const RenderSettings settings = settings_for(perspective({0.2f, 0.3f, 1}, {0, 0, 0}, 10), 64);
        const RenderResult without = cubemap(stage, black, settings);
        const float z = faces_ball ? 20.f : -20.f;
        stage.add(parallelogram({-20, -20, z}, {0, 0, -2 * z}, {0, 60, 0}), unlit({0.9f, 0.3f, 0.1f}));
        stage.scene.materials.back().double_sided = false;
        const size_t differing = tally(cubemap(stage, black, settings), without, 1e-5).wrong;
        if (faces_ball)
            EXPECT_GT(differing, 200u);
        else
            EXPECT_EQ(differing, 0u);
    }
}

TEST_F(CubemapTracerTest, RoughLevelsKeepUniformLight) {
    // In a white room rough metal looks as it does under a white sky, whatever the level; the probe, not the sky, is
    // seen.
    for (float roughness : {0.07f, 0.2f, 0.33f, 0.45f, 0.8f}) {
        SCOPED_TRACE(roughness);
        Stage alone;
        alone.add(sphere({0, 0, 0}, 0.5f, 12), rough_metal(roughness));
        Stage stage = alone;
        stage.add(room(10, [](glm::vec3) { return glm::vec3(1); }), unlit({1, 1, 1}));
        RenderSettings settings = settings_for(perspective({0.3f, 0.5f, 2}, {0, 0, 0}, 24), 48);
        settings.tracer = Tracer::none;
        const RenderResult want = render(alone, white, settings);
        // However many samples: a lookup is of the whole lobe. Of several, `want` shows the middle alone, and at the
        // rim reflectance changes within a pixel.
        for (uint32_t spp : {1u, 4u}) {
            settings.spp = spp;
            if (spp == 1 && roughness > 0.5f) continue;  // nothing would be traced, so there is no probe
            const RenderResult got = cubemap(stage, black, settings), ball = render(alone, black, settings);
            EXPECT_EQ(got.stats.maps.probes, 1u);
            Tally result;
            for (size_t i = 0; i < want.radiance.size(); i++)
                if (ball.radiance[i].w == 1)  // all samples: in the room, coverage does not tell what they see
                    result.add(near(glm::dvec3(got.radiance[i]), glm::dvec3(want.radiance[i]), spp == 1 ? 2e-3 : 0.03),
                               [&] { return text(glm::dvec3(got.radiance[i])) + text(glm::dvec3(want.radiance[i])); });
            result.expect(0, 1000);
        }
    }
}

TEST_F(CubemapTracerTest, BlurGrowsWithRoughness) {
    // One bright wall: the rougher the ball, the wider its light.
    double before = -1;
    for (float roughness : {0.f, 0.15f, 0.3f, 0.49f}) {
        Stage stage;
        stage.add(sphere({0, 0, 0}, 0.5f, 16), rough_metal(roughness));
        stage.add(parallelogram({-5, -5, 10}, {0, 10, 0}, {10, 0, 0}), unlit({1, 1, 1}));
        const RenderResult picture = cubemap(stage, black, settings_for(perspective({0, 0, 2}, {0, 0, 0}, 30), 64));
        size_t grey = 0;
        for (const glm::vec4& p : picture.radiance) grey += p.x > 0.05f && p.x < 0.6f;
        EXPECT_GT(double(grey), before) << roughness;
        before = double(grey);
    }
}

TEST_F(CubemapTracerTest, StretchedLobesAreBlurredAsRoundOnesOfTheirSize) {
    size_t grey[2] = {};
    for (const float anisotropy : {0.f, 1.f}) {
        Primitive ball = sphere({0, 0, 0}, 0.5f, 16);
        for (const glm::vec3& n : ball.normals)
            ball.tangents.emplace_back(glm::normalize(glm::cross(glm::vec3(0.01f, 1, 0), n)), 1);
        Material m = rough_metal(0);
        m.anisotropy = anisotropy;
        Stage stage;
        stage.add(ball, m);
        stage.add(parallelogram({-5, -5, 10}, {0, 10, 0}, {10, 0, 0}), unlit({1, 1, 1}));
        const RenderResult picture = cubemap(stage, black, settings_for(perspective({0, 0, 2}, {0, 0, 0}, 30), 64));
        for (const glm::vec4& p : picture.radiance) grey[anisotropy > 0] += p.x > 0.05f && p.x < 0.6f;
    }
    EXPECT_GT(grey[1], grey[0] + 100);
}

TEST_F(CubemapTracerTest, AnObjectDoesNotSeeItself) {
    // A groove of two mirrors: a ray would meet both, the cube map only tells of the white sky.
    const glm::vec3 tint(0.5f);
    Stage stage;
    stage.add(
        faces({{{-2, 0, 2}, {0, -1, 2}, {0, -1, -2}, {-2, 0, -2}}, {{0, -1, 2}, {2, 0, 2}, {2, 0, -2}, {0, -1, -2}}}),
        plane_mirror(tint));
    const Camera camera = orthographic({0, 5, 0}, {0, 0, 0}, 3, {0, 0, -1});
    const double cosine = 2 / std::sqrt(5.0);
    tally(cubemap(stage, white, settings_for(camera)), camera, 1e-3, [&](const ViewRay&) {
        return glm::dvec3(0.5 + 0.5 * std::pow(1 - cosine, 5));
    }).expect(0, 4096);
}

TEST_F(CubemapTracerTest, InsideAClosedBodyTheProbeLooksThroughItsBacks) {
    // Camera and ball stand in a closed box that faces outwards: its walls are there for rays, not for the probe.
    Stage stage;
    stage.add(sphere({0, 0, 0}, 0.5f, 16), plane_mirror());
    stage.add(box(glm::vec3(-4), glm::vec3(4)), unlit({0.1f, 0.2f, 0.3f}));
    const RenderSettings settings = settings_for(perspective({0, 0, 2}, {0, 0, 0}, 20), 32);
    EXPECT_TRUE(near(radiance_at(cubemap(stage, white, settings), 16, 16), {1, 1, 1}, 1e-3));
    EXPECT_TRUE(near(radiance_at(render(stage, white, settings), 16, 16), {0.1f, 0.2f, 0.3f}, 1e-3));
    // A sheet that does not enclose the ball is seen from behind, too.
    Stage sheet;
    sheet.add(sphere({0, 0, 0}, 0.5f, 16), plane_mirror());
    sheet.add(parallelogram({-4, -4, 3}, {8, 0, 0}, {0, 8, 0}), unlit({0.1f, 0.2f, 0.3f}));  // faces away from it
    EXPECT_TRUE(near(radiance_at(cubemap(sheet, white, settings), 16, 16), {0.1f, 0.2f, 0.3f}, 1e-3));
}

TEST_F(CubemapTracerTest, TheSecondRoundShowsMirrorsInMirrors) {
    Stage stage;
    stage.add(sphere({-1.2f, 0, 0}, 1, 16), plane_mirror());
    stage.add(sphere({1.2f, 0, 0}, 1, 16), plane_mirror());
    stage.add(room(20, [](glm::vec3) { return glm::vec3(1); }), unlit({1, 1, 1}));
    RenderSettings settings = settings_for(perspective({0, 0, 6}, {0, 0, 0}, 45), 96);
    const auto dark = [&](uint32_t bounces) {
        settings.bounces = bounces;
        const RenderResult picture = cubemap(stage, black, settings);
        EXPECT_EQ(picture.stats.maps.rounds, std::min(bounces, 2u));
        size_t count = 0;
        for (const glm::vec4& p : picture.radiance) count += p.x < 0.5f;
        return count;
    };
    EXPECT_GT(dark(0), 2000u);  // no probes: both see the black sky
    const size_t once = dark(1);
    EXPECT_GT(once, 100u);  // each in the other is still black
    EXPECT_LT(once, 2000u);
    // Now each shows the other with its cube map of the first round: only in the image's image's image black is left.
    const size_t twice = dark(2);
    EXPECT_LT(twice, once / 8);
    EXPECT_EQ(dark(4), twice);
}

TEST_F(CubemapTracerTest, GlassBendsOnce) {
    // One interface, the thickness that the material tells, both branches by direction.
    Material glass = clear_glass();
    glass.thickness = 0.5f;
    glass.attenuation_color = {0.4f, 0.6f, 0.8f};
    glass.attenuation_distance = 0.7f;
    const glm::dvec3 absorbed = glm::pow(glm::dvec3(0.4f, 0.6f, 0.8f), glm::dvec3(0.5 / 0.7f));
    Stage stage;
    stage.add(sphere({0, 0, 0}, 1, 64), glass);
    RenderSettings settings = settings_for(ball_, 96);
    const RenderResult picture = cubemap(stage, direction_image(), settings);
    tally(picture, ball_, 0.01, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
        const double b = glm::dot(ray.origin, ray.direction), c = glm::dot(ray.origin, ray.origin) - 1, d = b * b - c;
        if (d < 0.05) return {};
        const glm::dvec3 n = ray.origin + (-b - std::sqrt(d)) * ray.direction;
        const double cosine = -glm::dot(n, ray.direction), r = fresnel(cosine, 1, 1.5);
        return r * light_of(glm::reflect(ray.direction, n)) +
               (1 - r) * absorbed * light_of(glm::refract(ray.direction, n, 1 / 1.5));
    }).expect(0, 3000);
    // A thin wall lets everything straight through.
    Stage pane;
    pane.add(parallelogram({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), thin_glass());
    tally(cubemap(pane, direction_image(), settings), render(pane, direction_image(), settings), 1e-4)
        .expect(0, 96 * 96);
}

/// A bit of everything.
Stage still_life() {
    Stage stage;
    Material floor = plane_mirror({0.6f, 0.6f, 0.6f});
    floor.metallic = 0.5f;
    stage.add(ground(8), floor);
    stage.add(turned(box({-1, 0.5f, -1}, {1, 2, 1}), 25, {0, 1, 0}), lambert({0.8f, 0.3f, 0.1f}));
    stage.add(sphere({2, 1, 1.5f}, 0.8f, 12), clear_glass());
    stage.add(sphere({-2, 1, 1.5f}, 0.8f, 12), rough_metal(0.3f));
    stage.sun({0.5f, -1, -0.3f}, {2, 2, 2});
    stage.lamp({1, 4, 2}, {5, 5, 5});
    return stage;
}
const Camera kView = perspective({3, 4, 7}, {0, 1, 0}, 50);

TEST_F(CubemapTracerTest, TheSamePictureTwice) {
    RenderSettings settings = settings_for(kView, 96);
    settings.tracer = Tracer::cubemap;
    settings.spp = 2;
    settings.bounces = 1;
    const Stage stage = still_life();
    const Environment sky = sky_environment(default_sun_direction());
    const auto renderer = renderer_for(stage, sky);
    const RenderResult first = renderer->render(settings);
    settings.tracer = Tracer::ldc;
    renderer->render(settings);
    settings.tracer = Tracer::cubemap;
    const RenderResult again = renderer->render(settings), fresh = render(stage, sky, settings);
    EXPECT_EQ(tally(first, again, 0).wrong, 0u);
    EXPECT_EQ(tally(first, fresh, 0).wrong, 0u);
    EXPECT_EQ(first.encoded, again.encoded);
}

TEST_F(CubemapTracerTest, TintedGlassThatIsOffIsNotTinted) {
    Stage stage;
    Material tinted = clear_glass();
    tinted.attenuation_color = {0.1f, 0.5f, 0.9f};
    tinted.attenuation_distance = 0.2f;
    stage.add(sphere({0, 0, 0}, 1, 24), tinted);
    RenderSettings settings = settings_for(kView, 64);
    settings.refraction = false;
    const RenderResult off = cubemap(stage, white, settings);
    settings.reflection = false;
    settings.tracer = Tracer::none;
    tally(off, render(stage, white, settings), 1e-3).expect(0, 64 * 64);
}

TEST_F(CubemapTracerTest, EffectsThatAreOffSeeTheSky) {
    RenderSettings settings = settings_for(kView, 64);
    settings.reflection = settings.refraction = settings.shadow = false;
    const RenderResult off = cubemap(still_life(), white, settings);
    EXPECT_EQ(off.stats.maps.probes, 0u);
    EXPECT_EQ(off.stats.maps.shadows.maps, 0u);
    settings.tracer = Tracer::none;
    tally(off, render(still_life(), white, settings), 1e-5).expect(0, 64 * 64);
    // One by one: each changes the picture.
    const auto changed = [&](bool reflection, bool refraction, bool shadow) {
        settings.reflection = reflection;
        settings.refraction = refraction;
        settings.shadow = shadow;
        return tally(cubemap(still_life(), white, settings), off, 1e-3).wrong;
    };
    EXPECT_GT(changed(true, false, false), 200u);
    EXPECT_GT(changed(false, true, false), 50u);
    EXPECT_GT(changed(false, false, true), 20u);
}

TEST_F(CubemapTracerTest, WithoutBouncesOnlyShadowsRemain) {
    RenderSettings settings = settings_for(kView, 64);
    settings.bounces = 0;
    const RenderResult picture = cubemap(still_life(), white, settings);
    EXPECT_EQ(picture.stats.maps.probes, 0u);
    EXPECT_GT(picture.stats.maps.shadows.maps, 0u);
}

TEST_F(CubemapTracerTest, ManyMirrorsShareTheRoom) {
    // Their probes in the usual size would be more than Mesa's software driver binds at once.
    Stage stage;
    stage.add(ground(40), lambert({0.5f, 0.5f, 0.5f}));
    for (int i = 0; i < 49; i++)
        stage.add(sphere({float(i % 7) * 4 - 12, 1, float(i / 7) * 4 - 12}, 1.6f, 3), plane_mirror());
    RenderSettings settings = settings_for(perspective({0, 20, 30}, {0, 0, 0}, 50), 160);
    settings.bounces = 1;
    const RenderResult picture = cubemap(stage, white, settings);
    const CubeMaps::Stats& maps = picture.stats.maps;
    EXPECT_EQ(maps.probes, 49u);
    EXPECT_EQ(maps.left_out, 0u);
    EXPECT_EQ(maps.probe_bytes, 49ull * 6 * maps.face * maps.face * 8);
    const uint64_t room = device().limits().maxStorageBufferRange;
    EXPECT_LE(maps.probe_bytes, room);
    // A face as fine as the picture, or the next finer one has no room.
    EXPECT_LE(maps.face, 256u);
    EXPECT_TRUE(maps.face == 256u || 4 * maps.probe_bytes > room) << maps.face;
    for (const glm::vec4& p : picture.radiance) ASSERT_GT(p.x, 0.05f);
}

TEST_F(CubemapTracerTest, AFloorLooksAroundAboveWhatStandsOnIt) {
    // Its middle is under a body: a probe there would show the body's underside to the whole floor.
    Stage stage;
    stage.add(ground(5), plane_mirror());
    stage.add(box({-1, 0.001f, -1}, {1, 1.5f, 1}), unlit({1, 0, 0}));
    const RenderResult picture = cubemap(stage, white, settings_for(perspective({0, 3, 9}, {0, -2, 4.5f}, 20), 48));
    size_t red = 0;
    for (const glm::vec4& p : picture.radiance) red += p.y < 0.5f;
    EXPECT_EQ(red, 0u);
}

}  // namespace
}  // namespace peelray
