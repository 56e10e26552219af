// What each pixel sees, by compute: the triangle that its ray meets first, whatever its size and place; as the
// rasteriser but for pixels on edges.
#include <pictures.h>
#include "effort.h"
#include "scene/sidedness.h"

namespace peelray {
namespace {

/// Distance to the nearest triangle along a ray and, if there is one, its number; in double, by brute force.
struct Nearest {
    double distance = INFINITY, second = INFINITY;
    int triangle = -1;
};

Nearest nearest(const Geometry& geometry, const ViewRay& ray, const Sidedness& sides) {
    Nearest result;
    for (size_t i = 0; i < geometry.triangles.size(); i++) {
        const glm::uvec3 corners = geometry.triangles[i];
        const glm::dvec3 a = geometry.positions[corners.x], u = glm::dvec3(geometry.positions[corners.y]) - a,
                         v = glm::dvec3(geometry.positions[corners.z]) - a, n = glm::cross(ray.direction, v);
        const double det = glm::dot(u, n);
        if (det == 0 || !sides.shows(uint32_t(i), det > 0)) continue;  // det = -direction · (u × v)
        const glm::dvec3 from = (ray.origin - a) / det, q = glm::cross(from, u);
        const double b = glm::dot(from, n), c = glm::dot(ray.direction, q), t = glm::dot(v, q);
        if (b < 0 || c < 0 || b + c > 1 || t < 0 || t > result.second) continue;
        if (t < result.distance) {
            result.second = result.distance;
            result.distance = t;
            result.triangle = int(i);
        } else {
            result.second = t;
        }
    }
    return result;
}

class VisibilityTest : public PictureTest {
  protected:
    RenderSettings with(const Camera& camera, Visibility visibility) {
        RenderSettings settings = settings_for(camera);
        settings.width = 101;
        settings.height = 67;
        settings.visibility = visibility;
        settings.aovs = true;
        return settings;
    }

    /// Of the compute shaders' pixels none may differ from the truth, but where two surfaces or a surface and nothing
    /// are within rounding of each other.
    void expect_truth(const Stage& stage, const Camera& camera, size_t at_least) {
        const RenderSettings settings = with(camera, Visibility::compute);
        const RenderResult picture = render(stage, black, settings);
        EXPECT_EQ(picture.stats.visibility, Visibility::compute);
        const Geometry geometry = flatten(stage.scene);
        const Sidedness sides(stage.scene, geometry);
        Tally result;
        size_t surfaces = 0;
        for (uint32_t y = 0; y < settings.height; y++)
            for (uint32_t x = 0; x < settings.width; x++) {
                const size_t i = size_t(y) * settings.width + x;
                const Nearest want =
                    nearest(geometry, view_ray(camera, settings.width, settings.height, x + 0.5, y + 0.5), sides);
                const double got = picture.aovs.depth[i];
                const bool right = want.triangle < 0 ? picture.aovs.triangle[i] < 0
                                                     : std::abs(got - want.distance) < 1e-3 * (1 + want.distance);
                surfaces += want.triangle >= 0;
                result.add(right, [&] {
                    return fmt::format("pixel {},{}: {} of triangle {}, expected {} of {}", x, y, got,
                                       picture.aovs.triangle[i], want.distance, want.triangle);
                });
            }
        result.expect(0.0005, size_t(settings.width) * settings.height);  // silhouettes: three pixels
        EXPECT_GT(surfaces, at_least);
    }
};

/// Huge triangles that pass below, behind and through the eye, a fine ball, and its mirror image.
Stage all_kinds() {
    Stage stage;
    stage.add(ground(1000), lambert({1, 1, 1}));
    stage.add(parallelogram({-300, -200, 60}, {700, 0, 0}, {0, 500, 0}), lambert({1, 0, 0}));    // behind
    stage.add(parallelogram({1.5f, -50, -80}, {0, 0, 300}, {0.2f, 90, 0}), lambert({0, 1, 0}));  // beside, crossing
    stage.add(sphere({-0.8f, 0.7f, 0}, 0.6f, test::effort(12u, 24u)), lambert({0, 0, 1}));
    stage.add(box({-0.4f, 0, 1}, {-0.1f, 0.3f, 1.3f}), lambert({1, 1, 0}));
    Node mirrored;
    mirrored.mesh = 3;
    mirrored.local = glm::translate(glm::scale(glm::mat4(1), {-1, 1.3f, 1}), {0.3f, 0, 0.5f});
    stage.scene.nodes.push_back(mirrored);
    return stage;
}

TEST_F(VisibilityTest, PixelsSeeWhatTheirRaysHit) {
    const Stage stage = all_kinds();
    expect_truth(stage, perspective({0.2f, 1, 4}, {0, 0.5f, 0}, 60), 3000);
    expect_truth(stage, perspective({0.2f, 0.02f, 4}, {0, 0.3f, 0}, 100), 2000);      // all but in the floor
    expect_truth(stage, perspective({-0.8f, 0.7f, 0.1f}, {-1, 0.6f, -1}, 70), 6000);  // inside the ball
    expect_truth(stage, orthographic({0.3f, 2, 4}, {0, 0.5f, 0}, 3), 3000);
    expect_truth(stage, orthographic({0.3f, 0.5f, 0.1f}, {0, 0.3f, -4}, 3), 2000);  // from among the bodies
}

TEST_F(VisibilityTest, BacksOfSingleSidedTrianglesAreNotSeen) {
    Stage stage = all_kinds();
    for (Material& material : stage.scene.materials) material.double_sided = false;
    expect_truth(stage, perspective({0.2f, 1, 4}, {0, 0.5f, 0}, 60), 2000);
    expect_truth(stage, perspective({0.2f, -0.5f, 4}, {0, 0.5f, 0}, 60), 100);       // from below the floor
    expect_truth(stage, perspective({-0.8f, 0.7f, 0.1f}, {-1, 0.6f, -1}, 70), 500);  // inside the ball
    expect_truth(stage, orthographic({0.3f, 0.5f, 0.1f}, {0, 0.3f, -4}, 3), 500);
    // Ball and floor alone: both ways.
    for (size_t i : {1, 2, 4}) stage.scene.materials[i].double_sided = true;
    for (const Camera& camera :
         {perspective({0.2f, 1, 4}, {0, 0.5f, 0}, 60), perspective({0.2f, -0.5f, 4}, {0, 0.5f, 0}, 60),
          orthographic({0.3f, 0.5f, 0.1f}, {0, 0.3f, -4}, 3)}) {
        const RenderResult compute = render(stage, black, with(camera, Visibility::compute)),
                           raster = render(stage, black, with(camera, Visibility::raster));
        Tally triangles;
        for (size_t i = 0; i < compute.aovs.triangle.size(); i++)
            triangles.add(compute.aovs.triangle[i] == raster.aovs.triangle[i], [&] {
                return fmt::format("pixel {}: {} and {}", i, compute.aovs.triangle[i], raster.aovs.triangle[i]);
            });
        triangles.expect(0.01, 101 * 67);
    }
}

TEST_F(VisibilityTest, ComputeAndRasterAgreeButForEdges) {
    const Stage stage = all_kinds();
    for (const Camera& camera :
         {perspective({0.2f, 1, 4}, {0, 0.5f, 0}, 60), orthographic({0.3f, 2, 4}, {0, 0.5f, 0}, 3)}) {
        const RenderResult compute = render(stage, black, with(camera, Visibility::compute)),
                           raster = render(stage, black, with(camera, Visibility::raster));
        EXPECT_EQ(raster.stats.visibility, Visibility::raster);
        Tally triangles;
        for (size_t i = 0; i < compute.aovs.triangle.size(); i++)
            triangles.add(compute.aovs.triangle[i] == raster.aovs.triangle[i], [&] {
                return fmt::format("pixel {}: {} and {}", i, compute.aovs.triangle[i], raster.aovs.triangle[i]);
            });
        triangles.expect(0.01, 101 * 67);
    }
}

TEST_F(VisibilityTest, HolesAreSeenThrough) {
    Stage stage;
    stage.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), masked(stage, unlit({1, 0, 0})));
    stage.add(parallelogram({-2, -2, -1}, {4, 0, 0}, {0, 4, 0}), unlit({0, 1, 0}));
    const Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 3.03f);
    const RenderResult compute = render(stage, black, with(camera, Visibility::compute)),
                       raster = render(stage, black, with(camera, Visibility::raster));
    tally(compute, raster, 1e-6).expect(0.005, 101 * 67);
    size_t red = 0, green = 0;
    for (const glm::vec4& pixel : compute.radiance) (pixel.x > 0.5f ? red : green)++;
    EXPECT_GT(red, 500u);
    EXPECT_GT(green, 1000u);
}

