// Exposure, tone curves and encoding; impossible settings.
#include <pictures.h>

namespace peelray {
namespace {

using SettingsTest = PictureTest;

glm::dvec3 aces(glm::dvec3 c) {
    return glm::clamp(c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0);
}
/// The Khronos PBR neutral tone mapper, from its specification.
glm::dvec3 neutral(glm::dvec3 c) {
    const double low = std::min({c.x, c.y, c.z});
    c -= low < 0.08 ? low - 6.25 * low * low : 0.04;
    const double peak = std::max({c.x, c.y, c.z});
    if (peak < 0.76) return c;
    const double squeezed = 1 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
    return glm::mix(c * (squeezed / peak), glm::dvec3(squeezed), 1 - 1 / (0.15 * (peak - squeezed) + 1));
}
double encode(double v) {
    v = std::clamp(v, 0.0, 1.0);
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

/// A row of known radiances, one a pixel.
const std::vector<glm::vec3> kRow = {
    {0, 0, 0},           {0.001f, 0.002f, 0.003f}, {0.02f, 0.05f, 0.1f}, {0.2159f, 0.5f, 1}, {0.18f, 0.18f, 0.18f},
    {0.8f, 0.1f, 0.01f}, {2, 0.5f, 0.1f},          {30, 20, 10}};

class EncodingTest : public PictureTest {
  protected:
    RenderResult row(float exposure, Tonemap tonemap, Material (*material)(const glm::vec3&)) {
        Stage stage;
        for (size_t i = 0; i < kRow.size(); i++)
            stage.add(parallelogram({float(i), 0, 0}, {1, 0, 0}, {0, 1, 0}), material(kRow[i]));
        RenderSettings settings = settings_for(orthographic({4, 0.5f, 3}, {4, 0.5f, 0}, 1));
        settings.width = 8;
        settings.height = 1;
        settings.exposure = exposure;
        settings.tonemap = tonemap;
        settings.spp = 2;
        return render(stage, black, settings);
    }
};

TEST_F(EncodingTest, KnownRadianceGivesKnownBytes) {
    const RenderResult plain = row(0, Tonemap::none, emitting);
    EXPECT_EQ(plain.encoded[0], 0xff000000u);
    EXPECT_EQ(plain.encoded[3], 0xffffbc80u);  // 0.2159, 0.5, 1: 128, 188, 255, red in the lowest byte
    for (float exposure : {0.f, 1.f, -2.5f})
        for (Tonemap curve : {Tonemap::none, Tonemap::aces, Tonemap::neutral}) {
            SCOPED_TRACE(fmt::format("exposure {}, curve {}", exposure, int(curve)));
            const RenderResult picture = row(exposure, curve, emitting);
            for (size_t i = 0; i < kRow.size(); i++) {
                glm::dvec3 c = glm::dvec3(kRow[i]) * std::exp2(double(exposure));
                if (curve == Tonemap::aces) c = aces(c);
                if (curve == Tonemap::neutral) c = neutral(c);
                for (int k = 0; k < 3; k++)
                    EXPECT_NEAR(picture.encoded[i] >> (8 * k) & 255, encode(c[k]), 0.51 + 0.05) << i << " " << k;
                EXPECT_EQ(picture.encoded[i] >> 24, 255u);
                // Exposure and curve leave the radiance alone.
                EXPECT_TRUE(near(glm::dvec3(picture.radiance[i]), glm::dvec3(kRow[i]), 1e-5));
            }
        }
}

TEST_F(EncodingTest, UnlitColoursComeOutAsTheyAre) {
    for (float exposure : {0.f, 1.f, -2.5f})
        for (Tonemap curve : {Tonemap::none, Tonemap::aces, Tonemap::neutral}) {
            SCOPED_TRACE(fmt::format("exposure {}, curve {}", exposure, int(curve)));
            const RenderResult picture = row(exposure, curve, unlit);
            for (size_t i = 0; i < kRow.size(); i++) {
                for (int k = 0; k < 3; k++)
                    EXPECT_NEAR(picture.encoded[i] >> (8 * k) & 255, encode(kRow[i][k]), 0.51) << i << " " << k;
                EXPECT_TRUE(near(glm::dvec3(picture.radiance[i]), glm::dvec3(kRow[i]), 1e-5)) << "also as radiance";
            }
        }
}

/// Unlit 0.2, 0.5, 0.8 left of x = 0, a light of 3 on the right; one pixel across the edge.
Stage unlit_beside_light() {
    Stage stage;
    stage.add(parallelogram({-4, -4, 0}, {4, 0, 0}, {0, 8, 0}), unlit({0.2f, 0.5f, 0.8f}));
    stage.add(parallelogram({0, -4, 0}, {4, 0, 0}, {0, 8, 0}), emitting({3, 3, 3}));
    return stage;
}

TEST_F(EncodingTest, AtEdgesUnlitColoursMixWithWhatTheCurveGives) {
    const Stage stage = unlit_beside_light();
    RenderSettings settings = settings_for(orthographic({0, 0, 3}, {0, 0, 0}, 2));
    settings.width = settings.height = 1;
    settings.spp = 64;
    settings.exposure = -1;
    const glm::dvec3 color(0.2, 0.5, 0.8);
    for (const auto& [tonemap, curve] : {std::pair{Tonemap::aces, &aces}, std::pair{Tonemap::neutral, &neutral}}) {
        settings.tonemap = tonemap;
        const RenderResult picture = render(stage, black, settings);
        // Half of the pixel each, to one of the samples.
        EXPECT_TRUE(near(glm::dvec3(picture.radiance[0]), color * 0.5 + 1.5, 3.0 / 64));
        const glm::dvec3 want = color * 0.5 + curve(glm::dvec3(0.75));
        for (int k = 0; k < 3; k++) EXPECT_NEAR(picture.encoded[0] >> (8 * k) & 255, encode(want[k]), 4) << k;
    }
}

TEST_F(EncodingTest, PostPassesChangeUnlitColoursToo) {
    const Stage stage = unlit_beside_light();
    RenderSettings settings = settings_for(orthographic({0, 0, 3}, {0, 0, 0}, 2), 16);
    settings.spp = 3;
    settings.tonemap = Tonemap::aces;
    const RenderResult plain = render(stage, black, settings);
    const auto renderer = renderer_for(stage, black);
    renderer->add_post_pass([](Commands&, const Buffer&, const PictureSettings&) {});
    EXPECT_EQ(renderer->render(settings).encoded, plain.encoded) << "encoded in a pass of its own, bit for bit";
    renderer->add_post_pass(
        [](Commands& commands, const Buffer& picture, const PictureSettings&) { commands.fill(picture, 0); });
    for (const uint32_t pixel : renderer->render(settings).encoded) ASSERT_EQ(pixel, 0xff000000u);
}

TEST_F(EncodingTest, InAMirrorAnUnlitSurfaceIsALight) {
    Stage stage;
    stage.add(ground(5), plane_mirror());
    stage.add(parallelogram({-50, 5, 50}, {0, 0, -100}, {100, 0, 0}), unlit({0.2f, 0.5f, 0.8f}));
    RenderSettings settings = settings_for(orthographic({0, 3, 0.1f}, {0, 0, 0}, 1), 4);
    settings.exposure = 1;
    settings.tonemap = Tonemap::aces;
    const RenderResult picture = render(stage, black, settings);
    const glm::dvec3 want = aces(2.0 * glm::dvec3(0.2, 0.5, 0.8));
    for (int k = 0; k < 3; k++) EXPECT_NEAR(picture.encoded[5] >> (8 * k) & 255, encode(want[k]), 0.6) << k;
}

TEST_F(SettingsTest, ImpossibleSettingsAreNamed) {
    Stage stage;
    stage.add(ground(1), unlit({1, 1, 1}));
    const RenderSettings good = settings_for(from_above(1), 8);
    const auto refuses = [&](const std::function<void(RenderSettings&)>& change,
                             std::initializer_list<std::string> parts) {
        RenderSettings settings = good;
        change(settings);
        expect_error([&] { render(stage, black, settings); }, parts);
    };
    refuses([](auto& s) { s.width = 0; }, {"0x8", "--size"});
    refuses([](auto& s) { s.height = 0; }, {"8x0", "--size"});
    refuses([](auto& s) { s.width = s.height = 4000000000u; }, {"4000000000x4000000000", "--size"});
    refuses([](auto& s) { s.width = 1u << 20; }, {"--size"});
    refuses([](auto& s) { s.bounces = 17; }, {"17", "16", "--bounces"});
    refuses([](auto& s) { s.spp = 0; }, {"--spp"});
    refuses([](auto& s) { s.cubes.ldc = 8; }, {"8", "--ldc"});
    refuses([](auto& s) { s.cubes.ldc = 4096; }, {"4096", "--ldc"});
    refuses([](auto& s) { s.camera.look = s.camera.eye; }, {"--eye", "--look"});
    refuses([](auto& s) { s.camera.up = {0, -3, 0}; }, {"--up"});
    refuses([](auto& s) { s.camera.up = {0, 0, 0}; }, {"--up"});
    refuses([](auto& s) { s.camera.eye.x = NAN; }, {"--eye"});
    refuses([](auto& s) { s.camera = perspective({0, 1, 5}, {0, 0, 0}, 180); }, {"180", "--fov"});
    refuses([](auto& s) { s.camera = perspective({0, 1, 5}, {0, 0, 0}, 0); }, {"--fov"});

    // The renderer is still of use after an error; and the largest legal values work.
    const auto renderer = renderer_for(stage, black);
    RenderSettings settings = good;
    settings.bounces = 17;
    expect_error([&] { renderer->render(settings); }, {"--bounces"});
    settings.bounces = 16;
    EXPECT_EQ(renderer->render(settings).radiance.size(), 64u);
    settings.width = 5, settings.height = 3;  // another size afterwards
    EXPECT_TRUE(near(radiance_at(renderer->render(settings), 2, 1), {1, 1, 1}, 1e-6));
}

TEST_F(SettingsTest, AutoChoosesByTriangles) {
    RenderSettings settings;
    EXPECT_EQ(choose_automatically(1000, settings).hit, HitTest::exact);
    EXPECT_TRUE(choose_automatically(1000, settings).may_be_planar);
    EXPECT_EQ(choose_automatically(20'000'000, settings).hit, HitTest::planar);
    EXPECT_FALSE(choose_automatically(20'000'000, settings).may_be_planar);
    settings.cubes.ldc = 77;
    EXPECT_EQ(choose_automatically(20'000'000, settings).ldc, 77u);
    settings.hit_auto = false;
    EXPECT_EQ(choose_automatically(20'000'000, settings).hit, HitTest::exact);
    EXPECT_FALSE(choose_automatically(20'000'000, settings).may_be_planar);
}

TEST_F(SettingsTest, WhatFindsNoRoomBecomesCoarserAndPlanarLast) {
    CubeChoice choice;
    choice.may_be_planar = true;
    std::vector<CubeChoice> tried = {choice};
    for (auto next = smaller_than(choice); next; next = smaller_than(tried.back())) {
        ASSERT_LT(tried.size(), 100u);
        tried.push_back(*next);
    }
    // Each step is coarser than the one before, first exact, then planar; there is an end.
    size_t exact = 0;
    for (size_t i = 1; i < tried.size(); i++) {
        exact += tried[i].hit == HitTest::exact;
        if (tried[i].hit != tried[i - 1].hit) continue;
        EXPECT_LT(tried[i].fineness, tried[i - 1].fineness);
    }
    EXPECT_GE(exact, 4u);
    EXPECT_EQ(tried[exact + 1].hit, HitTest::planar);
    EXPECT_EQ(tried[exact + 1].fineness, 1);
    EXPECT_EQ(tried.back().hit, HitTest::planar);
    // What the user chose stays.
    choice.ldc = 512;
    ASSERT_TRUE(smaller_than(choice).has_value());
    EXPECT_EQ(smaller_than(choice)->hit, HitTest::planar);
    EXPECT_EQ(smaller_than(choice)->ldc, 512u);
    choice.may_be_planar = false;
    EXPECT_FALSE(smaller_than(choice).has_value());
    choice.ldc = 0;
    for (auto next = smaller_than(choice); next; next = smaller_than(*next)) EXPECT_EQ(next->hit, HitTest::exact);
}

TEST_F(SettingsTest, RaysAreNeededWhereAnEffectTracesThem) {
    RenderSettings settings;
    EXPECT_TRUE(needs_rays(settings, false));
    settings.shadow = false;
    settings.bounces = 0;
    EXPECT_FALSE(needs_rays(settings, false)) << "no bounce, no reflection";
    settings.ambient = true;
    EXPECT_TRUE(needs_rays(settings, false));
    settings.ambient = settings.reflection = false;
    settings.bounces = 1;
    EXPECT_TRUE(needs_rays(settings, false)) << "refraction";
    settings.refraction = false;
    EXPECT_FALSE(needs_rays(settings, false));
    settings.counters = true;
    EXPECT_TRUE(needs_rays(settings, false)) << "counts are asked for, of no rays";
}

/// What is not wanted does not come; what comes is the same, also in another picture's memory.
TEST_F(SettingsTest, OnlyWhatIsWantedIsHandedOver) {
    Stage stage;
    stage.add(parallelogram({0, 0, 0}, {1.7f, 0, 0}, {0, 1.3f, 0}), emitting(glm::vec3(0.5f, 0.25f, 1)));
    for (const uint32_t spp : {1u, 5u}) {
        RenderSettings settings = settings_for(orthographic({1, 1, 3}, {1, 1, 0}, 2), 67);
        settings.spp = spp;
        const auto renderer = renderer_for(stage, black);
        const RenderResult all = renderer->render(settings);
        EXPECT_FALSE(all.seen);
        double share = 0;
        for (const glm::vec4& pixel : all.radiance) share += double(pixel.w) / double(all.radiance.size());
        ASSERT_GT(share, 0.3);
        ASSERT_LT(share, 0.9);

        settings.radiance = false;
        settings.seen = true;
        RenderResult encoded = renderer->render(settings);
        EXPECT_TRUE(encoded.radiance.empty());
        EXPECT_EQ(encoded.encoded, all.encoded);
        ASSERT_TRUE(encoded.seen);
        EXPECT_NEAR(*encoded.seen, share, 1e-6);
        renderer->add_radiance(encoded);
        EXPECT_EQ(encoded.radiance, all.radiance);

        const uint32_t* memory = encoded.encoded.data();
        std::ranges::fill(encoded.encoded, 1u);
        renderer->reuse(std::move(encoded));
        const RenderResult again = renderer->render(settings);
        EXPECT_EQ(again.encoded.data(), memory);
        EXPECT_EQ(again.encoded, all.encoded);
        EXPECT_TRUE(again.radiance.empty());

        settings.radiance = true;
        settings.encoded = false;
        const RenderResult radiance = renderer->render(settings);
        EXPECT_TRUE(radiance.encoded.empty());
        EXPECT_EQ(radiance.radiance, all.radiance);
        EXPECT_FALSE(radiance.seen) << "the radiance tells";
    }
}

}  // namespace
}  // namespace peelray
