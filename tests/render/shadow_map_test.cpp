// The shadows of --tracer cubemap: maps have texels, so that outlines may be a few of them off, but nothing else.
#include "pictures.h"

namespace peelray {
namespace {

class ShadowMapTest : public PictureTest {
  protected:
    RenderResult lit(const Stage& stage, RenderSettings settings) {
        settings.tracer = Tracer::cubemap;
        return render(stage, black, settings);
    }
    /// Floor y = 0: every pixel whose neighbourhood of `margin` is of one kind must be of that kind.
    Tally outline(const RenderResult& picture, const Camera& camera, double margin,
                  const std::function<bool(glm::dvec3)>& covered, const std::function<bool(glm::dvec3)>& hidden,
                  const std::function<double(glm::dvec3)>& light) {
        return tally(picture, camera, 2e-3, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
            const glm::dvec3 p = ray.at_plane(1, 0);
            if (hidden(p)) return {};
            for (int i = 0; i < 8; i++)
                if (covered(p + margin * glm::dvec3(std::cos(i * kPi / 4), 0, std::sin(i * kPi / 4))) != covered(p))
                    return {};
            return glm::dvec3(covered(p) ? 0 : light(p));
        });
    }
};

TEST_F(ShadowMapTest, DiscUnderTheSun) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(1, -1.2, 0.5)), centre(-0.6, 1, -0.3),
                     shift = travel / -travel.y;
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    stage.add(disc(glm::vec3(centre), 0.5f), unlit({0, 5, 0}));
    stage.sun(glm::vec3(travel), {2, 2, 2});
    const Camera camera = from_above(4);
    const RenderResult picture = lit(stage, settings_for(camera, 256));
    EXPECT_EQ(picture.stats.maps.shadows.maps, 1u);
    // The map is at most 12 metres wide; three texels: the kernel's two and a bias's.
    const double texel = 12.0 / picture.stats.maps.shadows.size;
    outline(
        picture, camera, 3 * texel, [&](glm::dvec3 p) { return in_disc(p, centre + shift, 0.5); },
        [&](glm::dvec3 p) { return in_disc(p, centre, 0.53); }, [&](glm::dvec3) { return 2 * -travel.y / kPi; })
        .expect(0, 58000);
}

TEST_F(ShadowMapTest, DiscUnderLampAndSpot) {
    const glm::dvec3 lamp(-0.8, 2.5, -0.2), centre(-0.3, 1, 0.1), shadow = lamp + (centre - lamp) * (2.5 / 1.5);
    for (bool spot : {false, true}) {
        SCOPED_TRACE(spot);
        Stage stage;
        stage.add(ground(4), lambert({1, 1, 1}));
        stage.add(disc(glm::vec3(centre), 0.3f), unlit({0, 5, 0}));
        Light& light = stage.lamp(glm::vec3(lamp), {10, 10, 10});
        if (spot) {
            light.kind = Light::Kind::spot;
            light.direction = {0, -1, 0};
            light.inner_cone = glm::radians(44.f);
            light.outer_cone = glm::radians(45.f);
        }
        const Camera camera = from_above(4);
        const RenderResult picture = lit(stage, settings_for(camera, 256));
        EXPECT_EQ(picture.stats.maps.shadows.maps, spot ? 1u : 6u);
        const double texel = 2 * 2.5 / (spot ? picture.stats.maps.shadows.size : picture.stats.maps.shadows.face_size);
        outline(
            picture, camera, 4 * texel, [&](glm::dvec3 p) { return in_disc(p, shadow, 0.3 * 2.5 / 1.5); },
            [&](glm::dvec3 p) {
                const double angle = std::acos(2.5 / glm::length(p - lamp)) * 180 / kPi;
                return in_disc(p, centre, 0.33) || (spot && angle > 43.9);
            },
            [&](glm::dvec3 p) { return 10 * 2.5 / std::pow(glm::length(lamp - p), 3) / kPi; })
            .expect(0, spot ? 40000 : 55000);
    }
}

TEST_F(ShadowMapTest, ALampFarAwayHasOneMap) {
    Stage stage;
    stage.add(ground(2), lambert({1, 1, 1}));
    stage.add(disc({0, 0.5f, 0}, 0.4f), unlit({0, 5, 0}));
    stage.lamp({0, 40, 0}, {16000, 16000, 16000});
    const Camera camera = orthographic({3, 3, 0}, {0, 0, 0}, 3);
    const RenderResult picture = lit(stage, settings_for(camera, 128));
    EXPECT_EQ(picture.stats.maps.shadows.maps, 1u);
    outline(
        picture, camera, 0.015,
        [&](glm::dvec3 p) {
            return in_disc(p, {0, 0, 0}, 0.4 * 40 / 39.5);
        },
        [&](glm::dvec3 p) {
            // The disc, half a metre up, hides what lies half a metre behind it; beyond the ground there is nothing.
            return in_disc(p, {-0.5, 0, 0}, 0.45) || std::abs(p.x) > 1.95 || std::abs(p.z) > 1.95;
        },
        [&](glm::dvec3 p) { return 16000 * 40 / std::pow(glm::length(glm::dvec3(0, 40, 0) - p), 3) / kPi; })
        .expect(0, 4000);
}