TEST_F(VisibilityTest, ManyLargeTrianglesFindRoom) {
    // Each sheet takes hundreds of blocks; the nearest one is drawn first, in the middle and last.
    for (int first : {0, 7, 19}) {
        Stage stage;
        for (int i = 0; i < 20; i++) {
            const float z = i == first ? 0 : -1 - float(i);
            stage.add(parallelogram({-40, -40, z}, {80, 0, 0}, {0, 80, 0}),
                      unlit(i == first ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
        }
        RenderSettings settings = with(perspective({0, 0, 3}, {0, 0, 0}, 60), Visibility::compute);
        settings.aovs = false;
        settings.width = settings.height = first == 0 ? 704 : 96;
        const RenderResult picture = render(stage, black, settings);
        settings.visibility = Visibility::raster;  // the build may be done again as well
        EXPECT_EQ(picture.stats.redone > render(stage, black, settings).stats.redone, first == 0)
            << "40 triangles in 7744 blocks each, room for 65536";
        Tally result;
        for (const glm::vec4& pixel : picture.radiance)
            result.add(pixel == glm::vec4(1, 0, 0, 1), [] { return "another sheet"; });
        result.expect(0, picture.radiance.size());
    }
}

TEST_F(VisibilityTest, OfTheSameDepthTheFirstIsSeenAlways) {
    Stage stage;
    for (int i = 0; i < 6; i++) stage.add(parallelogram({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), unlit({i == 0, i != 0, 0}));
    const RenderResult picture = render(stage, black, with(orthographic({0, 0, 3}, {0, 0, 0}, 4), Visibility::compute));
    for (const glm::vec4& pixel : picture.radiance) ASSERT_EQ(pixel, glm::vec4(1, 0, 0, 1));
}

TEST_F(VisibilityTest, DevicesThatCannotSaySo) {
    Stage stage;
    stage.add(ground(1), unlit({1, 1, 1}));
    RenderSettings settings = with(from_above(1), Visibility::compute);
    const bool able = device().features.int64_atomics;
    device().features.int64_atomics = false;
    expect_error([&] { render(stage, black, settings); }, {"64-bit atomics", "--visibility raster"});
    settings.visibility = Visibility::automatic;
    EXPECT_EQ(render(stage, black, settings).stats.visibility, Visibility::raster);
    device().features.int64_atomics = able;
}

}  // namespace
}  // namespace peelray
