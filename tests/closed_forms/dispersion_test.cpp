// Dispersion (KHR_materials_dispersion): red, green and blue each by Snell's law with an index of its own.
#include <pictures.h>

#include "layers.h"

namespace peelray {
namespace {

using DispersionTest = PictureTest;

Material dispersive(float ior, float dispersion) {
    Material m = clear_glass(ior);
    m.dispersion = dispersion;
    return m;
}
/// Of red, green and blue.
glm::dvec3 indices(double ior, double dispersion) {
    return ior + glm::dvec3(-1, 0, 1) * (ior - 1) * 0.025 * dispersion;
}

TEST_F(DispersionTest, SlabShiftsEachChannelBySnellsLaw) {
    Stage stage;
    add_lit_wall(stage);
    stage.add(plate(0.9f, -0.9f), dispersive(1.5f, 10));
    const Camera camera = perspective({1.6f, 0.9f, 2.5f}, {0.5f, 0.2f, 0}, 50);
    RenderSettings settings = settings_for(camera, 48);
    settings.reflection = false;
    const RenderResult picture = render(stage, black, settings);
    const auto compare = [&](const glm::dvec3& of) {
        return tally(picture, camera, 1e-3, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
            glm::dvec3 want;
            for (int k = 0; k < 3; k++) {
                const Seen seen = through(ray, {{0.9, of[k]}, {-0.9, 1}});
                if (seen.off) return {};
                want[k] = seen.light[k];
            }
            return want;
        });
    };
    compare(indices(1.5, 10)).expect(0, 1500);
    const Tally straight = compare(glm::dvec3(1.5));
    EXPECT_GT(double(straight.wrong), 0.8 * double(straight.compared));
    // Three rays from the front on, behind the back too.
    EXPECT_EQ(picture.rays.refraction, 2u * 3u * 48u * 48u);
}

/// Straight into the face at z = 1 of a prism, out of the slanted one at 45 degrees, by a single index; nothing where
/// it is reflected totally.
TEST_F(DispersionTest, PrismSpreadsLight) {
    const auto light = [](const glm::dvec3& p) { return glm::dvec3(1 + 0.1 * p.x, 1 + 0.1 * p.y, 1 - 0.05 * p.y); };
    const auto seen = [&](const ViewRay& ray, double n) {
        const double sine = n * std::sqrt(0.5);
        if (sine >= 1) return glm::dvec3(0);
        const double cosine = std::sqrt(1 - sine * sine);
        // Along the wall, downwards, and out of it.
        const glm::dvec3 out =
            sine * glm::normalize(glm::dvec3(0, -1, -1)) + cosine * glm::normalize(glm::dvec3(0, 1, -1));
        const glm::dvec3 from(ray.origin.x, ray.origin.y, ray.origin.y);
        const glm::dvec3 at = from + out * ((-3 - from.z) / out.z);
        return (1 - fresnel(1, 1, n)) * (1 - fresnel(std::sqrt(0.5), n, 1)) * light(at);
    };
    const Camera camera = orthographic({0.013f, 0.007f, 5}, {0.013f, 0.007f, 0}, 1.6f);
    // All three come through; blue does not; red alone does.
    for (const double ior : {1.3, 1.38, 1.45}) {
        SCOPED_TRACE(ior);
        Stage stage;
        stage.add(prism(), dispersive(float(ior), 10));
        stage.add(gradient_quad({-4, -9, -3}, {8, 0, 0}, {0, 18, 0}, [&](glm::vec3 p) { return glm::vec3(light(p)); }),
                  unlit({1, 1, 1}));
        const glm::dvec3 n = indices(ior, 10);
        for (const uint32_t spp : {1u, 3u}) {
            RenderSettings settings = settings_for(camera, 24);
            settings.spp = spp;
            tally(render(stage, black, settings), camera, spp == 1 ? 2e-3 : 2e-2, [&](const ViewRay& ray) {
                return glm::dvec3(seen(ray, n.x).x, seen(ray, n.y).y, seen(ray, n.z).z);
            }).expect(0, 576);
        }
    }
}

TEST_F(DispersionTest, ReflectsEachChannelByItsIndex) {
    // Black glass: what gets in does not come out.
    Material m = dispersive(1.6f, 20);
    m.base_color = glm::vec3(0);
    const glm::dvec3 n = indices(1.6, 20);
    for (const double cosine : {1.0, 0.4}) {
        Stage stage;
        stage.add(plate(0, -0.5f), m);
        const Camera camera = slanted(cosine);
        tally(render(stage, white, settings_for(camera, 8)), camera, 1e-4, [&](const ViewRay&) {
            return glm::dvec3(fresnel(cosine, 1, n.x), fresnel(cosine, 1, n.y), fresnel(cosine, 1, n.z));
        }).expect(0, 64);
    }
}

TEST_F(DispersionTest, NothingIsLostOrMadeUp) {
    for (const float roughness : {0.f, 0.5f}) {
        Stage stage;
        Material m = dispersive(1.7f, 8);
        m.roughness = roughness;
        stage.add(sphere({0, 0, 0}, 1, 24), m);
        RenderSettings settings = settings_for(orthographic({1, 2, 4}, {0, 0, 0}, 2.2f), 24);
        settings.spp = roughness > 0 ? 8 : 1;
        settings.bounces = roughness > 0 ? 4 : 8;
        const RenderResult picture = render(stage, white, settings);
        for (const glm::vec4& p : picture.radiance) EXPECT_TRUE(near(glm::dvec3(p), glm::dvec3(1), 0.01));
    }
}

TEST_F(DispersionTest, ThinWallsDoNotDisperse) {
    Material m = thin_glass();
    const auto picture = [&](float dispersion) {
        m.dispersion = dispersion;
        Stage stage;
        add_lit_wall(stage);
        stage.add(parallelogram({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), m);
        return render(stage, white, settings_for(perspective({1.6f, 0.9f, 2}, {0.5f, 0.2f, 0}, 50), 16));
    };
    const RenderResult plain = picture(0), other = picture(20);
    tally(plain, other, 0).expect(0, 256);
    EXPECT_EQ(plain.rays.refraction, other.rays.refraction);
}

TEST_F(DispersionTest, OpaqueBodiesDoNotDisperse) {
    // Beside glass that does: only light that gets into a body knows its indices.
    const double cosine = 0.5;
    Material m = dispersive(1.5f, 20);
    m.transmission = 0;
    m.base_color = glm::vec3(0);
    Stage stage;
    stage.add(plate(0, -0.5f), m);
    stage.add(sphere({0, 0, -9}, 0.1f, 8), dispersive(1.5f, 20));
    const Camera camera = slanted(cosine);
    tally(render(stage, white, settings_for(camera, 8)), camera, 1e-4, [&](const ViewRay&) {
        return glm::dvec3(fresnel(cosine, 1, 1.5));
    }).expect(0, 64);
}

TEST_F(DispersionTest, InsideAnotherMediumEachChannelKeepsItsOwn) {
    // A slab of dispersive glass in a plain liquid, and the other way round: the light that came apart stays apart.
    for (const bool outer : {false, true}) {
        SCOPED_TRACE(outer);
        Stage stage;
        add_lit_wall(stage);
        stage.add(plate(0.9f, -0.9f), outer ? dispersive(1.4f, 12) : clear_glass(1.4f));
        stage.add(plate(0.4f, -0.4f, 3.5f), outer ? clear_glass(1.6f) : dispersive(1.6f, 12));
        const glm::dvec3 around = outer ? indices(1.4, 12) : glm::dvec3(1.4),
                         inside = outer ? glm::dvec3(1.6) : indices(1.6, 12);
        const Camera camera = perspective({1.2f, 0.7f, 3}, {0.3f, 0.2f, 0}, 40);
        RenderSettings settings = settings_for(camera, 24);
        settings.reflection = false;
        settings.bounces = 6;
        tally(render(stage, black, settings), camera, 1e-3, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
            glm::dvec3 want;
            for (int k = 0; k < 3; k++) {
                const Seen seen = through(ray, {{0.9, around[k]}, {0.4, inside[k]}, {-0.4, around[k]}, {-0.9, 1}});
                if (seen.off) return {};
                want[k] = seen.light[k];
            }
            return want;
        }).expect(0, 500);
    }
}

}  // namespace
}  // namespace peelray
