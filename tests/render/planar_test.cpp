// Planar hits: a plane's worth of truth. Few pixels may differ from exact ones.
#include <pictures.h>

namespace peelray {
namespace {

class PlanarTest : public PictureTest {
  protected:
    RenderSettings with(const Camera& camera, HitTest hit) {
        RenderSettings settings = settings_for(camera, 128);
        settings.cubes.hit = hit;
        settings.cubes.ldc = hit == HitTest::planar ? 512 : 64;
        return settings;
    }
};

TEST_F(PlanarTest, MirrorPictureHasFewWrongPixels) {
    // Seen in the mirror: a finely tessellated ball, a textured wall of two large triangles and a lit floor.
    Stage stage;
    stage.add(sphere({0.8f, 0.6f, 1.9f}, 0.5f, 24), lambert({0.9f, 0.5f, 0.2f}));
    stage.add(box({-1.5f, 0, 1}, {-0.9f, 1.1f, 1.6f}), unlit({0.2f, 0.8f, 0.1f}));
    stage.add(gradient_quad({3, -1, 4}, {-6, 0, 0}, {0, 4, 0},
                            [](glm::vec3 p) { return glm::vec3(0.5f + 0.1f * p.x, 0.4f + 0.1f * p.y, 0.3f); }),
              unlit({1, 1, 1}));
    stage.add(parallelogram({-3, 0, 4}, {6, 0, 0}, {0, 0, -3.7f}), lambert({0.8f, 0.8f, 0.8f}));
    stage.add(parallelogram({-3, -1, 0}, {6, 0, 0}, {0, 4, 0}), plane_mirror());
    stage.lamp({1.5f, 2.5f, 1.5f}, {10, 10, 10});
    const Camera camera = perspective({0.2f, 0.8f, 0.95f}, {0, 0.7f, 0}, 75);
    const RenderResult exact = render(stage, white, with(camera, HitTest::exact)),
                       planar = render(stage, white, with(camera, HitTest::planar));
    EXPECT_EQ(planar.stats.hit, HitTest::planar);
    tally(exact, planar, 0.03).expect(0.02, 128 * 128);
}

TEST_F(PlanarTest, NoAcneOnACurvedMirror) {
    // A convex mirror must not see itself: a second reflection would be darker.
    const Camera camera = perspective({0.8f, 1.1f, 3}, {0, 0, 0}, 40);
    Stage tinted;
    tinted.add(sphere({0, 0, 0}, 1, 32), plane_mirror(glm::vec3(0.5f)));
    RenderSettings settings = with(camera, HitTest::planar);
    settings.cubes.ldc = 256;
    settings.aovs = true;
    const RenderResult picture = render(tinted, white, settings);
    Tally result;
    for (uint32_t y = 0; y < 128; y++)
        for (uint32_t x = 0; x < 128; x++) {
            const size_t i = y * 128 + x;
            if (picture.aovs.triangle[i] < 0) continue;
            const double cosine =
                -glm::dot(view_ray(camera, 128, 128, x + 0.5, y + 0.5).direction, glm::dvec3(picture.aovs.normal[i]));
            const double want = 0.5 + 0.5 * std::pow(1 - cosine, 5);
            const glm::dvec3 got = radiance_at(picture, x, y);
            result.add(near(got, glm::dvec3(want), 0.01),
                       [&] { return fmt::format("pixel {},{}: {:.4f}, expected {:.4f}", x, y, got.x, want); });
        }
    result.expect(0.005, 5000);
}

TEST_F(PlanarTest, NoAcneInLampLight) {
    Stage stage;
    stage.add(sphere({0, 1, 0}, 1, 32), lambert({1, 1, 1}));
    stage.add(ground(3), lambert({1, 1, 1}));
    stage.sun({-0.5f, -1, -0.4f}, {3, 3, 3});
    const Camera camera = perspective({1.5f, 3, 4}, {0, 0.7f, 0}, 50);
    tally(render(stage, black, with(camera, HitTest::exact)), render(stage, black, with(camera, HitTest::planar)), 0.02)
        .expect(0.02, 128 * 128);
}

TEST_F(PlanarTest, HolesAreSeenInMirrorsAndLetLightThrough) {
    Stage stage;
    stage.add(ground(2), plane_mirror());
    stage.add(parallelogram({-1.5f, 0.1f, -1}, {3, 0, 0}, {0, 2, 0}), masked(stage, lambert({0.9f, 0.3f, 0.1f})));
    stage.add(parallelogram({-2, 0, -1.6f}, {4, 0, 0}, {0, 3, 0}), lambert({0.3f, 0.5f, 0.9f}));
    stage.sun({-0.2f, -0.5f, -1}, glm::vec3(2));
    const Camera camera = perspective({0.3f, 0.8f, 2.5f}, {0, 0.3f, -1}, 60);
    tally(render(stage, black, with(camera, HitTest::exact)), render(stage, black, with(camera, HitTest::planar)), 0.02)
        .expect(0.03, 128 * 128);
}

TEST_F(PlanarTest, ColouredGlassTintsItsShadow) {
    // A pane whose tint changes from corner to corner, straight above the floor.
    Stage stage;
    stage.add(ground(2), lambert({1, 1, 1}));
    stage.add(gradient_quad({-2, 1, 2}, {4, 0, 0}, {0, 0, -4},
                            [](glm::vec3 p) { return glm::vec3((p.x + 2) / 4, (p.z + 2) / 4, 1); }),
              thin_glass());
    stage.sun({0, -1, 0}, glm::vec3(kPi));
    RenderSettings settings = with(orthographic({0, 0.9f, 0}, {0, 0, 0}, 3.5f, {0, 0, -1}), HitTest::planar);
    settings.width = settings.height = 32;
    settings.cubes.ldc = 128;
    tally(render(stage, black, settings), settings.camera, 0.02, [](const ViewRay& ray) {
        return glm::dvec3((ray.origin.x + 2) / 4, (ray.origin.z + 2) / 4, 1) * (1 - 0.08 / 1.04);
    }).expect(0, 1024);
}

}  // namespace
}  // namespace peelray
