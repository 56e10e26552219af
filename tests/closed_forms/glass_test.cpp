// Refraction in closed form: slabs, a prism, absorption, glass behind glass.
#include <pictures.h>

#include "layers.h"

namespace peelray {
namespace {

using GlassTest = PictureTest;

/// What is seen through slabs of glass, each {front, back}.
Tally tally_slabs(const RenderResult& picture, const Camera& camera, const std::vector<glm::dvec2>& slabs,
                  const glm::dvec3& absorption = glm::dvec3(0)) {
    std::vector<Layer> layers;
    for (const glm::dvec2& slab : slabs) {
        layers.push_back({slab.x, 1.5, absorption});
        layers.push_back({slab.y, 1});
    }
    return tally_layers(picture, camera, layers, {0, 1}, 1, 1e-3);
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
    add_lit_wall(stage);
    stage.add(plate(0.3f, -0.3f), clear_glass());
    const Camera camera = perspective({1.6f, 0.9f, 2}, {0.5f, 0.2f, 0}, 50);
    const RenderResult picture = render(stage, black, settings_for(camera, 96));
    tally_slabs(picture, camera, {{0.3, -0.3}}).expect(0, 8000);
    // The shift is there at all: the straight ray does not explain the picture.
    const Tally straight = tally_slabs(picture, camera, {{0.3, 0.3}});
    EXPECT_GT(double(straight.wrong), 0.8 * double(straight.compared));
}

TEST_F(GlassTest, ThinWallDoesNotShift) {
    Stage stage;
    add_lit_wall(stage);
    stage.add(parallelogram({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), thin_glass());
    const Camera camera = perspective({1.6f, 0.9f, 2}, {0.5f, 0.2f, 0}, 50);
    tally(render(stage, black, settings_for(camera)), camera, 1e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const glm::dvec3 end = ray.at_plane(2, -2);
              if (std::abs(end.x) > 4.3 || std::abs(end.y) > 4.3) return {};
              const double r = fresnel(-ray.direction.z, 1, 1.5);
              return wall_light(end) * (1 - 2 * r / (1 + r));  // all inner reflections of both faces summed up
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
        add_lit_wall(stage);
        stage.add(plate(0.2f, 0.2f - thickness), tinted);
        tally_slabs(render(stage, black, settings_for(camera)), camera, {{0.2f, 0.2f - thickness}}, absorption)
            .expect(0, 3000);
    }
}

TEST_F(GlassTest, PrismReflectsTotally) {
    Stage stage;
    stage.add(prism(), clear_glass());
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
    add_lit_wall(stage);
    stage.add(plate(1, 0.4f), clear_glass());
    const RenderResult front_only = render(stage, black, settings_for(camera));
    stage.add(plate(-0.4f, -1.2f), clear_glass());
    const RenderResult both = render(stage, black, settings_for(camera));
    tally_slabs(front_only, camera, {{1, 0.4}}).expect(0, 4096);
    tally_slabs(both, camera, {{1, 0.4}, {-0.4, -1.2}}).expect(0, 4096);
    EXPECT_EQ(tally(front_only, both, 0.03).wrong, 4096u);
}

/// A white sheet in glass: its edge is where the bent rays meet it.
TEST_F(GlassTest, BodyInsideGlassIsDisplaced) {
    Stage stage;
    stage.add(plate(1, -1), clear_glass());
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
