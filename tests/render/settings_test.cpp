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
    RenderResult row(float exposure, Tonemap tonemap) {
        Stage stage;
        for (size_t i = 0; i < kRow.size(); i++)
            stage.add(parallelogram({float(i), 0, 0}, {1, 0, 0}, {0, 1, 0}), unlit(kRow[i]));
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
    const RenderResult plain = row(0, Tonemap::none);
    EXPECT_EQ(plain.encoded[0], 0xff000000u);
    EXPECT_EQ(plain.encoded[3], 0xffffbc80u);  // 0.2159, 0.5, 1: 128, 188, 255, red in the lowest byte
    for (float exposure : {0.f, 1.f, -2.5f})
        for (Tonemap curve : {Tonemap::none, Tonemap::aces, Tonemap::neutral}) {
            SCOPED_TRACE(fmt::format("exposure {}, curve {}", exposure, int(curve)));
            const RenderResult picture = row(exposure, curve);
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
    EXPECT_EQ(choose_automatically(device(), 1000, settings).hit, HitTest::exact);
    EXPECT_EQ(choose_automatically(device(), 20'000'000, settings).hit, HitTest::planar);
    // A software device binds 128 MiB: the corners of more triangles than that do not fit.
    const uint64_t most = most_exact_triangles(device());
    EXPECT_EQ(most, device().limits().maxStorageBufferRange / 48);
    if (most < 4'000'000) {
        EXPECT_EQ(choose_automatically(device(), uint32_t(most), settings).hit, HitTest::exact);
        EXPECT_EQ(choose_automatically(device(), uint32_t(most) + 1, settings).hit, HitTest::planar);
    }
    settings.cubes.ldc = 77;
    EXPECT_EQ(choose_automatically(device(), 20'000'000, settings).ldc, 77u);
    settings.hit_auto = false;
    EXPECT_EQ(choose_automatically(device(), 20'000'000, settings).hit, HitTest::exact);
}

}  // namespace
}  // namespace peelray
