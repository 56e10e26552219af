// Media in layers before a backdrop, which are normal to z, in closed form.
#pragma once

#include <scenes.h>

namespace peelray {

/// The backdrop's light: a gradient, so that a ray that is shifted sees another value.
inline glm::dvec3 wall_light(const glm::dvec3& p) {
    return {1 + 0.2 * p.x, 1 - 0.2 * p.y, 1 + 0.1 * (p.x + p.y)};
}

inline void add_lit_wall(Stage& stage) {
    stage.add(gradient_quad({-6, -6, -2}, {12, 0, 0}, {0, 12, 0}, [](glm::vec3 p) { return glm::vec3(wall_light(p)); }),
              unlit({1, 1, 1}));
}

/// What is below a plane normal to z.
struct Layer {
    double z, ior;
    glm::dvec3 absorption{0};
};

/// What a ray towards -z that starts in `medium` sees of the backdrop through layers, by Snell's law, Fresnel and
/// Beer-Lambert; `more`: a bound on what is reflected to and fro in them.
struct Seen {
    glm::dvec3 light;
    double more = 0;
    bool off = false;  ///< beside the part of the backdrop where no colour is negative
};
inline Seen through(const ViewRay& ray, const std::vector<Layer>& layers, Layer medium = {0, 1}) {
    const glm::dvec2 tangential = glm::dvec2(ray.direction) * medium.ior;  // times the index: the same everywhere
    const double sine = glm::length(tangential);
    const auto cosine = [&](double ior) { return std::sqrt(1 - sine * sine / (ior * ior)); };
    Seen seen{glm::dvec3(1)};
    glm::dvec3 at = ray.origin;
    double reflected = 0;
    const auto advance = [&](double z) {
        const double length = (at.z - z) / cosine(medium.ior);
        at += glm::dvec3(tangential / medium.ior, -cosine(medium.ior)) * length;
        seen.light *= glm::exp(-medium.absorption * length);
    };
    for (const Layer& layer : layers) {
        advance(layer.z);
        const double r = fresnel(cosine(medium.ior), medium.ior, layer.ior);
        seen.light *= 1 - r;
        seen.more += r * reflected * 2;
        reflected += r;
        medium = layer;
    }
    advance(-2);
    seen.light *= wall_light(at);
    seen.off = std::abs(at.x) > 4.9 || std::abs(at.y) > 4.9;
    return seen;
}

/// Compares from both sides: what is reflected to and fro may only add, at most its bound of light as bright as
/// `brightness`. `start`: what the camera is in.
inline Tally tally_layers(const Picture& picture, const Camera& camera, const std::vector<Layer>& layers,
                          const Layer& start = {0, 1}, double brightness = 2, double tolerance = 2e-3) {
    Tally result;
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++) {
            const ViewRay ray = view_ray(camera, picture.width, picture.height, x + 0.5, y + 0.5);
            const Seen seen = through(ray, layers, start);
            if (seen.off) continue;
            const glm::dvec3 got = radiance_at(picture, x, y);
            const double more = seen.more * brightness;
            bool right = true;
            for (int c = 0; c < 3; c++)
                right &= got[c] >= seen.light[c] - tolerance && got[c] <= seen.light[c] + more + tolerance;
            result.add(right, [&] {
                return fmt::format("pixel {},{}: {}, expected {} to {:.5f} more", x, y, text(got), text(seen.light),
                                   more);
            });
        }
    return result;
}

inline Primitive plate(float front, float back, float half = 4) {
    return box({-half, -half, back}, {half, half, front});
}

}  // namespace peelray
