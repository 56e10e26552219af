// --denoise on whole pictures: less noise where light is drawn at random, nothing else changed.
#include <pictures.h>

namespace peelray {
namespace {

class DenoiseTest : public PictureTest {
  protected:
    /// A floor and a wall that takes half of the sky from it; with ambient rays the floor is noisy.
    static Stage corner(const Material& floor) {
        Stage stage;
        stage.add(ground(3), floor);
        stage.add(faces({{{-3, 0, -0.5f}, {3, 0, -0.5f}, {3, 2, -0.5f}, {-3, 2, -0.5f}}}), lambert({0.3f, 0.3f, 0.3f}));
        return stage;
    }
    RenderSettings settings_for_corner(uint32_t spp, bool denoise) const {
        Camera camera;
        camera.eye = {0, 3, 5};
        camera.look = {0, 0, 0};
        RenderSettings s = settings_for(camera, 64);
        s.ambient = true;
        s.spp = spp;
        s.denoise = denoise ? Denoise::spatial : Denoise::none;
        return s;
    }
    /// Mean squared difference of the luminances where there are surfaces in all samples.
    static double distance(const RenderResult& a, const RenderResult& b) {
        double sum = 0, count = 0;
        for (size_t i = 0; i < a.radiance.size(); i++) {
            if (b.radiance[i].w < 1 || a.radiance[i].w < 1) continue;
            const double d = a.radiance[i].y - b.radiance[i].y;
            sum += d * d;
            count++;
        }
        return sum / count;
    }
    /// How much of the squared error of few samples is left.
    double left(const Stage& stage, uint32_t spp) {
        const RenderResult truth = render(stage, white, settings_for_corner(256, false));
        const RenderResult noisy = render(stage, white, settings_for_corner(spp, false));
        const RenderResult smooth = render(stage, white, settings_for_corner(spp, true));
        EXPECT_GT(distance(noisy, truth), 1e-4);
        return distance(smooth, truth) / distance(noisy, truth);
    }
};

TEST_F(DenoiseTest, TakesMostOfTheNoise) {
    const Stage stage = corner(lambert({0.8f, 0.8f, 0.8f}));
    EXPECT_LT(left(stage, 1), 0.2);
    EXPECT_LT(left(stage, 4), 0.2);
}

TEST_F(DenoiseTest, TakesItInAMirror) {
    Stage stage = corner(lambert({0.8f, 0.8f, 0.8f}));
    // All that the camera sees.
    stage.add(faces({{{-4, -1, 6}, {-4, 6, 6}, {4, 6, 6}, {4, -1, 6}}}), plane_mirror());
    RenderSettings s = settings_for_corner(1, false);
    s.camera.eye = {0, 2, 4};
    s.camera.look = {0, 1.5f, 6};
    const auto picture = [&](uint32_t spp, bool denoise) {
        s.spp = spp;
        s.denoise = denoise ? Denoise::spatial : Denoise::none;
        return render(stage, white, s);
    };
    const RenderResult truth = picture(256, false), noisy = picture(1, false);
    EXPECT_GT(distance(noisy, truth), 1e-4);
    EXPECT_LT(distance(picture(1, true), truth), 0.3 * distance(noisy, truth));
}

/// Half of what is drawn from the environment is below the floor. Where nothing was found it is the floor all the same.
TEST_F(DenoiseTest, TakesItOnAMirrorThatScatters) {
    Material floor = lambert({0.8f, 0.8f, 0.8f});
    floor.metallic = 0.5f;
    floor.roughness = 0;
    Stage stage;
    stage.add(ground(3), floor);
    Environment sky = white;
    sky.distribution = EnvironmentDistribution(sky);
    const auto picture = [&](uint32_t spp, bool denoise) {
        RenderSettings s = settings_for_corner(spp, denoise);
        s.ambient = false;
        s.env_mode = EnvironmentMode::sampled;
        return render(stage, sky, s);
    };
    const RenderResult truth = picture(64, false), noisy = picture(1, false);
    EXPECT_GT(distance(noisy, truth), 1e-3);
    EXPECT_LT(distance(picture(1, true), truth), 0.2 * distance(noisy, truth));
}

TEST_F(DenoiseTest, WhatIsNotDrawnAtRandomStays) {
    Stage stage = corner(lambert({0.8f, 0.8f, 0.8f}));
    stage.add(ground(0.5f, 0.3f), plane_mirror());
    stage.sun({-1, -1, -1});
    RenderSettings s = settings_for_corner(1, false);
    s.ambient = false;
    const RenderResult plain = render(stage, white, s);
    s.denoise = Denoise::spatial;
    EXPECT_EQ(render(stage, white, s).radiance, plain.radiance);
}

/// Edges between lights, and images of them in a mirror, are smooth for they have samples, not for their noise.
TEST_F(DenoiseTest, EmissionAndItsImagesStay) {
    Stage stage;
    stage.add(faces({{{-2, 0, 2}, {0.3f, 0, 2}, {-0.3f, 0, -2}, {-2, 0, -2}}}), emitting({3, 1, 0.5f}));
    stage.add(faces({{{0.3f, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-0.3f, 0, -2}}}), emitting({0.2f, 1, 4}));
    stage.add(faces({{{-2, 0, -2}, {2, 0, -2}, {2, 2, -2}, {-2, 2, -2}}}), plane_mirror());
    RenderSettings s = settings_for_corner(4, false);
    s.ambient = false;
    const RenderResult plain = render(stage, black, s);
    s.denoise = Denoise::spatial;
    EXPECT_EQ(render(stage, black, s).radiance, plain.radiance);
}

TEST_F(DenoiseTest, TheSameAgainIsTheSame) {
    const Stage stage = corner(lambert({0.8f, 0.8f, 0.8f}));
    const RenderSettings s = settings_for_corner(2, true);
    const RenderResult first = render(stage, white, s), again = render(stage, white, s);
    EXPECT_EQ(first.radiance, again.radiance);
    EXPECT_EQ(first.encoded, again.encoded);
}

/// Auxiliary pictures say how the samples were.
TEST_F(DenoiseTest, VarianceIsThatOfTheSamples) {
    const Stage stage = corner(lambert({0.8f, 0.8f, 0.8f}));
    RenderSettings s = settings_for_corner(4, false);
    s.moments = true;
    const RenderResult plain = render(stage, white, s);
    s.denoise = Denoise::spatial;
    const RenderResult smooth = render(stage, white, s);
    EXPECT_EQ(smooth.aovs.variance, plain.aovs.variance);
    EXPECT_NE(smooth.radiance, plain.radiance);
}

TEST_F(DenoiseTest, TinyPictures) {
    const Stage stage = corner(lambert({0.8f, 0.8f, 0.8f}));
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(3, 2)}) {
        RenderSettings s = settings_for_corner(1, true);
        s.width = size.x;
        s.height = size.y;
        const RenderResult picture = render(stage, white, s);
        ASSERT_EQ(picture.radiance.size(), size_t(size.x) * size.y);
        for (const glm::vec4& pixel : picture.radiance) ASSERT_TRUE(pixel.x >= 0 && pixel.x < 2);
    }
}

}  // namespace
}  // namespace peelray
