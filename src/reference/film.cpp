#include "reference/film.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "path/shading_numbers.h"
#include "reference/optics.h"

namespace peelray::inline PRECISION::film {
namespace {

constexpr int wavelengths = 401;
constexpr real shortest = 380, longest = 780;  // nm

real wavelength(int i) {
    return shortest + (longest - shortest) * i / (wavelengths - 1);
}

/// What of each wavelength's light counts for red, green and blue: the colour matching functions in the fit of Wyman,
/// Sloan and Shirley (JCGT 2013), as linear Rec. 709, so that white stays white.
struct Weights {
    std::array<Vec3, wavelengths> of;

    Weights() {
        const auto lobe = [](real x, real middle, real below, real above) {
            const real t = (x - middle) / (x < middle ? below : above);
            return std::exp(-t * t / 2);
        };
        const Vec3 red(3.2404542, -1.5371385, -0.4985314), green(-0.9692660, 1.8760108, 0.0415560),
            blue(0.0556434, -0.2040259, 1.0572252);
        Vec3 sum(0);
        for (int i = 0; i < wavelengths; i++) {
            const real l = wavelength(i);
            const Vec3 xyz(1.056 * lobe(l, 599.8, 37.9, 31.0) + 0.362 * lobe(l, 442.0, 16.0, 26.7) -
                               0.065 * lobe(l, 501.1, 20.4, 26.2),
                           0.821 * lobe(l, 568.8, 46.9, 40.5) + 0.286 * lobe(l, 530.9, 16.3, 31.1),
                           1.217 * lobe(l, 437.0, 11.8, 36.0) + 0.681 * lobe(l, 459.0, 26.0, 13.8));
            of[size_t(i)] = {glm::dot(red, xyz), glm::dot(green, xyz), glm::dot(blue, xyz)};
            if (i == 0 || i == wavelengths - 1) of[size_t(i)] /= 2;
            sum += of[size_t(i)];
        }
        for (Vec3& weight : of) weight /= sum;
    }
};

/// Amplitudes that an interface reflects, of light across the plane of incidence and in it.
struct Amplitudes {
    real s, p;
};
Amplitudes amplitudes(real index1, real cosine1, real index2, real cosine2) {
    return {(index1 * cosine1 - index2 * cosine2) / (index1 * cosine1 + index2 * cosine2),
            (index2 * cosine1 - index1 * cosine2) / (index2 * cosine1 + index1 * cosine2)};
}

/// Of two interfaces with all that goes to and fro between them; `phase`: cosine of what one round trip adds.
real interference(real first, real second, real phase) {
    const real both = 2 * first * second * phase, product = first * second;
    return (first * first + second * second + both) / (1 + product * product + both);
}

}  // namespace

Vec3 reflectance(real cosine, real index, real thickness, const Vec3& base) {
    static const Weights weights;
    cosine = std::max(cosine, GRAZING_COSINE);  // along the surface a film like air would be 0 over 0
    const real sine2 = 1 - cosine * cosine, cosine2 = std::sqrt(1 - sine2 / (index * index));
    const Amplitudes top = amplitudes(1, cosine, index, cosine2);
    Amplitudes bottom[3];
    for (int k = 0; k < 3; k++)
        bottom[k] = amplitudes(index, cosine2, base[k], std::sqrt(1 - sine2 / (base[k] * base[k])));
    const real way = 4 * optics::pi * index * thickness * cosine2;
    Vec3 sum(0);
    for (int i = 0; i < wavelengths; i++) {
        const real phase = std::cos(way / wavelength(i));
        for (int k = 0; k < 3; k++)
            sum[k] += weights.of[size_t(i)][k] *
                      (interference(top.s, bottom[k].s, phase) + interference(top.p, bottom[k].p, phase)) / 2;
    }
    return glm::clamp(sum, 0.0, 1.0);
}

Vec3 index_of(const Vec3& reflectance) {
    const Vec3 root = glm::sqrt(glm::clamp(reflectance, 0.0, FILM_MOST_REFLECTANCE));
    return (1.0 + root) / (1.0 - root);
}

}  // namespace peelray::inline PRECISION::film