TEST_F(ShadowMapTest, NoAcneOnAPlaneInGrazingLight) {
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 0.4f, 0.2f));
    const glm::quat turn = glm::angleAxis(glm::radians(23.f), axis);
    for (double degrees : {1.5, 10.0, 45.0, 90.0}) {
        SCOPED_TRACE(degrees);
        const double elevation = degrees * kPi / 180;
        Stage stage;
        stage.add(turned(ground(3), 23, axis), lambert({1, 1, 1}));
        stage.sun(turn * glm::vec3(std::cos(elevation), -std::sin(elevation), 0), {100, 100, 100});
        const Camera camera = orthographic(turn * glm::vec3(0, 4, 0), {0, 0, 0}, 5.5f, turn * glm::vec3(0, 0, -1));
        const double want = 100 * std::sin(elevation) / kPi;
        tally(lit(stage, settings_for(camera, 96)), camera, 0.01 * want, [&](const ViewRay&) {
            return glm::dvec3(want);
        }).expect(0, 96 * 96);
    }
}

TEST_F(ShadowMapTest, NoAcneOnASphere) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(-1, -0.2, -0.15));
    for (const auto& [squares, band] : {std::pair{32u, 0.06}, {6u, 0.2}}) {
        SCOPED_TRACE(squares);
        for (bool lamp : {false, true}) {
            Stage stage;
            stage.add(sphere({0.1f, -0.2f, 0.05f}, 1, squares), lambert({1, 1, 1}));
            if (lamp)
                stage.lamp(glm::vec3(travel) * -50.f, glm::vec3(3 * 2500));
            else
                stage.sun(glm::vec3(travel), {3, 3, 3});
            RenderSettings settings = settings_for(perspective({1, 1.5f, 3}, {0, 0, 0}, 45), 128);
            settings.aovs = true;
            const RenderResult picture = lit(stage, settings);
            Tally bright, dark;
            for (size_t i = 0; i < picture.radiance.size(); i++) {
                if (picture.aovs.triangle[i] < 0) continue;
                const double cosine = -glm::dot(glm::dvec3(picture.aovs.normal[i]), travel),
                             got = picture.radiance[i].x;
                const auto example = [&, i] {
                    return fmt::format("pixel {},{}: {:.4f}, cosine {:.4f}", i % 128, i / 128, got, cosine);
                };
                if (cosine > band) bright.add(std::abs(got - 3 * cosine / kPi) < 0.06 * 3 / kPi, example);
                if (cosine < -band) dark.add(got == 0, example);
            }
            bright.expect(0, 2500);
            dark.expect(0, 300);
        }
    }
}

TEST_F(ShadowMapTest, NoLightLeaksIntoOrOutOfABox) {
    // Below a box that stands on the floor it is dark, up to its walls; a lamp in a box lights nothing outside.
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    stage.add(turned(box({-1, 0, -1}, {1, 0.8f, 1}), 31, {0, 1, 0}), lambert({1, 0, 0}));
    stage.sun({1, -0.8f, 0.35f}, {2, 2, 2});
    const Camera inside = orthographic({0, 0.5f, 0}, {0, 0, 0}, 1.2f, {0, 0, -1});
    tally(lit(stage, settings_for(inside)), inside, 1e-6, [](const ViewRay&) { return glm::dvec3(0); }).expect(0, 4096);

    Stage boxed;
    boxed.add(ground(4), lambert({1, 1, 1}));
    boxed.add(box({-0.5f, 0.5f, -0.5f}, {0.5f, 1.5f, 0.5f}), lambert({1, 0, 0}));
    boxed.lamp({0, 1, 0}, {10, 10, 10});
    const Camera camera = perspective({3, 4, 6}, {0, 0.5f, 0}, 50);
    tally(lit(boxed, settings_for(camera)), camera, 1e-6, [](const ViewRay&) { return glm::dvec3(0); }).expect(0, 4096);
}

