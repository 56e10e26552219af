// Hard shadows: outlines, contact, acne; lamps.
#include <pictures.h>

namespace peelray {
namespace {

using ShadowTest = PictureTest;

struct Shadowed {
    std::function<bool(glm::dvec3)> covered;  ///< the floor's point is in shadow or hidden from the camera below a body
    std::function<bool(glm::dvec3)> hidden;   ///< the camera does not see the floor's point
    std::function<double(glm::dvec3)> lit;    ///< radiance where no shadow is
};

/// Floor y = 0 from above: every pixel whose neighbourhood of ± 1 pixel is of one kind must be exactly of that kind.
Tally tally_outline(const RenderResult& picture, const Camera& camera, const Shadowed& scene, double tolerance) {
    const double pixel = camera.orthographic_height / picture.height;
    return tally(picture, camera, tolerance, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
        const glm::dvec3 p = ray.at_plane(1, 0);
        if (scene.hidden(p)) return {};
        const bool covered = scene.covered(p);
        for (int i = 0; i < 8; i++)
            if (scene.covered(p + pixel * glm::dvec3(std::cos(i * kPi / 4), 0, std::sin(i * kPi / 4))) != covered)
                return {};
        return glm::dvec3(covered ? 0 : scene.lit(p));
    });
}

TEST_F(ShadowTest, DiscUnderTheSun) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(1, -1.2, 0.5)), centre(-0.6, 1, -0.3);
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    stage.add(disc(glm::vec3(centre), 0.5f), unlit({0, 5, 0}));
    stage.sun(glm::vec3(travel), {2, 2, 2});
    const Camera camera = from_above(4);
    const RenderResult picture = render(stage, black, settings_for(camera, 128));
    const glm::dvec3 shift = travel / -travel.y;
    tally_outline(
        picture, camera,
        {[&](glm::dvec3 p) { return in_disc(p, centre + shift, 0.5); },
         [&](glm::dvec3 p) { return in_disc(p, centre, 0.53); }, [&](glm::dvec3) { return 2 * -travel.y / kPi; }},
        1e-3)
        .expect(0, 12000);
}

TEST_F(ShadowTest, DiscUnderALamp) {
    const glm::dvec3 lamp(-0.8, 2.5, -0.2), centre(-0.3, 1, 0.1);
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    stage.add(disc(glm::vec3(centre), 0.3f), unlit({0, 5, 0}));
    stage.lamp(glm::vec3(lamp), {10, 10, 10});
    const Camera camera = from_above(4);
    const RenderResult picture = render(stage, black, settings_for(camera, 128));
    const glm::dvec3 shadow = lamp + (centre - lamp) * (2.5 / 1.5);
    tally_outline(picture, camera,
                  {[&](glm::dvec3 p) { return in_disc(p, shadow, 0.3 * 2.5 / 1.5); },
                   [&](glm::dvec3 p) { return in_disc(p, centre, 0.33); },
                   [&](glm::dvec3 p) {
                       return 10 * 2.5 / std::pow(glm::length(lamp - p), 3) / kPi;
                   }},  // inverse square times cosine
                  1e-3)
        .expect(0, 12000);
}

TEST_F(ShadowTest, BodyBehindALampCastsNone) {
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    stage.add(ground(4, 2), lambert({1, 1, 1}));
    stage.lamp({0, 1, 0}, {10, 10, 10});
    const Camera camera = orthographic({0, 1.9f, 0}, {0, 0, 0}, 2, {0, 0, -1});
    tally(render(stage, black, settings_for(camera)), camera, 1e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              return glm::dvec3(10 / std::pow(glm::length(glm::dvec3(0, 1, 0) - ray.at_plane(1, 0)), 3) / kPi);
          })
        .expect(0, 4096);
}

