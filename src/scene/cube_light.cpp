#include "scene/cube_light.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scene/environment.h"
#include "scene/sampling.h"

namespace peelray {
namespace {

/// Where a face's picture lies: a point of it is `ahead` + a · `right` + b · `down`, a and b in [-1, 1].
struct Face {
    glm::dvec3 ahead, right, down;
};

constexpr Face kFaces[6] = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                            {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},  {{0, -1, 0}, {-1, 0, 0}, {0, 0, -1}},
                            {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}};

/// A point of a face, in texels from its top left.
struct Place {
    size_t face;
    glm::dvec2 texels;
};

Place place_of(const glm::dvec3& d, uint32_t size) {
    const glm::dvec3 a = glm::abs(d);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const size_t face = size_t(2 * axis + (d[axis] < 0));
    const glm::dvec3 on = d / a[axis];
    const glm::dvec2 sides(glm::dot(on, kFaces[face].right), glm::dot(on, kFaces[face].down));
    return {face, 0.5 * double(size) * (sides + 1.0)};
}

/// A texel of a face; beside it lie those of its neighbours, so that there are no seams.
glm::dvec3 texel(const CubeLight& light, size_t face, int x, int y) {
    const int size = int(light.size);
    if (std::clamp(x, 0, size - 1) == x && std::clamp(y, 0, size - 1) == y)
        return light.faces[face][size_t(y) * light.size + size_t(x)];
    const glm::dvec2 sides = 2.0 * (glm::dvec2(x, y) + 0.5) / double(size) - 1.0;
    const Face& f = kFaces[face];
    const Place beside = place_of(f.ahead + sides.x * f.right + sides.y * f.down, light.size);
    const glm::ivec2 at = glm::clamp(glm::ivec2(beside.texels), 0, size - 1);
    return light.faces[beside.face][size_t(at.y) * light.size + size_t(at.x)];
}

glm::dvec3 radiance(const CubeLight& light, const glm::dvec3& d) {
    const Place place = place_of(d, light.size);
    return bilinear(place.texels, [&](int x, int y) { return texel(light, place.face, x, y); });
}

}  // namespace

Environment cube_environment(const CubeLight& light) {
    // As fine at the horizon as a face is on the mean; few texels would show instead of the cube's.
    const uint32_t height = std::clamp(2 * light.size, 32u, 4096u), width = 2 * height;
    constexpr uint32_t samples = 2;  // along a side of a texel
    const glm::dmat3 back = glm::transpose(light.turn);
    std::vector<glm::vec4> pixels(size_t(width) * height);
    parallel_for(height, 4, [&](size_t y) {
        for (uint32_t x = 0; x < width; x++) {
            glm::dvec3 sum(0);
            for (uint32_t i = 0; i < samples * samples; i++) {
                const float u = (float(x) + (float(i % samples) + 0.5f) / samples) / float(width);
                const float v = (float(y) + (float(i / samples) + 0.5f) / samples) / float(height);
                sum += radiance(light, back * glm::dvec3(environment_direction(u, v)));
            }
            pixels[y * width + x] = glm::vec4(glm::vec3(sum / double(samples * samples)), 1);
        }
    });
    Environment environment = image_environment(width, height, std::move(pixels));
    scale(environment, light.intensity);
    return environment;
}

}  // namespace peelray