TEST_F(ShadowMapTest, ContactShadowsTouchTheirBox) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(1, -0.8, 0));
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    stage.add(box({-0.5f, 0, -0.5f}, {0.5f, 0.7f, 0.5f}), lambert({1, 0, 0}));
    stage.sun(glm::vec3(travel), {2, 2, 2});
    const Camera camera = from_above(3);
    const RenderResult picture = lit(stage, settings_for(camera, 192));
    const double length = 0.7 / 0.8;  // the shadow reaches this far behind the box
    outline(
        picture, camera, 3 * 12.0 / picture.stats.maps.shadows.size,
        [&](glm::dvec3 p) { return p.x > -0.5 && p.x < 0.5 + length && std::abs(p.z) < 0.5; },
        [&](glm::dvec3 p) { return std::abs(p.x) < 0.501 && std::abs(p.z) < 0.501; },
        [&](glm::dvec3) { return 2 * -travel.y / kPi; })
        .expect(0, 30000);
}

TEST_F(ShadowMapTest, LightFallsThroughHoles) {
    for (const bool lamp : {false, true}) {
        SCOPED_TRACE(lamp);
        Stage stage;
        stage.add(ground(3), lambert({1, 1, 1}));
        stage.add(parallelogram({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), masked(stage, lambert({1, 0, 0})));
        if (lamp)
            stage.lamp({0, 3, 0}, {10, 10, 10});
        else
            stage.sun({0, -1, 0}, glm::vec3(kPi));
        const double grow = lamp ? 1.5 : 1;  // of the shadow beside the pane
        const Camera camera = orthographic({0, 0.9f, 0}, {0, 0, 0}, 2.2f, {0, 0, -1});
        const RenderResult picture = lit(stage, settings_for(camera, 192));
        const auto covered = [&](glm::dvec3 p) { return *whole_at({(p.x / grow + 1) / 2, (1 - p.z / grow) / 2}, 0); };
        outline(
            picture, camera, 0.02, covered,
            [&](glm::dvec3 p) { return std::max(std::abs(p.x), std::abs(p.z)) > 0.97 * grow; },
            [&](glm::dvec3 p) { return lamp ? 30 / std::pow(glm::length(glm::dvec3(0, 3, 0) - p), 3) / kPi : 1; })
            .expect(0, 10000);
    }
}

TEST_F(ShadowMapTest, OnlyFrontsOfSingleSidedMaterialsCastOne) {
    for (const bool lamp : {false, true})
        for (const bool faces_light : {false, true}) {
            SCOPED_TRACE(fmt::format("{} {}", lamp, faces_light));
            Stage stage;
            stage.add(ground(3), lambert({1, 1, 1}));
            const Primitive pane = disc({0, 1, 0}, 0.8f);
            stage.add(faces_light ? pane : inside_out(pane), lambert({1, 0, 0}));
            stage.scene.materials.back().double_sided = false;
            if (lamp)
                stage.lamp({0, 3, 0}, {10, 10, 10});
            else
                stage.sun({0, -1, 0}, glm::vec3(kPi));
            const double radius = 0.8 * (lamp ? 1.5 : 1);
            const Camera camera = orthographic({0, 0.9f, 0}, {0, 0, 0}, 4, {0, 0, -1});
            outline(
                lit(stage, settings_for(camera, 128)), camera, 0.03,
                [&](glm::dvec3 p) { return faces_light && in_disc(p, glm::dvec3(0), radius); },
                [](glm::dvec3) { return false; },
                [&](glm::dvec3 p) { return lamp ? 30 / std::pow(glm::length(glm::dvec3(0, 3, 0) - p), 3) / kPi : 1; })
                .expect(0, 12000);
        }
}

TEST_F(ShadowMapTest, GlassCastsNone) {
    Stage stage;
    stage.add(ground(2), lambert({1, 1, 1}));
    stage.add(parallelogram({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), thin_glass());
    stage.sun({0, -1, 0}, glm::vec3(kPi));
    const Camera camera = orthographic({0, 0.9f, 0}, {0, 0, 0}, 3, {0, 0, -1});
    tally(lit(stage, settings_for(camera)), camera, 1e-3, [](const ViewRay&) { return glm::dvec3(1); }).expect(0, 4096);
}

TEST_F(ShadowMapTest, ManyLampsShareTheRoom) {
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    for (int i = 0; i < 40; i++) stage.lamp({float(i % 8) - 3.5f, 1, float(i / 8) - 2}, {0.2f, 0.2f, 0.2f});
    const Camera camera = from_above(6);
    const RenderResult picture = lit(stage, settings_for(camera, 48));
    EXPECT_EQ(picture.stats.maps.shadows.maps, 240u);
    EXPECT_LE(picture.stats.maps.shadows.bytes, device().limits().maxStorageBufferRange);
    tally(picture, camera, 2e-3, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
        double sum = 0;
        for (const Light& light : stage.scene.lights)
            sum += 0.2 / std::pow(glm::length(glm::dvec3(light.position) - ray.at_plane(1, 0)), 3) / kPi;
        return glm::dvec3(sum);
    }).expect(0, 48 * 48);
}

}  // namespace
}  // namespace peelray