TEST_F(ShadowTest, TouchesTheBoxThatCastsIt) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(1, -0.8, 0.35));
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    stage.add(turned(box({-0.5f, 0, -0.4f}, {0.5f, 0.7f, 0.4f}), 31, {0, 1, 0}), lambert({1, 0, 0}));
    stage.sun(glm::vec3(travel), {2, 2, 2});
    const Camera camera = from_above(3.4f);
    const auto local = [](const glm::dvec3& v) {
        const double a = 31 * kPi / 180;
        return glm::dvec3(v.x * std::cos(a) - v.z * std::sin(a), v.y, v.x * std::sin(a) + v.z * std::cos(a));
    };
    const auto under = [&](glm::dvec3 p, double margin) {
        const glm::dvec3 q = local(p);
        return std::abs(q.x) < 0.5 + margin && std::abs(q.z) < 0.4 + margin;
    };
    const auto covered = [&](glm::dvec3 p) {
        // Slabs: does the ray to the sun pass the box?
        const glm::dvec3 o = local(p), d = local(-travel), lower(-0.5, 0, -0.4), upper(0.5, 0.7, 0.4);
        double enter = 0, leave = 1e9;
        for (int k = 0; k < 3; k++) {
            const double a = (lower[k] - o[k]) / d[k], b = (upper[k] - o[k]) / d[k];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave || under(p, 0);
    };
    for (uint32_t ldc : {32u, 200u}) {
        RenderSettings settings = settings_for(camera, 160);
        settings.cubes.ldc = ldc;
        const RenderResult picture = render(stage, black, settings);
        tally_outline(
            picture, camera,
            {covered, [&](glm::dvec3 p) { return under(p, 1e-4); }, [&](glm::dvec3) { return 2 * -travel.y / kPi; }},
            1e-3)
            .expect(0, 18000);
    }
}

TEST_F(ShadowTest, NoAcneOnAFinePlaneInGrazingLight) {
    // 60×60 squares, tilted against all axes.
    Primitive grid;
    for (int j = 0; j <= 60; j++)
        for (int i = 0; i <= 60; i++) grid.positions.push_back({(i - 30) / 10.f, 0, (30 - j) / 10.f});
    grid.normals.assign(grid.positions.size(), {0, 1, 0});
    for (uint32_t j = 0; j < 60; j++)
        for (uint32_t i = 0; i < 60; i++) {
            const uint32_t a = j * 61 + i;
            grid.triangles.push_back({a, a + 1, a + 62});
            grid.triangles.push_back({a, a + 62, a + 61});
        }
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 0.4f, 0.2f));
    const glm::quat turn = glm::angleAxis(glm::radians(23.f), axis);
    const float elevation = glm::radians(1.5f);
    Stage stage;
    stage.add(turned(grid, 23, axis), lambert({1, 1, 1}));
    stage.sun(turn * glm::vec3(std::cos(elevation), -std::sin(elevation), 0), {100, 100, 100});
    for (uint32_t ldc : {48u, 256u}) {
        RenderSettings settings =
            settings_for(orthographic(turn * glm::vec3(0, 4, 0), {0, 0, 0}, 5.5f, turn * glm::vec3(0, 0, -1)), 96);
        settings.cubes.ldc = ldc;
        const double want = 100 * std::sin(1.5 * kPi / 180) / kPi;
        tally(render(stage, black, settings), settings.camera, 0.01 * want, [&](const ViewRay&) {
            return glm::dvec3(want);
        }).expect(0, 96 * 96);
    }
}

TEST_F(ShadowTest, NoAcneOnASphere) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(-1, -0.2, -0.15));
    // Fine: all but a narrow band. Coarse: its facets must not shadow each other either.
    for (const auto& [squares, band] : {std::pair{32u, 0.06}, {6u, 0.15}}) {
        SCOPED_TRACE(squares);
        Stage stage;
        stage.add(sphere({0.1f, -0.2f, 0.05f}, 1, squares), lambert({1, 1, 1}));
        stage.sun(glm::vec3(travel), {3, 3, 3});
        RenderSettings settings = settings_for(perspective({1, 1.5f, 3}, {0, 0, 0}, 45), 128);
        settings.aovs = true;
        settings.cubes.ldc = 128;
        const RenderResult picture = render(stage, black, settings);
        Tally bright, dark;
        for (size_t i = 0; i < picture.radiance.size(); i++) {
            if (picture.aovs.triangle[i] < 0) continue;
            const double cosine = -glm::dot(glm::dvec3(picture.aovs.normal[i]), travel), got = picture.radiance[i].x;
            const auto example = [&, i] {
                return fmt::format("pixel {},{}: {:.4f}, cosine {:.4f}", i % 128, i / 128, got, cosine);
            };
            if (cosine > band) bright.add(std::abs(got - 3 * cosine / kPi) < 0.02 * 3 / kPi, example);
            if (cosine < -band) dark.add(got == 0, example);
        }
        bright.expect(0, 2500);
        dark.expect(0, 300);
    }
}

