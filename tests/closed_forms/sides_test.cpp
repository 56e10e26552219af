// Single-sided materials (glTF 2.0, section 3.9.5): rays from behind pass, whoever sends them.
#include <pictures.h>

namespace peelray {
namespace {

using SidesTest = PictureTest;

const glm::dvec3 kSide(0.7, 0.2, 0.1), kFar(0.1, 0.3, 0.8), kNear(0.2, 0.6, 0.3);

Material single_sided(Material material) {
    material.double_sided = false;
    return material;
}

/// A pane in z = 0, 2 by 2 around the origin, that faces +z, between walls at z = -1 and z = 10.
Stage pane_between_walls() {
    Stage stage;
    stage.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), single_sided(unlit(glm::vec3(kSide))));
    stage.add(parallelogram({-90, -90, -1}, {180, 0, 0}, {0, 180, 0}), unlit(glm::vec3(kFar)));
    stage.add(parallelogram({-90, -90, 10}, {180, 0, 0}, {0, 180, 0}), unlit(glm::vec3(kNear)));
    return stage;
}
/// What a ray sees there; `front`: the sign of z from where the pane is seen.
std::optional<glm::dvec3> seen_between_walls(const ViewRay& ray, double front = 1) {
    const glm::dvec3 wall = ray.direction.z < 0 ? kFar : kNear, at = ray.at_plane(2, ray.direction.z < 0 ? -1 : 10);
    if (ray.origin.z < -0.99 || !(std::max(std::abs(at.x), std::abs(at.y)) < 89)) return {};
    if (ray.origin.z * ray.direction.z >= 0 || ray.origin.z * front < 0) return wall;
    const glm::dvec3 p = ray.at_plane(2, 0);
    const double reach = std::max(std::abs(p.x), std::abs(p.y));
    if (std::abs(reach - 1) < 1e-3) return {};
    return reach < 1 ? kSide : wall;
}

const std::vector<Camera> kCameras = {
    perspective({0.3f, 0.2f, 2.4f}, {0, 0, 0}, 45),  perspective({2, 0.4f, 0.7f}, {0, 0, 0}, 60),
    perspective({0.3f, 0.2f, -0.9f}, {0, 0, 0}, 60), perspective({0.1f, 0.9f, -0.2f}, {0, 0, 0}, 90),
    orthographic({1, -0.7f, 2}, {0, 0, 0}, 3),       orthographic({0.1f, -0.2f, -0.8f}, {0, 0, 0}, 3)};

TEST_F(SidesTest, TheCameraSeesFronts) {
    const Stage stage = pane_between_walls();
    for (const Camera& camera : kCameras)
        tally(render(stage, black, settings_for(camera, 96)), camera, 1e-5, [](const ViewRay& ray) {
            return seen_between_walls(ray);
        }).expect(0, 5000);
}

TEST_F(SidesTest, AReflectionTakesTheFrontAlong) {
    // A negative determinant turns the winding over and with it the front: across x the pane still faces +z, across z
    // it faces -z.
    for (const bool across_z : {false, true}) {
        SCOPED_TRACE(across_z);
        Stage stage = pane_between_walls();
        stage.scene.nodes[0].local = glm::scale(glm::mat4(1), across_z ? glm::vec3(1, 1, -1) : glm::vec3(-1, 1, 1));
        for (const Camera& camera : kCameras)
            tally(render(stage, black, settings_for(camera, 96)), camera, 1e-5, [&](const ViewRay& ray) {
                return seen_between_walls(ray, across_z ? -1 : 1);
            }).expect(0, 5000);
    }
}

TEST_F(SidesTest, InstancesAndTheirReflectionsFaceOutwards) {
    // One ball that several nodes show, of which one reflects it and one turns and squeezes it: a body with instances.
    Stage stage;
    stage.add(sphere({0, 0, 0}, 1, 24), single_sided(unlit(glm::vec3(kSide))));
    const auto show = [&](const glm::mat4& local) {
        Node node;
        node.mesh = 0;
        node.local = local;
        stage.scene.nodes.push_back(node);
    };
    const auto at = [](float x) { return glm::translate(glm::mat4(1), {x, 0, 0}); };
    show(glm::scale(at(3), {-1, 1, 1}));
    show(glm::scale(glm::rotate(at(-3), 1.f, {0, 0, 1}), {1, -0.5f, 1}));
    const Camera camera = perspective({0, 1, 9}, {0, 0, 0}, 50);
    Stage both = stage;
    both.scene.materials[0].double_sided = true;
    // From outside a closed body is the same with and without its backs; inside out it shows its far half only.
    tally(render(stage, white, settings_for(camera, 96)), render(both, white, settings_for(camera, 96)), 0)
        .expect(0, 9000);
    Primitive& ball = stage.scene.meshes[0].primitives[0];
    ball = inside_out(ball);
    stage.add(sphere({0, 0, 0}, 0.5f, 24), unlit(glm::vec3(kNear)));
    const Camera close = perspective({0, 0, 3}, {0, 0, 0}, 60);
    tally(render(stage, black, settings_for(close, 96)), close, 1e-5,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const double miss = glm::length(glm::cross(ray.origin, ray.direction));
              if (miss < 0.45) return kNear;
              if (miss > 0.55 && miss < 0.95) return kSide;
              return {};
          })
        .expect(0, 1200);
}

