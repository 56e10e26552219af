// Refraction in closed form: slabs, a prism, absorption, glass behind glass.
#include <pictures.h>

namespace peelray {
namespace {

using GlassTest = PictureTest;

/// The background's light: a gradient, so that a shifted ray sees another value.
glm::dvec3 backdrop_light(const glm::dvec3& p) {
    return {1 + 0.2 * p.x, 1 - 0.2 * p.y, 1 + 0.1 * (p.x + p.y)};
}

void add_backdrop(Stage& stage) {
    stage.add(gradient_quad({-4.5f, -4.5f, -2}, {9, 0, 0}, {0, 9, 0},
                            [](glm::vec3 p) { return glm::vec3(backdrop_light(p)); }),
              unlit({1, 1, 1}));
}

/// What a ray towards -z sees through slabs that are normal to z, each {front, back}, by Snell's law; no inner
/// reflections.
struct SlabPath {
    glm::dvec3 end;          ///< on the background at z = -2
    double inside = 0;       ///< length inside glass
    double transmitted = 1;  ///< by all faces
    double reflected = 0;    ///< by one face
};
SlabPath through_slabs(const ViewRay& ray, const std::vector<glm::dvec2>& slabs, double ior) {
    const double cosine = -ray.direction.z, sine = std::sqrt(1 - cosine * cosine);
    const double cosine_t = std::sqrt(1 - sine * sine / (ior * ior));
    const glm::dvec3 inner(ray.direction.x / ior, ray.direction.y / ior, -cosine_t);
    SlabPath path{ray.origin};
    path.reflected = fresnel(cosine, 1, ior);
    for (const glm::dvec2& slab : slabs) {
        path.end += ray.direction * ((slab.x - path.end.z) / ray.direction.z);
        const double length = (slab.x - slab.y) / cosine_t;
        path.end += inner * length;
        path.inside += length;
        path.transmitted *= (1 - path.reflected) * (1 - fresnel(cosine_t, ior, 1));
    }
    path.end += ray.direction * ((-2 - path.end.z) / ray.direction.z);
    return path;
}
bool off_backdrop(const SlabPath& path) {
    return std::abs(path.end.x) > 4.3 || std::abs(path.end.y) > 4.3;
}

/// Compares from both sides: light that was reflected inside the glass may only add, and only its bound.
Tally tally_slabs(const RenderResult& picture, const Camera& camera, const std::vector<glm::dvec2>& slabs,
                  const glm::dvec3& absorption, double pairs) {
    Tally result;
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++) {
            const SlabPath path =
                through_slabs(view_ray(camera, picture.width, picture.height, x + 0.5, y + 0.5), slabs, 1.5);
            if (off_backdrop(path)) continue;
            const glm::dvec3 want = backdrop_light(path.end) * path.transmitted * glm::exp(-absorption * path.inside),
                             got = radiance_at(picture, x, y);
            const double more = pairs * path.reflected * path.reflected * 2;
            bool right = true;
            for (int c = 0; c < 3; c++) right &= got[c] >= want[c] - 1e-3 && got[c] <= want[c] + more + 1e-3;
            result.add(right, [&] {
                return fmt::format("pixel {},{}: {}, expected {} to {:.5f} more", x, y, text(got), text(want), more);
            });
        }
    return result;
}

Primitive slab(float front, float back) {
    return box({-4, -4, back}, {4, 4, front});
}

TEST_F(GlassTest, RaysThatEndAtTheLastBounceAreCounted) {
    RenderSettings settings = settings_for(perspective({0, 0, 9}, {0, 0, 0}, 30), 16);
    settings.reflection = settings.shadow = false;
    settings.bounces = 4;
    for (const int panes : {4, 5, 7}) {
        Stage stage;
        for (int i = 0; i < panes; i++)
            stage.add(parallelogram({-8, -8, float(-i)}, {16, 0, 0}, {0, 16, 0}), thin_glass());
        const auto cut = [&](uint32_t bounces) {
            settings.bounces = bounces;
            const auto picture = render(stage, white, settings);
            EXPECT_EQ(picture.rays.cut_reflection, 0u);
            EXPECT_EQ(picture.rays.refraction, 16u * 16 * std::min<uint64_t>(bounces, uint64_t(panes)));
            return picture.rays.cut_refraction;
        };
        // The last bounce's ray goes to pane number 1 + bounces, and would go on behind it.
        EXPECT_EQ(cut(4), panes > 4 ? 16u * 16 : 0u) << panes;
        EXPECT_EQ(cut(3), 16u * 16) << panes;
        EXPECT_EQ(cut(7), 0u) << panes;
        EXPECT_EQ(cut(0), 0u) << "nobody asked for bounces";
    }
    // Between two mirrors rays never end; half of the light is lost at each, so that they are cut by their weight.
    Stage stage;
    stage.add(parallelogram({-30, -30, 0}, {60, 0, 0}, {0, 60, 0}), plane_mirror(glm::vec3(0.5f)));
    stage.add(parallelogram({-30, -30, 10}, {0, 60, 0}, {60, 0, 0}), plane_mirror(glm::vec3(0.5f)));
    settings.reflection = true;
    settings.bounces = 4;
    EXPECT_EQ(render(stage, white, settings).rays.cut_reflection, 16u * 16);
    settings.bounces = 12;
    EXPECT_EQ(render(stage, white, settings).rays.cut_reflection, 0u);
}

TEST_F(GlassTest, SlabShiftsTheBackgroundBySnellsLaw) {
    Stage stage;
    add_backdrop(stage);
    stage.add(slab(0.3f, -0.3f), clear_glass());
    const Camera camera = perspective({1.6f, 0.9f, 2}, {0.5f, 0.2f, 0}, 50);
    const RenderResult picture = render(stage, black, settings_for(camera, 96));
    tally_slabs(picture, camera, {{0.3, -0.3}}, glm::dvec3(0), 1).expect(0, 8000);
    // The shift is there at all: the straight ray does not explain the picture.
    const Tally straight = tally_slabs(picture, camera, {{0.3, 0.3}}, glm::dvec3(0), 1);
    EXPECT_GT(double(straight.wrong), 0.8 * double(straight.compared));
}

TEST_F(GlassTest, ThinWallDoesNotShift) {
    Stage stage;
    add_backdrop(stage);
    stage.add(parallelogram({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), thin_glass());
    const Camera camera = perspective({1.6f, 0.9f, 2}, {0.5f, 0.2f, 0}, 50);
    tally(render(stage, black, settings_for(camera)), camera, 1e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const glm::dvec3 end = ray.at_plane(2, -2);
              if (std::abs(end.x) > 4.3 || std::abs(end.y) > 4.3) return {};
              const double r = fresnel(-ray.direction.z, 1, 1.5);
              return backdrop_light(end) * (1 - 2 * r / (1 + r));  // all inner reflections of both faces summed up
          })
        .expect(0, 3500);
}

TEST_F(GlassTest, AbsorptionFollowsBeerAndLambert) {
    Material tinted = clear_glass();
    tinted.attenuation_color = {0.2f, 0.5f, 0.8f};
    tinted.attenuation_distance = 0.7f;
    const glm::dvec3 absorption = -glm::log(glm::dvec3(0.2, 0.5, 0.8)) / 0.7;
    const Camera camera = perspective({1.6f, 0.9f, 2}, {0.5f, 0.2f, 0}, 60);
    for (float thickness : {0.1f, 0.5f, 1.2f}) {
        SCOPED_TRACE(thickness);
        Stage stage;
        add_backdrop(stage);
        stage.add(slab(0.2f, 0.2f - thickness), tinted);
        tally_slabs(render(stage, black, settings_for(camera)), camera, {{0.2f, 0.2f - thickness}}, absorption, 1)
            .expect(0, 3000);
    }
}

TEST_F(GlassTest, PrismReflectsTotally) {
    Stage stage;
    stage.add(faces({{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
                     {{-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1}},
                     {{-1, 1, 1}, {1, 1, 1}, {1, -1, -1}, {-1, -1, -1}},
                     {{1, -1, 1}, {1, -1, -1}, {1, 1, 1}},
                     {{-1, -1, 1}, {-1, 1, 1}, {-1, -1, -1}}}),
              clear_glass());
    const auto light = [](const glm::dvec3& p) { return glm::dvec3(1 + 0.3 * p.x, 1 + 0.3 * p.z, 1); };
    stage.add(gradient_quad({-3, -2, 3}, {6, 0, 0}, {0, 0, -6}, [&](glm::vec3 p) { return glm::vec3(light(p)); }),
              unlit({1, 1, 1}));
    stage.add(parallelogram({-3, -3, -3}, {6, 0, 0}, {0, 6, 0}),
              unlit({0, 9, 0}));  // seen if the slanted face let light through
    const Camera camera = orthographic({0.013f, 0.007f, 5}, {0.013f, 0.007f, 0}, 1.6f);
    tally(render(stage, black, settings_for(camera)), camera, 4e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              // In at right angles, down at the slanted face y = z, out at right angles.
              return 0.96 * 0.96 * light({ray.origin.x, -2, ray.origin.y});
          })
        .expect(0.001, 4096);
}

TEST_F(GlassTest, GlassBehindGlassIsThere) {
    const Camera camera = orthographic({0.9f, 0.5f, 3}, {0, 0, 0}, 2.5f);
    Stage stage;
    add_backdrop(stage);
    stage.add(slab(1, 0.4f), clear_glass());
    const RenderResult front_only = render(stage, black, settings_for(camera));
    stage.add(slab(-0.4f, -1.2f), clear_glass());
    const RenderResult both = render(stage, black, settings_for(camera));
    tally_slabs(front_only, camera, {{1, 0.4}}, glm::dvec3(0), 1).expect(0, 4096);
    tally_slabs(both, camera, {{1, 0.4}, {-0.4, -1.2}}, glm::dvec3(0), 6).expect(0, 4096);
    EXPECT_EQ(tally(front_only, both, 0.03).wrong, 4096u);
}

/// A white sheet in glass: its edge is where the bent rays meet it.
TEST_F(GlassTest, BodyInsideGlassIsDisplaced) {
    Stage stage;
    stage.add(slab(1, -1), clear_glass());
    stage.add(parallelogram({-3, -3, -0.5f}, {3.25f, 0, 0}, {0, 6, 0}), unlit({1, 1, 1}));  // x < 0.25
    const Camera camera = orthographic({2, 0, 3}, {0, 0, 0}, 1.6f);
    const RenderResult picture = render(stage, black, settings_for(camera, 96));
    tally(picture, camera, 0.01, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
        const glm::dvec3 in = ray.at_plane(2, 1);
        const double sine = ray.direction.x / 1.5, x = in.x + sine / std::sqrt(1 - sine * sine) * 1.5;
        if (x > 0.22 && x < 0.7) return {};  // the edge, and right of it the body's image in the glass's back
        return glm::dvec3(x < 0.25 ? 1 - fresnel(-ray.direction.z, 1, 1.5) : 0);
    }).expect(0, 5000);
}

TEST_F(GlassTest, ShadowOfGlassLetsLightThrough) {
    Material tinted = clear_glass();
    tinted.attenuation_color = {0.3f, 0.6f, 0.9f};
    tinted.attenuation_distance = 0.4f;
    const Camera camera = orthographic({3, 0.9f, 0}, {3, 0, 0}, 1, {0, 0, -1});  // below the glass
    Stage stage;
    stage.add(ground(6), lambert({1, 1, 1}));
    stage.add(box({-0.1f, 1, -2}, {6, 1.4f, 2}), tinted);
    stage.sun({0, -1, 0}, {3, 3, 3});
    const glm::dvec3 want = 3 / kPi * 0.96 * 0.96 * glm::dvec3(0.3, 0.6, 0.9);
    tally(render(stage, black, settings_for(camera)), camera, 2e-3, [&](const ViewRay&) {
        return want;
    }).expect(0, 4096);
}

}  // namespace
}  // namespace peelray