TEST_F(ShadowTest, TessellatedSphereIsLitAsTheSmoothOneIs) {
    // Nothing in the way: cosine of the shading normal, up to the line where it turns away. With shadows the same, but
    // for what the facets cannot tell near that line.
    const glm::dvec3 travel = glm::normalize(glm::dvec3(-1, -0.4, -0.15));
    for (uint32_t squares : {3u, 6u, 12u})
        for (bool shadow : {false, true}) {
            SCOPED_TRACE(fmt::format("{} squares, {}", squares, shadow ? "shadows" : "no shadows"));
            Stage stage;
            stage.add(sphere({0.1f, -0.2f, 0.05f}, 1, squares), lambert({1, 1, 1}));
            stage.sun(glm::vec3(travel), {3, 3, 3});
            RenderSettings settings = settings_for(orthographic({-1, 1.5f, 3}, {0, 0, 0}, 2.6f), 128);
            settings.aovs = true;
            settings.shadow = shadow;
            settings.cubes.ldc = 128;
            const RenderResult picture = render(stage, black, settings);
            Tally all, bright;
            for (size_t i = 0; i < picture.radiance.size(); i++) {
                if (picture.aovs.triangle[i] < 0) continue;
                const double cosine = -glm::dot(glm::dvec3(picture.aovs.normal[i]), travel),
                             got = picture.radiance[i].x;
                const bool right = std::abs(got - std::max(0.0, cosine) * 3 / kPi) < 1e-3;
                const auto example = [&, i] {
                    return fmt::format("pixel {},{}: {:.4f}, cosine {:.4f}", i % 128, i / 128, got, cosine);
                };
                all.add(right, example);
                if (cosine > 0.02) bright.add(right, example);
            }
            all.expect(shadow ? 0.01 : 0, 5000);
            bright.expect(shadow ? 1e-3 : 0, 2500);
        }
}

TEST_F(ShadowTest, BentNormalsLetNoLightThrough) {
    // Light from below a sheet, which the normals of a dent would see: the triangles themselves are in the way,
    // whichever of their sides are shown. Two large ones, then 32, whose neighbours are in the way too.
    const glm::dvec3 travel = glm::normalize(glm::dvec3(1, 0.1, 0.2));
    const auto bent = [](float amount, uint32_t n) {
        Primitive sheet;
        for (uint32_t j = 0; j <= n; j++)
            for (uint32_t i = 0; i <= n; i++) {
                const glm::vec2 p(2.f * float(i) / float(n) - 1, 1 - 2.f * float(j) / float(n));
                sheet.positions.push_back({2 * p.x, 0, 2 * p.y});
                sheet.normals.push_back(glm::normalize(glm::vec3(amount * p.x, 1, amount * p.y)));
            }
        for (uint32_t j = 0; j < n; j++)
            for (uint32_t i = 0; i < n; i++) {
                const uint32_t a = j * (n + 1) + i;
                sheet.triangles.push_back({a, a + 1, a + n + 2});
                sheet.triangles.push_back({a, a + n + 2, a + n + 1});
            }
        return sheet;
    };
    const auto picture_of = [&](uint32_t squares, bool double_sided) {
        Material white_paint = lambert({1, 1, 1});
        white_paint.double_sided = double_sided;
        Stage stage;
        stage.add(bent(-0.5f, squares), white_paint);
        stage.sun(glm::vec3(travel), {3, 3, 3});
        RenderSettings settings = settings_for(from_above(3.6f));
        settings.aovs = true;
        return render(stage, black, settings);
    };
    for (const auto& [squares, double_sided] : {std::pair{1u, true}, {1u, false}, {4u, true}}) {
        SCOPED_TRACE(fmt::format("{} squares, double-sided {}", squares, double_sided));
        const RenderResult picture = picture_of(squares, double_sided);
        Tally dark;
        for (size_t i = 0; i < picture.radiance.size(); i++)
            dark.add(picture.radiance[i].x == 0,
                     [&, i] { return fmt::format("pixel {},{}: {:.4f}", i % 64, i / 64, picture.radiance[i].x); });
        dark.expect(0, 4096);
    }
    // Light passes the backs of single-sided neighbours: a little leaks where the normals lean far (docs/frame.md),
    // never more than the surface would have without shadows.
    const RenderResult picture = picture_of(4, false);
    Tally bounded;
    size_t lit = 0;
    for (size_t i = 0; i < picture.radiance.size(); i++) {
        const double cosine = -glm::dot(glm::dvec3(picture.aovs.normal[i]), travel), got = picture.radiance[i].x;
        lit += got > 0;
        bounded.add(cosine > 0 ? got <= 3 * cosine / kPi + 1e-5 : got == 0,
                    [&, i] { return fmt::format("pixel {},{}: {:.4f}, cosine {:.4f}", i % 64, i / 64, got, cosine); });
    }
    bounded.expect(0, 4096);
    EXPECT_LE(lit, 721u);
}

