// The camera, auxiliary pictures, bands, antialiasing.
#include <pictures.h>

#include "motion/bounds.h"

namespace peelray {
namespace {

class CameraTest : public PictureTest {
  protected:
    /// Position and depth of every pixel on the plane z = 0 against the textbook.
    void expect_plane(const Camera& camera, uint32_t width, uint32_t height) {
        Stage stage;
        stage.add(parallelogram({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}), unlit({1, 1, 1}));
        RenderSettings settings = settings_for(camera);
        settings.width = width;
        settings.height = height;
        settings.aovs = true;
        const Aovs aovs = render(stage, black, settings).aovs;
        Tally result;
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++) {
                const ViewRay ray = view_ray(camera, width, height, x + 0.5, y + 0.5);
                const glm::dvec3 want = ray.at_plane(2, 0);
                if (std::abs(want.x) > 19 || std::abs(want.y) > 19 || ray.direction.z > -0.1 || want.z > ray.origin.z)
                    continue;
                const size_t i = y * width + x;
                const double depth = glm::length(want - ray.origin);
                result.add(near(glm::dvec3(aovs.position[i]), want, 1e-4) && std::abs(aovs.depth[i] - depth) < 1e-4,
                           [&] {
                               return fmt::format("pixel {},{}: {}, expected {}", x, y,
                                                  text(glm::dvec3(aovs.position[i])), text(want));
                           });
            }
        result.expect(0, width * height / 2);
    }
};

TEST_F(CameraTest, PixelsHitThePointsTheyShould) {
    expect_plane(perspective({0.4f, -0.3f, 3}, {1, 0.5f, 0}, 50), 64, 64);
    expect_plane(perspective({0.4f, -0.3f, 3}, {1, 0.5f, 0}, 50), 96, 40);                       // wide
    expect_plane(perspective({0.4f, -0.3f, 3}, {1, 0.5f, 0}, 50), 33, 77);                       // tall, odd
    expect_plane(perspective({0.4f, -0.3f, 3}, {1, 0.5f, 0}, 50, {0.7f, -0.2f, 0.1f}), 64, 48);  // rolled
    expect_plane(perspective({0.4f, -0.3f, 3}, {1, 0.5f, 0}, 110, {0, 500, 0}), 64, 64);
    expect_plane(orthographic({2, 1, 3}, {0, 0.5f, 0}, 5), 64, 64);
    expect_plane(orthographic({2, 1, 3}, {0, 0.5f, 0}, 5, {1, 1, 0}), 90, 30);
}

/// A floor, a box and a mirror, moved by `offset`.
Stage still_life(const glm::vec3& offset) {
    Stage stage;
    stage.add(ground(8), lambert({1, 1, 1}));
    stage.add(turned(box({-1, 0.5f, -1}, {1, 2, 1}), 25, {0, 1, 0}), unlit({0.8f, 0.3f, 0.1f}));
    stage.add(parallelogram({-6, 0.25f, -4}, {12, 0, 0}, {0, 6, 0}), plane_mirror());
    for (auto& node : stage.scene.nodes) node.local[3] = glm::vec4(offset, 1);
    stage.sun({0.5f, -1, -0.3f}, {2, 2, 2});
    return stage;
}

// The paper's Figure 7.
TEST_F(CameraTest, MirrorRaysAreSetUpAsThePaperHasThem) {
    const Stage stage = still_life({0, 0, 0});
    const Box box = bounds(stage.scene, at_rest(stage.scene));
    for (const Camera& camera : {perspective({3, 4, 7}, {0, 1, 0}, 50), orthographic({3, 4, 7}, {0, 1, 0}, 6)}) {
        RenderSettings settings = settings_for(camera, 96);
        settings.aovs = settings.ray_setup = true;
        const Aovs a = render(stage, black, settings).aovs;
        Tally result;
        for (uint32_t y = 0; y < settings.height; y++)
            for (uint32_t x = 0; x < settings.width; x++) {
                const size_t i = size_t(y) * settings.width + x;
                if (a.position[i].w == 0) {
                    result.add(a.reflection[i] == glm::vec4(0) && a.box[i] == glm::vec4(0), [] { return "the sky"; });
                    continue;
                }
                const ViewRay ray = view_ray(camera, settings.width, settings.height, x + 0.5, y + 0.5);
                const glm::dvec3 p(a.position[i]), n(a.normal[i]), d(a.reflection[i]), q(a.box[i]);
                const glm::dvec3 want = ray.direction - 2 * glm::dot(ray.direction, n) * n;
                // In the box, on one of its sides, and ahead.
                double side = 1e9;
                bool inside = true;
                for (int k = 0; k < 3; k++) {
                    side = std::min({side, std::abs(q[k] - box.lower[k]), std::abs(q[k] - box.upper[k])});
                    inside = inside && q[k] > box.lower[k] - 1e-4 && q[k] < box.upper[k] + 1e-4;
                }
                const bool ahead = glm::length(q - p - glm::length(q - p) * d) < 1e-4;
                const glm::vec4 &e = a.directions[i][0], &f = a.directions[i][1];
                const bool turned = glm::dvec3(f.x, f.y, e.y) == d && glm::dvec3(e.w, e.x, e.z) == d;
                result.add(near(d, want, 1e-5) && side < 1e-4 && inside && ahead && turned,
                           [&] { return fmt::format("pixel {},{}: {}, box {}", x, y, text(d), text(q)); });
            }
        result.expect(0, 96 * 96);
    }
}

TEST_F(CameraTest, FarFromTheOriginKeepsPrecision) {
    const glm::vec3 offset(100000, -50000, 70000);
    RenderSettings settings = settings_for(perspective({3, 4, 7}, {0, 1, 0}, 50), 96);
    settings.aovs = true;
    // Corners and camera on a 64th of a unit: the moved scene is exactly the same one.
    Stage here = still_life(glm::vec3(0));
    for (auto& mesh : here.scene.meshes)
        for (auto& p : mesh.primitives[0].positions) p = glm::round(p * 64.f) / 64.f;
    Stage there = here;
    for (auto& node : there.scene.nodes) node.local[3] = glm::vec4(offset, 1);
    const RenderResult near_by = render(here, white, settings);
    settings.camera.eye += offset;
    settings.camera.look += offset;
    const RenderResult far_off = render(there, white, settings);
    Tally depths;
    for (size_t i = 0; i < near_by.radiance.size(); i++)
        depths.add(near_by.aovs.triangle[i] == far_off.aovs.triangle[i] &&
                       (near_by.aovs.triangle[i] < 0 || std::abs(near_by.aovs.depth[i] - far_off.aovs.depth[i]) < 1e-3),
                   [&] { return fmt::format("pixel {}: {} and {}", i, near_by.aovs.depth[i], far_off.aovs.depth[i]); });
    depths.expect(0.001, 96 * 96);
    tally(near_by, far_off, 0.01).expect(0.02, 96 * 96);
}

TEST_F(CameraTest, AuxiliaryPicturesTellWhatIsThere) {
    Stage stage;
    stage.add(ground(5), lambert({0.2f, 0.4f, 0.6f}));                             // triangles 0, 1
    stage.add(box({-1, 0, -1}, {1, 1, 1}), unlit({0.9f, 0.8f, 0.7f}));             // 2 to 13
    stage.add(parallelogram({-4, 0.5f, -1}, {2, 0, 0}, {0, 0, 2}), thin_glass());  // 14, 15: its front looks down
    stage.scene.materials[2].base_color = {0.5f, 1, 1};
    RenderSettings settings =
        settings_for(orthographic({0, 4, 0}, {0, 0, 0}, 12, {0, 0, -1}), 24);  // half a unit a pixel
    settings.aovs = true;
    const RenderResult picture = render(stage, white, settings);
    const Aovs& a = picture.aovs;
    ASSERT_EQ(a.depth.size(), 576u);
    struct Point {
        double x, z, depth;
        int first, last, material;
        glm::dvec3 albedo;
    };
    const auto pixel = [](double x, double z) { return size_t((z + 6) * 2) * 24 + size_t((x + 6) * 2); };
    for (const Point& p :
         {Point{0.25, -0.75, 3, 2, 13, 1, {0.9, 0.8, 0.7}}, Point{3.25, 4.25, 4, 0, 1, 0, {0.2, 0.4, 0.6}},
          Point{-3.25, 0.25, 3.5, 14, 15, 2, {0.5, 1, 1}}}) {
        const size_t i = pixel(p.x, p.z);
        EXPECT_NEAR(a.depth[i], p.depth, 1e-5);
        EXPECT_TRUE(a.triangle[i] >= p.first && a.triangle[i] <= p.last) << a.triangle[i];
        EXPECT_EQ(a.material[i], p.material);
        EXPECT_TRUE(near(glm::dvec3(a.albedo[i]), p.albedo, 1e-6)) << text(glm::dvec3(a.albedo[i]));
        EXPECT_TRUE(near(glm::dvec3(a.normal[i]), {0, 1, 0}, 1e-6))
            << text(glm::dvec3(a.normal[i]));  // towards the viewer
        EXPECT_TRUE(near(glm::dvec3(a.position[i]), {p.x, 4 - p.depth, p.z}, 1e-5)) << text(glm::dvec3(a.position[i]));
        EXPECT_EQ(a.position[i].w, 1);
        EXPECT_EQ(picture.radiance[i].w, 1);
    }
    const size_t nothing = pixel(5.75, 5.75);
    EXPECT_EQ(a.depth[nothing], INFINITY);
    EXPECT_EQ(a.triangle[nothing], -1);
    EXPECT_EQ(a.material[nothing], -1);
    EXPECT_EQ(a.position[nothing].w, 0);
    EXPECT_EQ(picture.radiance[nothing].w, 0);
}

TEST_F(CameraTest, InsideAClosedRoomEveryPixelHits) {
    Stage stage;
    stage.add(box({-2, -1, -3}, {2, 1, 3}), lambert({1, 1, 1}));
    stage.lamp({0.5f, 0.3f, -1}, {1, 1, 1});
    for (const auto& look : {glm::vec3(1, 0.2f, 0.3f), {-1, -0.5f, -1}, {0.1f, 3, 0.2f}}) {
        const Camera camera = perspective({0.2f, -0.1f, 0.4f}, look, 100);
        const RenderResult picture = render(stage, white, settings_for(camera));
        // Lambert under the lamp and under the white sky that shading adds; nothing leaks, nothing is lost.
        tally(picture, camera, 2e-3, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
            const glm::dvec3 lower(-2, -1, -3), upper(2, 1, 3), lamp(0.5, 0.3, -1);
            double t = 1e9;
            int axis = 0;
            for (int k = 0; k < 3; k++) {
                const double hit = ((ray.direction[k] > 0 ? upper : lower)[k] - ray.origin[k]) / ray.direction[k];
                if (hit < t) t = hit, axis = k;
            }
            const glm::dvec3 p = ray.origin + t * ray.direction, to_lamp = lamp - p;
            return glm::dvec3(1 + std::abs(to_lamp[axis]) / std::pow(glm::length(to_lamp), 3) / kPi);
        }).expect(0.002, 4096);
        for (const auto& p : picture.radiance) ASSERT_EQ(p.w, 1);
    }
}

