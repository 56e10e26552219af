// The reference as a program part: threads, interrupts, settings, auxiliary pictures. Its light is tested in
// ../closed_forms.
#include <pictures.h>

#include "base/error.h"
#include "reference/oracle.h"
#include "scene/encoding.h"

namespace peelray {
namespace {

using PathTracerTest = PictureTest;

Stage small_world() {
    Stage stage;
    Material glass;
    glass.transmission = 1;
    glass.thickness = 1;
    glass.roughness = 0.1f;
    stage.add(ground(3), lambert({0.8f, 0.7f, 0.6f}));
    stage.add(sphere({-0.8f, 0.7f, 0}, 0.6f, 24), glass);
    stage.add(sphere({0.8f, 0.7f, 0}, 0.6f, 24), plane_mirror({0.9f, 0.9f, 0.9f}));
    stage.lamp({1, 3, 2}, {9, 9, 9});
    return stage;
}

RenderSettings full_settings() {
    RenderSettings settings = settings_for(perspective({0, 2, 4}, {0, 0.5f, 0}, 50), 70);
    settings.spp = 4;
    settings.ambient = settings.aovs = true;
    return settings;
}

TEST_F(PathTracerTest, ThreadsDoNotChangeThePicture) {
    const Environment sky = sky_environment(default_sun_direction());
    const Stage stage = small_world();
    const Picture one = render(stage, sky, full_settings(), 1), many = render(stage, sky, full_settings(), 7);
    EXPECT_EQ(one.radiance, many.radiance);
    EXPECT_EQ(one.encoded, many.encoded);
    EXPECT_EQ(one.aovs.depth, many.aovs.depth);
    EXPECT_EQ(one.rays.reflection, many.rays.reflection);
    EXPECT_EQ(one.rays.refraction, many.rays.refraction);
    EXPECT_EQ(one.rays.shadow, many.rays.shadow);
    EXPECT_EQ(one.rays.ambient, many.rays.ambient);
    EXPECT_GT(one.rays.refraction, 1000u);
}

TEST_F(PathTracerTest, AuxiliaryPicturesAreTheOraclesHits) {
    const Stage stage = small_world();
    const RenderSettings settings = full_settings();
    const Picture picture = render(stage, white, settings);
    const Geometry geometry = flatten(stage.scene);
    const Oracle oracle(geometry);
    size_t hits = 0;
    for (uint32_t y = 0; y < settings.height; y++)
        for (uint32_t x = 0; x < settings.width; x++) {
            const ViewRay ray = view_ray(settings.camera, settings.width, settings.height, x + 0.5, y + 0.5);
            const OracleHit hit = oracle.closest({ray.origin, 0, ray.direction, INFINITY});
            const size_t at = size_t(y) * settings.width + x;
            if (!hit.hit()) {
                EXPECT_EQ(picture.aovs.triangle[at], -1);
                EXPECT_EQ(picture.aovs.depth[at], INFINITY);
                continue;
            }
            hits++;
            EXPECT_EQ(picture.aovs.triangle[at], float(hit.triangle));
            EXPECT_EQ(picture.aovs.material[at], float(geometry.materials[hit.triangle]));
            EXPECT_NEAR(picture.aovs.depth[at], hit.t, 2e-6 * hit.t);
            const glm::dvec3 p = ray.origin + hit.t * ray.direction;
            EXPECT_LT(glm::length(p - glm::dvec3(picture.aovs.position[at])), 1e-5);
            const glm::dvec3 n(picture.aovs.normal[at]);
            EXPECT_NEAR(glm::length(n), 1, 1e-6);
            EXPECT_LT(glm::dot(n, ray.direction), 0);
        }
    EXPECT_GT(hits, 2000u);
}

TEST_F(PathTracerTest, AnInterruptEndsAllThreads) {
    const Stage stage = small_world();
    const Geometry geometry = flatten(stage.scene);
    const PathTracer tracer(stage.scene, at_rest(stage.scene), geometry, white);
    int calls = 0;
    const auto stop = [&](double share) {
        EXPECT_GE(share, 0);
        EXPECT_LE(share, 1);
        if (++calls == 2) fail("stopped here");
    };
    try {
        tracer.render(full_settings(), stop, 3);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "stopped here");
    }
    EXPECT_EQ(calls, 2);
}

TEST_F(PathTracerTest, ImpossibleSettingsNameTheOption) {
    const Stage stage = small_world();
    const auto message = [&](auto change) -> std::string {
        RenderSettings settings = full_settings();
        change(settings);
        try {
            render(stage, white, settings);
        } catch (const Error& error) {
            return error.line("--");
        }
        return "";
    };
    EXPECT_NE(message([](auto& s) { s.width = 0; }).find("--size"), std::string::npos);
    EXPECT_NE(message([](auto& s) { s.bounces = 17; }).find("--bounces"), std::string::npos);
    EXPECT_NE(message([](auto& s) { s.spp = 0; }).find("--spp"), std::string::npos);
    EXPECT_NE(message([](auto& s) { s.camera.eye = s.camera.look; }).find("--eye"), std::string::npos);
}

TEST_F(PathTracerTest, ExposureAndToneCurveApplyToTheEncodedPictureOnly) {
    Stage stage;
    stage.add(ground(3), emitting(glm::vec3(0.25f)));
    RenderSettings settings = settings_for(from_above(2), 8);
    settings.tonemap = Tonemap::none;
    settings.exposure = 1;
    const Picture picture = render(stage, black, settings);
    EXPECT_EQ(picture.radiance[20], glm::vec4(0.25f, 0.25f, 0.25f, 1));
    EXPECT_EQ(picture.encoded[20], 0xffbcbcbcu);  // sRGB of 0.5 is 188
}

TEST_F(PathTracerTest, UnlitColoursComeOutAsTheyAre) {
    Stage stage;
    stage.add(parallelogram({-4, 0, 4}, {4, 0, 0}, {0, 0, -8}), unlit({0.5f, 0.25f, 0}));
    stage.add(parallelogram({0, 0, 4}, {4, 0, 0}, {0, 0, -8}), emitting(glm::vec3(3)));
    RenderSettings settings = settings_for(from_above(2), 9);
    settings.exposure = -1;
    settings.spp = 8;
    for (Tonemap tonemap : {Tonemap::none, Tonemap::aces, Tonemap::neutral}) {
        settings.tonemap = tonemap;
        const Picture picture = render(stage, black, settings);
        EXPECT_EQ(picture.encoded[20], 0xff0089bcu);  // sRGB of 0.5 and 0.25
        EXPECT_EQ(picture.radiance[20], glm::vec4(0.5f, 0.25f, 0, 1));
        // Across the edge: of one sort each sample, of both a share.
        const double share = (3 - picture.radiance[22].x) / 2.5;
        const glm::dvec3 lit = tone_curve(glm::dvec3((1 - share) * 1.5), tonemap);
        for (int k = 0; k < 3; k++)
            EXPECT_NEAR(picture.encoded[22] >> (8 * k) & 255,
                        255 * linear_to_srgb(std::min(1.0, lit[k] + share * (k == 0   ? 0.5
                                                                             : k == 1 ? 0.25
                                                                                      : 0))),
                        0.51);
    }
}

}  // namespace
}  // namespace peelray
