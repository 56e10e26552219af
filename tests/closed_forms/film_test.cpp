// Thin films (KHR_materials_iridescence): what interferes, wavelength by wavelength, as Airy's sum has it.
#include <pictures.h>

#include <complex>

namespace peelray {
namespace {

using FilmTest = PictureTest;

using Complex = std::complex<double>;

/// The colour matching functions in the fit of Wyman, Sloan and Shirley (JCGT 2013), as linear Rec. 709.
glm::dvec3 sensitivity(double nm) {
    const auto lobe = [&](double height, double middle, double below, double above) {
        return height * std::exp(-0.5 * std::pow((nm - middle) / (nm < middle ? below : above), 2));
    };
    const double x = lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2);
    const double y = lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1);
    const double z = lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8);
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

/// Of one wavelength: the amplitudes of all that goes to and fro, added up term by term.
double interfering(double cosine, double film, double base, double turns) {
    const double sine = std::sqrt(1 - cosine * cosine);
    const double in_film = std::sqrt(1 - std::pow(sine / film, 2)), in_base = std::sqrt(1 - std::pow(sine / base, 2));
    double mean = 0;
    for (const bool parallel : {false, true}) {
        const auto amplitude = [&](double n1, double c1, double n2, double c2) {
            return parallel ? (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2) : (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
        };
        const double top = amplitude(1, cosine, film, in_film), bottom = amplitude(film, in_film, base, in_base);
        const Complex round_trip = std::polar(bottom, 2 * kPi * turns * in_film);
        Complex sum = top, order = (1 - top * top) * round_trip;  // t12 t21 = 1 - r12²
        for (int i = 0; i < 400 && std::abs(order) > 1e-9; i++) {
            sum += order;
            order *= -top * round_trip;
        }
        mean += std::norm(sum) / 2;
    }
    return mean;
}

struct Film {
    double index, thickness;  ///< nm
};

/// On something with an index for each channel.
glm::dvec3 film_reflectance(const Film& film, const glm::dvec3& base, double cosine) {
    glm::dvec3 sum(0), all(0);
    for (double nm = 380; nm <= 780; nm += 0.5) {
        const glm::dvec3 weight = sensitivity(nm);
        for (int k = 0; k < 3; k++)
            sum[k] += weight[k] * interfering(cosine, film.index, base[k], 2 * film.index * film.thickness / nm);
        all += weight;
    }
    return glm::clamp(sum / all, 0.0, 1.0);
}

glm::dvec3 index_of(const glm::dvec3& f0) {
    const glm::dvec3 root = glm::sqrt(glm::min(f0, 0.9999));
    return (1.0 + root) / (1.0 - root);
}

Material filmed(Material m, const Film& film, float share = 1) {
    m.iridescence = share;
    m.film_ior = float(film.index);
    m.film_least = 0;
    m.film_most = float(film.thickness);
    return m;
}

Material black_dielectric(float ior = 1.5f) {
    Material m = lambert({0, 0, 0});
    m.ior = ior;
    m.roughness = 0;
    return m;
}

const std::vector<Film> kFilms = {{1.3, 400}, {1, 400}, {1.33, 0}, {1.8, 150}, {2.4, 350}, {1.5, 900}};

class FilmOnTest : public FilmTest {
  protected:
    glm::dvec3 seen(const Material& m, double cosine, const Environment& environment, uint32_t spp = 1) {
        Stage stage;
        stage.add(texture_square(), m);
        RenderSettings settings = settings_for(slanted(cosine), 4);
        settings.spp = spp;
        return mean_radiance(render(stage, environment, settings));
    }
};

TEST_F(FilmOnTest, ReflectsByAirysSum) {
    const glm::dvec3 gold(1, 0.77, 0.34);
    Material stated = black_dielectric();
    stated.specular_color = {3, 1, 0.5f};
    for (const Film& film : kFilms)
        for (const double cosine : {1.0, 0.6, 0.2}) {
            SCOPED_TRACE(fmt::format("index {}, {} nm, cosine {}", film.index, film.thickness, cosine));
            const auto expect = [&](const Material& m, const glm::dvec3& base, const char* what) {
                const glm::dvec3 got = seen(filmed(m, film), cosine, white);
                const glm::dvec3 want = film_reflectance(film, base, cosine);
                EXPECT_TRUE(near(got, want, 4e-3)) << what << ": " << text(got) << ", expected " << text(want);
            };
            expect(black_dielectric(), glm::dvec3(1.5), "dielectric");
            expect(stated, index_of(0.04 * glm::dvec3(3, 1, 0.5)), "stated reflectance");
            expect(plane_mirror(glm::vec3(gold)), index_of(gold), "gold");
        }
}

TEST_F(FilmOnTest, CoversAShareOfTheSurface) {
    const Film film{1.8, 300};
    const glm::dvec3 want =
        0.25 * film_reflectance(film, glm::dvec3(1.5), 0.6) + 0.75 * glm::dvec3(fresnel(0.6, 1, 1.5));
    const glm::dvec3 got = seen(filmed(black_dielectric(), film, 0.25f), 0.6, white);
    EXPECT_TRUE(near(got, want, 2e-3)) << text(got) << ", expected " << text(want);
}

TEST_F(FilmOnTest, WhatItDoesNotReflectIsScatteredBelow) {
    // Of white light by the channel of which most is mirrored, as everywhere.
    const Film film{2, 300};
    const glm::dvec3 film_share = film_reflectance(film, glm::dvec3(1.5), 0.6);
    Material m = black_dielectric();
    m.base_color = glm::vec3(0.5f);
    const double most = std::max({film_share.x, film_share.y, film_share.z});
    const glm::dvec3 want = film_share + 0.5 * (1 - most), got = seen(filmed(m, film), 0.6, white);
    EXPECT_TRUE(near(got, want, 4e-3)) << text(got) << ", expected " << text(want);
}

TEST_F(FilmOnTest, RoughOnesReflectItsShareOfTheLobe) {
    // One sample: the film's at the angle at which Schlick's formula has its mean, times what the lobe keeps, and what
    // compensation makes of it.
    const Film film{1.8, 400};
    const glm::dvec3 copper(0.95, 0.64, 0.54);
    const double cosine = 0.6, roughness = 0.5;
    const double kept = ggx_mean(cosine, roughness, [](double) { return 1; });
    const double grazing = ggx_mean(cosine, roughness, [](double c) { return std::pow(1 - c, 5); });
    Material m = filmed(metal("copper", glm::vec3(copper)), film);
    m.roughness = float(roughness);
    const glm::dvec3 share = film_reflectance(film, index_of(copper), 1 - std::pow(grazing / kept, 0.2));
    const glm::dvec3 want = share * kept * (1.0 + share * (1 - kept) / kept), got = seen(m, cosine, white);
    EXPECT_TRUE(near(got, want, 4e-3)) << text(got) << ", expected " << text(want);
}

TEST_F(FilmOnTest, SamplesAreMirroredAtTheMicrofacetsAngle) {
    const Film film{1.8, 300};
    const double roughness = 0.4;
    Material m = filmed(black_dielectric(), film);
    m.roughness = float(roughness);
    std::vector<glm::dvec3> steps;
    for (int i = 0; i <= 64; i++) steps.push_back(film_reflectance(film, glm::dvec3(1.5), i / 64.0));
    for (const double cosine : {0.9, 0.4}) {
        glm::dvec3 want;
        for (int k = 0; k < 3; k++)
            want[k] = ggx_mean(cosine, roughness, [&](double c) {
                const size_t lower = std::min(size_t(c * 64), size_t(63));
                return glm::mix(steps[lower][k], steps[lower + 1][k], c * 64 - double(lower));
            });
        Stage stage;
        stage.add(texture_square(), m);
        RenderSettings settings = settings_for(slanted(cosine), 8);
        settings.spp = 48;
        settings.energy_compensation = false;
        const glm::dvec3 got = mean_radiance(render(stage, white, settings));
        EXPECT_TRUE(near(got, want, 4e-3)) << cosine << ": " << text(got) << ", expected " << text(want);
    }
}

TEST_F(FilmOnTest, LampsAreMirroredAtTheMicrofacetsAngle) {
    const Film film{1.6, 350};
    const double roughness = 0.4, cosine = 0.8;
    const glm::dvec3 view = to_slanted(cosine), to_sun = glm::normalize(glm::dvec3(-0.8, 0.5, 1));
    const glm::dvec3 half = glm::normalize(view + to_sun);
    Stage stage;
    Material m = filmed(black_dielectric(1.8f), film);
    m.roughness = float(roughness);
    stage.add(texture_square(), m);
    stage.sun(-to_sun, glm::vec3(20));
    RenderSettings settings = settings_for(slanted(cosine), 4);
    settings.energy_compensation = false;
    const glm::dvec3 got = mean_radiance(render(stage, black, settings));
    const glm::dvec3 want =
        20 * ggx_lobe(view, to_sun, roughness) * film_reflectance(film, glm::dvec3(1.8), glm::dot(view, half));
    EXPECT_TRUE(near(got, want, 4e-3)) << text(got) << ", expected " << text(want);
}

TEST_F(FilmTest, ThinGlassHasOneOnBothFaces) {
    const Film film{1.4, 450};
    for (const double cosine : {1.0, 0.5}) {
        Stage stage;
        stage.add(texture_square(), filmed(thin_glass(), film));
        stage.add(parallelogram({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}), unlit({0.3f, 0.3f, 0.3f}));
        const Camera camera = slanted(cosine);
        const glm::dvec3 face = film_reflectance(film, glm::dvec3(1.5), cosine), wall = 2.0 * face / (1.0 + face);
        tally(render(stage, white, settings_for(camera, 8)), camera, 4e-3, [&](const ViewRay&) {
            return wall + (1.0 - wall) * double(0.3f);
        }).expect(0, 64);
    }
}

TEST_F(FilmTest, VolumesHaveItInsideAsWell) {
    // A slab before a backdrop: with all that goes to and fro inside, (1 - R) / (1 + R) comes through, R from either
    // side.
    const Film film{1.9, 350};
    for (const double cosine : {1.0, 0.6}) {
        Stage stage;
        stage.add(box({-5, -5, -0.2f}, {5, 5, 0}), filmed(clear_glass(), film));
        stage.add(parallelogram({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}), unlit({1, 1, 1}));
        const Camera camera = slanted(cosine);
        RenderSettings settings = settings_for(camera, 8);
        settings.bounces = 12;
        const glm::dvec3 face = film_reflectance(film, glm::dvec3(1.5), cosine);
        tally(render(stage, black, settings), camera, 6e-3, [&](const ViewRay&) {
            return (1.0 - face) / (1.0 + face);
        }).expect(0, 64);
    }
}

TEST_F(FilmTest, BetweenTwoMediaThereIsNone) {
    // Liquid on glass that has a film on all of its sides; what is reflected is lost in the dark.
    const Film film{1.9, 350};
    const double cosine = 0.7, sine = std::sqrt(1 - cosine * cosine);
    Stage stage;
    stage.add(box({-5, -5, 0}, {5, 5, 0.3f}), clear_glass(1.33f));
    stage.add(box({-5, -5, -0.2f}, {5, 5, 0}), filmed(clear_glass(), film));
    stage.add(parallelogram({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}), unlit({1, 1, 1}));
    const Camera camera = slanted(cosine);
    RenderSettings settings = settings_for(camera, 8);
    settings.reflection = false;
    const double in_liquid = std::sqrt(1 - std::pow(sine / 1.33, 2));
    const glm::dvec3 want = (1 - fresnel(cosine, 1, 1.33)) * (1 - fresnel(in_liquid, 1.33, 1.5)) *
                            (1.0 - film_reflectance(film, glm::dvec3(1.5), cosine));
    tally(render(stage, black, settings), camera, 4e-3, [&](const ViewRay&) { return want; }).expect(0, 64);
}

TEST_F(FilmTest, NothingIsLostOrMadeUp) {
    for (Material m : {clear_glass(), thin_glass()}) {
        Stage stage;
        stage.add(sphere({0, 0, 0}, 1, 24), filmed(m, {1.7, 380}));
        RenderSettings settings = settings_for(perspective({0.5f, 0.7f, 3}, {0, 0, 0}, 45), 32);
        settings.bounces = 8;
        const RenderResult picture = render(stage, white, settings);
        for (const glm::vec4& p : picture.radiance) EXPECT_TRUE(near(glm::dvec3(p), glm::dvec3(1), 0.01));
    }
}

TEST_F(FilmTest, TexturesSayWhereAndHowThick) {
    // Red: the share; green: between the least and the most thickness.
    Stage stage;
    Material m = filmed(black_dielectric(), {1.6, 500});
    m.film_least = 100;
    m.iridescence_texture = 0;
    m.film_thickness_texture = 0;
    m.film_thickness_texture.channel = 1;
    stage.scene.textures = {two_texels({255, 0, 0}, {102, 153, 0})};
    stage.add(texture_square(), m);
    const Camera camera = orthographic({0, 0, 4}, {0, 0, 0}, 1.8f);
    const glm::dvec3 base(1.5);
    tally(
        render(stage, white, settings_for(camera, 16)), camera, 3e-3,
        left_and_right(film_reflectance({1.6, 100}, base, 1), 0.6 * 0.04 + 0.4 * film_reflectance({1.6, 340}, base, 1)))
        .expect(0, 200);
}

}  // namespace
}  // namespace peelray
