// What the tests of pictures share, whoever renders them: scenes built in code, textbook camera rays, and comparisons
// in linear radiance. Free of the GPU.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "builtin/shapes.h"
#include "scene/environment.h"
#include "scene/picture.h"
#include "statistics/ggx_mean.h"

namespace peelray {

constexpr double kPi = std::numbers::pi;

/// A scene in the making: every shape gets its own material.
struct Stage {
    Scene scene;

    Stage() { scene.name = "test"; }
    void add(Primitive shape, const Material& material) {
        scene.materials.push_back(material);
        shape.material = uint32_t(scene.materials.size() - 1);
        Node node;
        node.mesh = int(scene.meshes.size());
        scene.meshes.push_back({"shape", {std::move(shape)}});
        scene.nodes.push_back(node);
    }
    void sun(const glm::vec3& direction, const glm::vec3& color = glm::vec3(1)) {
        Light light;
        light.direction = glm::normalize(direction);
        light.color = color;
        scene.lights.push_back(light);
    }
    Light& lamp(const glm::vec3& position, const glm::vec3& color) {
        Light light;
        light.kind = Light::Kind::point;
        light.position = position;
        light.color = color;
        scene.lights.push_back(light);
        return scene.lights.back();
    }
};

// --- Materials whose light is known exactly ---

inline Material unlit(const glm::vec3& color) {
    Material m;
    m.base_color = color;
    m.unlit = true;
    return m;
}
/// Lambert without any specular part: an index of 1 does not reflect.
inline Material lambert(const glm::vec3& color) {
    Material m;
    m.base_color = color;
    m.ior = 1;
    return m;
}
inline Material plane_mirror(const glm::vec3& tint = glm::vec3(1)) {
    return metal("mirror", tint);
}
inline Material clear_glass(float ior = 1.5f) {
    Material m;
    m.roughness = 0;
    m.transmission = 1;
    m.ior = ior;
    m.thickness = 1;
    return m;
}
inline Material thin_glass(float ior = 1.5f) {
    Material m = clear_glass(ior);
    m.thickness = 0;
    return m;
}
/// Reflects nothing.
inline Material emitting(const glm::vec3& light) {
    Material m = lambert({0, 0, 0});
    m.emissive = light;
    return m;
}

// --- Holes ---

/// Texels along a side of the pattern of holes.
constexpr uint32_t kTexels = 8;

/// Is the texel of the pattern there?
inline bool is_whole(int x, int y) {
    return (x * 5 + y * 3) % 7 < 4;
}

/// A texture of kTexels² texels whose alpha is 255 or 0.
inline Texture pattern() {
    Texture texture;
    texture.width = texture.height = kTexels;
    texture.nearest = true;
    for (int y = 0; y < int(kTexels); y++)
        for (int x = 0; x < int(kTexels); x++) texture.texels.push_back(is_whole(x, y) ? 0xFFFFFFFFu : 0x00FFFFFFu);
    return texture;
}

inline Material masked(Stage& stage, Material material) {
    if (stage.scene.textures.empty()) stage.scene.textures.push_back(pattern());
    material.base_color_texture = 0;
    material.alpha_cutoff = 0.5f;
    return material;
}

/// Is the pattern there at uv, repeated? Nothing within a hair of a texel's edge.
inline std::optional<bool> whole_at(const glm::dvec2& uv, double margin = 1e-3) {
    const glm::dvec2 p = uv * double(kTexels), f = glm::fract(p);
    if (std::min({f.x, f.y, 1 - f.x, 1 - f.y}) < margin) return {};
    const auto wrapped = [](double x) { return ((int(std::floor(x)) % int(kTexels)) + int(kTexels)) % int(kTexels); };
    return is_whole(wrapped(p.x), wrapped(p.y));
}

// --- Textures ---

struct Rgba {
    uint8_t r, g, b, a = 255;
};

/// Two texels side by side, each sharply.
inline Texture two_texels(Rgba left, Rgba right) {
    Texture t;
    t.width = 2;
    t.height = 1;
    for (const Rgba& c : {left, right}) t.texels.push_back(uint32_t(c.r | c.g << 8 | c.b << 16) | uint32_t(c.a) << 24);
    t.nearest = true;
    return t;
}

// --- Shapes ---

/// Flat faces, each a convex polygon, counter-clockwise from outside.
inline Primitive faces(const std::vector<std::vector<glm::vec3>>& polygons) {
    Primitive out;
    for (const auto& polygon : polygons) {
        const uint32_t first = uint32_t(out.positions.size());
        const glm::vec3 normal = glm::normalize(glm::cross(polygon[1] - polygon[0], polygon[2] - polygon[0]));
        out.positions.insert(out.positions.end(), polygon.begin(), polygon.end());
        out.normals.insert(out.normals.end(), polygon.size(), normal);
        for (uint32_t i = 2; i < polygon.size(); i++) out.triangles.push_back({first, first + i - 1, first + i});
    }
    return out;
}

/// A horizontal disc that faces up.
inline Primitive disc(const glm::vec3& centre, float radius, uint32_t corners = 256) {
    std::vector<glm::vec3> rim;
    for (uint32_t i = 0; i < corners; i++) {
        const double a = -2 * kPi * i / corners;
        rim.push_back(centre + radius * glm::vec3(std::cos(a), 0, std::sin(a)));
    }
    return faces({rim});
}

/// Whether a point of a horizontal plane is above, in or below a disc.
inline bool in_disc(const glm::dvec3& p, const glm::dvec3& centre, double radius) {
    return glm::length(glm::dvec2(p.x - centre.x, p.z - centre.z)) < radius;
}

/// The square |x|, |z| ≤ half at height y, facing up.
inline Primitive ground(float half, float y = 0) {
    return parallelogram({-half, y, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
}

/// Adds an unlit quad corner, u, v whose colour at p is c0 + dot(p, gradient) in every channel's own gradient.
inline Primitive gradient_quad(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
                               const std::function<glm::vec3(glm::vec3)>& color) {
    Primitive quad = parallelogram(corner, u, v);
    for (const glm::vec3& p : quad.positions) quad.colors.push_back(glm::vec4(color(p), 1));
    return quad;
}

inline Primitive turned(Primitive shape, float degrees, const glm::vec3& axis) {
    const glm::quat q = glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
    for (auto& p : shape.positions) p = q * p;
    for (auto& n : shape.normals) n = q * n;
    return shape;
}

/// Faces the other way.
inline Primitive inside_out(Primitive shape) {
    for (auto& n : shape.normals) n = -n;
    for (auto& t : shape.triangles) std::swap(t.y, t.z);
    return shape;
}

/// Positions, normals and triangles of both.
inline Primitive joined(Primitive a, const Primitive& b) {
    const auto offset = uint32_t(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
    for (const glm::uvec3& t : b.triangles) a.triangles.push_back(t + offset);
    return a;
}

/// The half of the cube from -1 to 1 where y < z: walls at z = 1 and y = -1, and the slanted one.
inline Primitive prism() {
    return faces({{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
                  {{-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1}},
                  {{-1, 1, 1}, {1, 1, 1}, {1, -1, -1}, {-1, -1, -1}},
                  {{1, -1, 1}, {1, -1, -1}, {1, 1, 1}},
                  {{-1, -1, 1}, {-1, 1, 1}, {-1, -1, -1}}});
}

/// The square |x|, |y| ≤ 1 at a depth, facing +z, u to the right, v downwards, from 0 to 1.
inline Primitive texture_square(float z = 0) {
    Primitive quad = faces({{{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}}});
    quad.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    return quad;
}

// --- Cameras ---

inline Camera perspective(const glm::vec3& eye, const glm::vec3& look, float degrees, const glm::vec3& up = {0, 1, 0}) {
    Camera c;
    c.eye = eye;
    c.look = look;
    c.up = up;
    c.vertical_fov = glm::radians(degrees);
    return c;
}
inline Camera orthographic(const glm::vec3& eye, const glm::vec3& look, float height, const glm::vec3& up = {0, 1, 0}) {
    Camera c = perspective(eye, look, 40, up);
    c.orthographic_height = height;
    return c;
}
/// Sees the middle of texture_square() at this cosine to its normal, from the right.
inline Camera slanted(double cosine) {
    return orthographic({float(4 * std::sqrt(1 - cosine * cosine)), 0, float(4 * cosine)}, {0, 0, 0}, 0.3f);
}
/// Where that viewer is.
inline glm::dvec3 to_slanted(double cosine) {
    return {std::sqrt(1 - cosine * cosine), 0, cosine};
}
/// Smith's masking of a direction at this cosine to a GGX surface.
inline double smith_masking(double cosine, double roughness) {
    return 2 / (1 + std::sqrt(1 + std::pow(roughness, 4) * (1 / (cosine * cosine) - 1)));
}
/// What GGX sends from a light to a viewer, times the cosine, without Fresnel; the normal is +z.
inline double ggx_lobe(const glm::dvec3& view, const glm::dvec3& to_light, double roughness) {
    const double a2 = std::pow(roughness, 4), h = glm::normalize(view + to_light).z, k = h * h * (a2 - 1) + 1;
    return a2 / (kPi * k * k) * smith_masking(view.z, roughness) * smith_masking(to_light.z, roughness) / (4 * view.z);
}
/// Sees `height` of the world around the origin from above; the picture's top is -z, its right +x.
inline Camera from_above(float height) {
    return orthographic({0, 8, 0}, {0, 0, 0}, height, {0, 0, -1});
}

struct ViewRay {
    glm::dvec3 origin, direction;
    glm::dvec3 at_plane(int axis, double value) const {
        return origin + direction * ((value - origin[axis]) / direction[axis]);
    }
};
/// The ray through picture position (x, y), pixels from the top left, in double and by the textbook.
inline ViewRay view_ray(const Camera& camera, uint32_t width, uint32_t height, double x, double y) {
    const glm::dvec3 eye = camera.eye, forward = glm::normalize(glm::dvec3(camera.look) - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up))),
                     up = glm::cross(right, forward);
    const bool flat = camera.orthographic_height > 0;
    const double half = flat ? camera.orthographic_height / 2 : std::tan(double(camera.vertical_fov) / 2);
    const double sx = (2 * x / width - 1) * half * width / height, sy = (1 - 2 * y / height) * half;
    if (flat) return {eye + right * sx + up * sy, forward};
    return {eye, glm::normalize(forward + right * sx + up * sy)};
}

/// What a pixel to the left and to the right of the middle shows.
inline std::function<std::optional<glm::dvec3>(const ViewRay&)> left_and_right(const glm::dvec3& left,
                                                                               const glm::dvec3& right) {
    return [=](const ViewRay& ray) -> std::optional<glm::dvec3> {
        if (std::abs(ray.origin.x) < 1e-3) return {};
        return ray.origin.x < 0 ? left : right;
    };
}

// --- An environment that tells directions: -z in the middle of the image, +x to the right of it, +y at the top ---

inline glm::dvec3 light_of(const glm::dvec3& direction) {
    return 0.5 + 0.4 * direction;
}
inline Environment direction_image(uint32_t width = 256) {
    std::vector<glm::vec4> pixels;
    for (uint32_t y = 0; y < width / 2; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double phi = ((x + 0.5) / width - 0.5) * 2 * kPi, theta = (y + 0.5) / (width / 2) * kPi;
            pixels.push_back(glm::vec4(glm::vec3(light_of({std::sin(theta) * std::sin(phi), std::cos(theta),
                                                           -std::sin(theta) * std::cos(phi)})),
                                       1));
        }
    return image_environment(width, width / 2, pixels);
}

// --- Optics in double ---

inline double fresnel(double cosine, double from, double to) {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)) * from / to;
    if (sine >= 1) return 1;
    const double cosine_t = std::sqrt(1 - sine * sine);
    const double s = (from * cosine - to * cosine_t) / (from * cosine + to * cosine_t);
    const double p = (from * cosine_t - to * cosine) / (from * cosine_t + to * cosine);
    return (s * s + p * p) / 2;
}

/// Schlick's reflectance, from f0 at normal incidence to f90 at grazing angles.
inline double schlick(double f0, double f90, double cosine) {
    return f0 + (f90 - f0) * std::pow(1 - cosine, 5);
}

// --- Comparison ---

inline std::string text(const glm::dvec3& v) {
    return fmt::format("({:.5f}, {:.5f}, {:.5f})", v.x, v.y, v.z);
}

/// Expects `of` compared pixels with at most `failing` of them wrong; the first few wrong ones are told.
struct Tally {
    size_t compared = 0, wrong = 0;
    std::string examples;
    void add(bool right, const std::function<std::string()>& example) {
        compared++;
        if (right) return;
        if (wrong++ < 4) examples += "\n  " + example();
    }
    void expect(double permitted_fraction, size_t at_least) const {
        EXPECT_GE(compared, at_least) << "too few pixels could be compared";
        EXPECT_LE(double(wrong), permitted_fraction * double(compared))
            << wrong << " of " << compared << " pixels are wrong:" << examples;
    }
};

inline glm::dvec3 radiance_at(const Picture& picture, uint32_t x, uint32_t y) {
    return glm::dvec3(picture.radiance[size_t(y) * picture.width + x]);
}
inline glm::dvec3 mean_radiance(const Picture& picture) {
    glm::dvec3 sum(0);
    for (const glm::vec4& p : picture.radiance) sum += glm::dvec3(p);
    return sum / double(picture.radiance.size());
}
inline bool near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}) <= tolerance;  // false for NaN
}

/// Compares every pixel for which `expected(ray)` knows an answer, absolutely.
inline Tally tally(const Picture& picture, const Camera& camera, double tolerance,
                   const std::function<std::optional<glm::dvec3>(const ViewRay&)>& expected) {
    Tally result;
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++) {
            const auto want = expected(view_ray(camera, picture.width, picture.height, x + 0.5, y + 0.5));
            if (!want) continue;
            const glm::dvec3 got = radiance_at(picture, x, y);
            result.add(near(got, *want, tolerance),
                       [&] { return fmt::format("pixel {},{}: {}, expected {}", x, y, text(got), text(*want)); });
        }
    return result;
}

inline Tally tally(const Picture& a, const Picture& b, double tolerance) {
    Tally result;
    for (uint32_t y = 0; y < a.height; y++)
        for (uint32_t x = 0; x < a.width; x++)
            result.add(near(radiance_at(a, x, y), radiance_at(b, x, y), tolerance), [&] {
                return fmt::format("pixel {},{}: {} and {}", x, y, text(radiance_at(a, x, y)),
                                   text(radiance_at(b, x, y)));
            });
    return result;
}

}  // namespace peelray