TEST_F(SidesTest, AnInvertedHullIsAnOutline) {
    Stage stage;
    stage.add(sphere({0, 0, 0}, 1, 96), unlit(glm::vec3(kSide)));
    stage.add(inside_out(sphere({0, 0, 0}, 1.2f, 96)), single_sided(unlit({0, 0, 0})));
    const Camera camera = orthographic({0.4f, 0.3f, 4}, {0, 0, 0}, 3);
    tally(render(stage, white, settings_for(camera, 128)), camera, 1e-5,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const double miss = glm::length(glm::cross(ray.origin, ray.direction));
              for (const double edge : {1.0, 1.2})
                  if (std::abs(miss - edge) < 0.01) return {};
              return miss < 1 ? kSide : glm::dvec3(miss < 1.2 ? 0 : 1);
          })
        .expect(0, 14000);
}

TEST_F(SidesTest, MirrorsShowNoBacks) {
    for (const float towards : {1.f, -1.f}) {
        SCOPED_TRACE(towards);
        Stage stage;
        stage.add(parallelogram({-towards, -1, 0}, {2 * towards, 0, 0}, {0, 2, 0}),
                  single_sided(unlit(glm::vec3(kSide))));  // faces +z or -z
        stage.add(parallelogram({-90, -90, -1}, {180, 0, 0}, {0, 180, 0}), unlit(glm::vec3(kFar)));
        stage.add(parallelogram({-4, -4, 3}, {0, 8, 0}, {8, 0, 0}), plane_mirror());
        const Camera camera = perspective({0.2f, 0.3f, 1.5f}, {0, 0, 3}, 50);
        tally(render(stage, black, settings_for(camera, 128)), camera, 1e-5,
              [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
                  const ViewRay mirrored{ray.at_plane(2, 3), ray.direction * glm::dvec3(1, 1, -1)};
                  const glm::dvec3 p = mirrored.at_plane(2, 0);
                  const double reach = std::max(std::abs(p.x), std::abs(p.y));
                  if (std::abs(reach - 1) < 1e-3) return {};
                  return reach < 1 && towards > 0 ? kSide : kFar;
              })
            .expect(0, 10000);
    }
}

TEST_F(SidesTest, AMirrorThatIsSingleSidedIsNotThereFromBehind) {
    Stage stage;
    stage.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), single_sided(plane_mirror()));
    stage.add(parallelogram({-90, -90, 5}, {180, 0, 0}, {0, 180, 0}), unlit(glm::vec3(kNear)));
    const Camera behind = perspective({0.1f, 0.2f, -2}, {0, 0, 0}, 30);
    tally(render(stage, white, settings_for(behind)), behind, 1e-5, [](const ViewRay&) {
        return std::optional(kNear);
    }).expect(0, 4000);
}

TEST_F(SidesTest, LightPassesBacks) {
    // A pane over a floor under a sun from straight above: it casts a shadow where the sun meets its front. With glass
    // somewhere, rays to lights are traced in another way.
    for (const bool glass : {false, true})
        for (const bool faces_down : {false, true}) {
            SCOPED_TRACE(fmt::format("{} {}", glass, faces_down));
            Stage stage;
            stage.add(ground(3), lambert({1, 1, 1}));
            const float side = faces_down ? 1.f : -1.f;
            stage.add(parallelogram({-1, 1, -side}, {2, 0, 0}, {0, 0, 2 * side}), single_sided(lambert({1, 0, 0})));
            if (glass) stage.add(sphere({8, 1, 8}, 0.5f, 6), clear_glass());
            stage.sun({0, -1, 0}, glm::vec3(kPi));
            const Camera camera = orthographic({0, 0.9f, 0}, {0, 0, 0}, 4, {0, 0, -1});
            tally(render(stage, black, settings_for(camera, 128)), camera, 1e-3,
                  [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
                      const glm::dvec3 p = ray.at_plane(1, 0);
                      const double reach = std::max(std::abs(p.x), std::abs(p.z));
                      if (std::abs(reach - 1) < 1e-3) return {};
                      return glm::dvec3(!faces_down && reach < 1 ? 0 : 1);
                  })
                .expect(0, 9000);
        }
}