TEST_F(ShadowTest, FlatFacesTurnDarkWithTheirPlanes) {
    const glm::dvec3 travel = glm::normalize(glm::dvec3(-1, -0.4, -0.15));
    Stage stage;
    Primitive ball = sphere({0, 0, 0}, 1, 4), flat;
    for (const glm::uvec3& t : ball.triangles) {
        const glm::vec3 a = ball.positions[t.x], b = ball.positions[t.y], c = ball.positions[t.z];
        const uint32_t first = uint32_t(flat.positions.size());
        flat.positions.insert(flat.positions.end(), {a, b, c});
        flat.normals.insert(flat.normals.end(), 3, glm::normalize(glm::cross(b - a, c - a)));
        flat.triangles.push_back({first, first + 1, first + 2});
    }
    stage.add(flat, lambert({1, 1, 1}));
    stage.sun(glm::vec3(travel), {3, 3, 3});
    RenderSettings settings = settings_for(orthographic({-1, 1.5f, 3}, {0, 0, 0}, 2.6f), 128);
    settings.aovs = true;
    const RenderResult picture = render(stage, black, settings);
    Tally all;
    for (size_t i = 0; i < picture.radiance.size(); i++) {
        if (picture.aovs.triangle[i] < 0) continue;
        const double cosine = -glm::dot(glm::dvec3(picture.aovs.normal[i]), travel), got = picture.radiance[i].x;
        all.add(std::abs(got - std::max(0.0, cosine) * 3 / kPi) < 1e-4,
                [&, i] { return fmt::format("pixel {},{}: {:.4f}, cosine {:.4f}", i % 128, i / 128, got, cosine); });
    }
    all.expect(0, 5000);
}

TEST_F(ShadowTest, SpotConeFadesBetweenItsAngles) {
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    Light& spot = stage.lamp({0.3f, 2, 0.2f}, {20, 10, 5});
    spot.kind = Light::Kind::spot;
    spot.direction = glm::normalize(glm::vec3(0.2f, -1, -0.1f));
    spot.inner_cone = glm::radians(15.f);
    spot.outer_cone = glm::radians(32.f);
    const Camera camera = from_above(4);
    const glm::dvec3 position = spot.position, direction = spot.direction;
    size_t inside = 0, between = 0, outside = 0;
    tally(render(stage, black, settings_for(camera)), camera, 2e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const glm::dvec3 to_floor = ray.at_plane(1, 0) - position;
              const double distance = glm::length(to_floor),
                           angle = std::acos(glm::dot(to_floor, direction) / distance) * 180 / kPi;
              const double fade = (std::cos(angle * kPi / 180) - std::cos(32 * kPi / 180)) /
                                  (std::cos(15 * kPi / 180) - std::cos(32 * kPi / 180));
              const double cone = angle < 15 ? 1 : angle > 32 ? 0 : fade * fade;
              (angle < 15 ? inside : angle > 32 ? outside : between)++;
              return glm::dvec3(20, 10, 5) * (cone * 2 / std::pow(distance, 3) / kPi);
          })
        .expect(0, 4096);
    EXPECT_GT(inside, 100u);
    EXPECT_GT(between, 500u);
    EXPECT_GT(outside, 500u);
}

TEST_F(ShadowTest, LampEndsAtItsRange) {
    Stage stage;
    stage.add(ground(4), lambert({1, 1, 1}));
    stage.lamp({0, 1, 0}, {10, 10, 10}).range = 1.8f;
    const Camera camera = from_above(4);
    size_t beyond = 0;
    tally(render(stage, black, settings_for(camera)), camera, 1e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const double distance = glm::length(ray.at_plane(1, 0) - glm::dvec3(0, 1, 0));
              beyond += distance > 1.8;
              // KHR_lights_punctual, "Range Property".
              return glm::dvec3(10 * std::max(0.0, 1 - std::pow(distance / 1.8, 4)) / std::pow(distance, 3) / kPi);
          })
        .expect(0, 4096);
    EXPECT_GT(beyond, 500u);
}

}  // namespace
}  // namespace peelray