TEST_F(CameraTest, TheBoundsDecideHowFarAViewReaches) {
    // A wall fifty metres behind a small square: in sight, unless the scene is said to be no larger than the square.
    Stage stage;
    stage.add(parallelogram({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), unlit({1, 0, 0}));
    stage.add(parallelogram({-5, -5, -50}, {10, 0, 0}, {0, 10, 0}), unlit({0, 1, 0}));
    RenderSettings settings = settings_for(orthographic({0, 0, 3}, {0, 0, 0}, 4), 16);
    EXPECT_EQ(render(stage, white, settings).radiance.front(), glm::vec4(0, 1, 0, 1));
    settings.bounds = Box{{-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}};
    const RenderResult result = render(stage, white, settings);
    EXPECT_EQ(result.radiance.front(), glm::vec4(1, 1, 1, 0));
    EXPECT_EQ(result.radiance[8 * 16 + 8], glm::vec4(1, 0, 0, 1));
}

TEST_F(CameraTest, NothingInViewIsTheEnvironment) {
    const Camera camera = perspective({0, 5, 20}, {0, 5, 40}, 60);
    const RenderResult picture =
        render(still_life(glm::vec3(0)), color_environment({0.1f, 0.2f, 0.3f}), settings_for(camera, 16));
    tally(picture, camera, 1e-6, [](const ViewRay&) { return glm::dvec3(0.1f, 0.2f, 0.3f); }).expect(0, 256);
    for (const auto& p : picture.radiance) EXPECT_EQ(p.w, 0);
    EXPECT_EQ(picture.rays.secondary(), 0u);
}

TEST_F(CameraTest, BandsFitTogether) {
    // Wide enough for several bands on any device: the lowest 24 rows, rendered alone, must be the same.
    const uint32_t width = std::min(device().limits().maxImageDimension2D, 16384u), height = 120, rows = 24;
    Stage stage = still_life(glm::vec3(0));
    RenderSettings settings = settings_for(orthographic({3, 4, 7}, {0, 1, 0}, 9));
    settings.width = width;
    settings.height = height;
    settings.aovs = true;
    // Pixels may be oblong: the camera's aspect is that of the picture, so the height must be tiny.
    settings.camera.orthographic_height = 16.f * height / width;
    const RenderResult whole = render(stage, white, settings);
    const glm::vec3 forward = glm::normalize(settings.camera.look - settings.camera.eye);
    const glm::vec3 up = glm::normalize(glm::vec3(0, 1, 0) - forward * forward.y);
    const glm::vec3 down = up * (-0.5f * settings.camera.orthographic_height * (height - rows) / height);
    settings.camera.eye += down;
    settings.camera.look += down;
    settings.camera.orthographic_height *= float(rows) / height;
    settings.height = rows;
    const RenderResult part = render(stage, white, settings);
    Tally result;
    const size_t shift = size_t(height - rows) * width;
    for (size_t i = 0; i < part.radiance.size(); i++)
        result.add(near(glm::dvec3(part.radiance[i]), glm::dvec3(whole.radiance[i + shift]), 2e-3) &&
                       part.aovs.triangle[i] == whole.aovs.triangle[i + shift],
                   [&] {
                       return fmt::format("pixel {},{}: {} and {}", i % width, i / width,
                                          text(glm::dvec3(part.radiance[i])),
                                          text(glm::dvec3(whole.radiance[i + shift])));
                   });
    result.expect(0.002, part.radiance.size());
}

/// Mirrors, glass, rough metal, shadows, sampled: everything that draws random numbers or shares queues.
Stage everything() {
    Stage stage = still_life(glm::vec3(0));
    stage.add(sphere({2, 1, 1.5f}, 0.8f, 12), clear_glass());
    Material rough = metal("rough", {0.9f, 0.7f, 0.4f});
    rough.roughness = 0.4f;
    stage.add(sphere({-2, 1, 1.5f}, 0.8f, 12), rough);
    return stage;
}

TEST_F(CameraTest, TheSamePictureTwice) {
    RenderSettings settings = settings_for(perspective({3, 4, 7}, {0, 1, 0}, 50), 96);
    settings.spp = 3;
    settings.ambient = true;
    const Stage stage = everything();
    const Environment sky = sky_environment(default_sun_direction());
    const auto renderer = renderer_for(stage, sky);
    const RenderResult first = renderer->render(settings), again = renderer->render(settings),
                       fresh = render(stage, sky, settings);
    EXPECT_EQ(tally(first, again, 0).wrong, 0u);
    EXPECT_EQ(tally(first, fresh, 0).wrong, 0u);
    EXPECT_EQ(first.encoded, again.encoded);
    EXPECT_EQ(first.rays.secondary(), again.rays.secondary());
}

TEST_F(CameraTest, RepeatedFramesChangeNothing) {
    RenderSettings settings = settings_for(perspective({3, 4, 7}, {0, 1, 0}, 50), 48);
    const RenderResult once = render(everything(), white, settings);
    settings.repeat = 3;
    const RenderResult thrice = render(everything(), white, settings);
    EXPECT_EQ(tally(once, thrice, 0).wrong, 0u);
    EXPECT_EQ(once.rays.secondary(), thrice.rays.secondary());
}

TEST_F(CameraTest, SamplesAverageTheEdge) {
    // White right of a slanted line through the middle.
    Stage stage;
    stage.add(faces({{{-0.4f, -2, 0}, {3, -2, 0}, {3, 2, 0}, {0.4f, 2, 0}}}), unlit({1, 1, 1}));
    const Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 2);
    RenderSettings settings = settings_for(camera, 16);
    settings.spp = 128;
    const RenderResult picture = render(stage, black, settings);
    Tally result;
    for (uint32_t y = 0; y < 16; y++)
        for (uint32_t x = 0; x < 16; x++) {
            double coverage = 0;  // exact in x, 64 rows in y
            for (int i = 0; i < 64; i++) {
                const double edge = 0.2 * (1 - 2 * (y + (i + 0.5) / 64) / 16);  // x of the line
                coverage += std::clamp((x + 1) - (edge + 1) * 8, 0.0, 1.0) / 64;
            }
            const glm::dvec3 got = radiance_at(picture, x, y);
            result.add(near(got, glm::dvec3(coverage), 0.03),
                       [&] { return fmt::format("pixel {},{}: {:.4f}, expected {:.4f}", x, y, got.x, coverage); });
        }
    result.expect(0, 256);
    EXPECT_EQ(picture.rays.primary, 256u * 128u);
}

}  // namespace
}  // namespace peelray