TEST_F(SidesTest, AnInvertedHullDoesNotDarkenWhatItSurrounds) {
    // Nor do the far faces of a lit body, which light meets from inside; what is behind both is in their shadow.
    Stage stage;
    stage.add(sphere({0, 1.5f, 0}, 1, 32), lambert(glm::vec3(kSide)));
    stage.add(ground(9), lambert({1, 1, 1}));
    stage.sun({0.2f, -1, -0.3f}, glm::vec3(kPi));
    const Camera camera = perspective({1, 3, 6}, {0, 1, 0}, 50);
    const RenderResult bare = render(stage, black, settings_for(camera, 96));
    stage.add(inside_out(sphere({0, 1.5f, 0}, 1.05f, 32)), single_sided(unlit({0, 0, 1})));
    const RenderResult outlined = render(stage, black, settings_for(camera, 96));
    Tally ball;
    size_t lit = 0;
    for (uint32_t y = 0; y < 96; y++)
        for (uint32_t x = 0; x < 96; x++) {
            const ViewRay ray = view_ray(camera, 96, 96, x + 0.5, y + 0.5);
            const glm::dvec3 from = ray.origin - glm::dvec3(0, 1.5, 0);
            if (glm::length(glm::cross(from, ray.direction)) > 0.97) continue;
            const glm::dvec3 a = radiance_at(bare, x, y), b = radiance_at(outlined, x, y);
            lit += a.x > 0.1;
            ball.add(near(a, b, 1e-5), [&] { return fmt::format("pixel {},{}: {} and {}", x, y, text(a), text(b)); });
        }
    ball.expect(0, 600);
    EXPECT_GT(lit, 300u);
}

TEST_F(SidesTest, VolumesThatTransmitHaveBothSides) {
    // Else rays would never leave the glass.
    for (const bool absorbs : {false, true}) {
        SCOPED_TRACE(absorbs);
        Stage stage;
        Material glass = clear_glass();
        if (absorbs) {
            glass.attenuation_color = {0.3f, 0.9f, 0.5f};
            glass.attenuation_distance = 0.7f;
        }
        stage.add(sphere({0, 0, 0}, 1, 24), glass);
        stage.add(ground(6, -1.2f), lambert({0.7f, 0.5f, 0.2f}));
        stage.sun({0.3f, -1, -0.2f}, glm::vec3(kPi));
        const Camera camera = perspective({1, 1.4f, 3}, {0, 0, 0}, 50);
        const RenderResult as_given = render(stage, white, settings_for(camera));
        stage.scene.materials[0].double_sided = false;
        tally(as_given, render(stage, white, settings_for(camera)), 0).expect(0, 4096);
        // A wall without a volume has a back like anything else.
        stage.scene.materials[0].thickness = 0;
        const RenderResult wall = render(stage, white, settings_for(camera));
        stage.scene.materials[0].double_sided = true;
        EXPECT_GT(tally(wall, render(stage, white, settings_for(camera)), 1e-3).wrong, 100u);
    }
}

TEST_F(SidesTest, HolesAndSidesAtOnce) {
    for (const float towards : {1.f, -1.f}) {
        SCOPED_TRACE(towards);
        Stage stage;
        stage.add(parallelogram({-towards, -1, 0}, {2 * towards, 0, 0}, {0, 2, 0}),
                  single_sided(masked(stage, unlit(glm::vec3(kSide)))));
        stage.add(parallelogram({-90, -90, -1}, {180, 0, 0}, {0, 180, 0}), unlit(glm::vec3(kFar)));
        const Camera camera = perspective({0.3f, 0.2f, 2.4f}, {0, 0, 0}, 45);
        tally(render(stage, black, settings_for(camera, 96)), camera, 1e-5,
              [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
                  const glm::dvec3 p = ray.at_plane(2, 0);
                  if (std::max(std::abs(p.x), std::abs(p.y)) > 0.999) return {};
                  const auto whole = whole_at({(towards * p.x + 1) / 2, (p.y + 1) / 2});
                  if (!whole) return {};
                  return *whole && towards > 0 ? kSide : kFar;
              })
            .expect(0, 2000);
    }
}

TEST_F(SidesTest, WhatIsMorphedInsideOutIsSeenFromTheOtherSide) {
    // The pane's corners move to their mirror images across x: the same square, wound the other way.
    Stage stage = pane_between_walls();
    Primitive& pane = stage.scene.meshes[0].primitives[0];
    pane.targets.push_back({{}, {}});
    for (const glm::vec3& p : pane.positions) pane.targets[0].positions.push_back({-2 * p.x, 0, 0});
    stage.scene.nodes[0].weights = {1};
    for (const Camera& camera : kCameras)
        tally(render(stage, black, settings_for(camera, 96)), camera, 1e-5, [](const ViewRay& ray) {
            return seen_between_walls(ray, -1);
        }).expect(0, 5000);
}

}  // namespace
}  // namespace peelray
