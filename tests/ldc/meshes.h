// Triangles to build cubes of: soups of all that is awkward, and built-in scenes.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "loaders/load.h"
#include "scene/scene.h"

namespace peelray::test {

/// Triangles with their bounds.
struct Mesh3 {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    glm::vec3 lower{1e30f}, upper{-1e30f};

    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        const auto first = uint32_t(positions.size());
        for (const glm::vec3& p : {a, b, c}) {
            positions.push_back(p);
            if (!(glm::length(p) < 1e20f)) continue;  // NaN and infinite corners bound nothing
            lower = glm::min(lower, p);
            upper = glm::max(upper, p);
        }
        triangles.emplace_back(first, first + 1, first + 2);
    }
};

class Random {
  public:
    explicit Random(uint32_t seed) : generator_(seed) {}
    float uniform(float low, float high) { return low + (high - low) * (float(generator_() >> 8) / 16777216.0f); }
    glm::vec3 point(const glm::vec3& size) {
        const float x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
        return glm::vec3(x, y, z) * size;
    }
    uint32_t below(uint32_t n) { return uint32_t(generator_() % n); }

  private:
    std::mt19937 generator_;
};

/// Random triangles in a box of half-size `size`: big, tiny, needles, axis-aligned, coplanar duplicates and some
/// without area.
inline Mesh3 soup(uint32_t seed, uint32_t count, const glm::vec3& size, float voxel) {
    Random random(seed);
    Mesh3 mesh;
    mesh.add(-size, size, glm::vec3(-size.x, size.y, -size.z));  // fixes the bounds
    for (uint32_t i = 0; i < count; i++) {
        const glm::vec3 centre = random.point(size * 0.95f);
        const auto near = [&](float reach) { return glm::clamp(centre + random.point(glm::vec3(reach)), -size, size); };
        switch (i % 8) {
            case 0:
                mesh.add(random.point(size), random.point(size), random.point(size));
                break;
            case 1:
                mesh.add(near(voxel * 0.3f), near(voxel * 0.3f), near(voxel * 0.3f));
                break;
            case 2: {  // a needle, far longer than wide
                const glm::vec3 a = random.point(size), b = random.point(size), c = a + (b - a) * random.uniform(0, 1);
                mesh.add(a, b, glm::clamp(c + random.point(glm::vec3(voxel * 1e-3f)), -size, size));
                break;
            }
            case 3: {  // in a plane across an axis, often exactly between two voxels
                const int axis = int(random.below(3));
                glm::vec3 a = near(voxel * 9), b = near(voxel * 9), c = near(voxel * 9);
                a[axis] = b[axis] = c[axis] = i % 16 < 8 ? std::floor(a[axis] / voxel) * voxel : a[axis];
                mesh.add(a, b, c);
                break;
            }
            case 4: {  // the same triangle again, and turned over
                const glm::uvec3 last =
                    mesh.triangles[mesh.triangles.size() - 1 - random.below(3) % uint32_t(mesh.triangles.size())];
                const glm::vec3 a = mesh.positions[last.x], b = mesh.positions[last.y], c = mesh.positions[last.z];
                mesh.add(a, b, c);
                mesh.add(b, a, c);
                break;
            }
            case 5:
                mesh.add(near(voxel * 3), near(voxel * 3), near(voxel * 3));
                break;
            case 6: {
                const glm::vec3 a = near(voxel), b = near(voxel);
                mesh.add(a, i % 3 ? a : b, b);
                break;
            }
            case 7: {  // a diagonal normal: ties and the overlap band
                const float r = voxel * random.uniform(1, 12);
                const glm::vec3 s(random.below(2) ? r : -r, random.below(2) ? r : -r, random.below(2) ? r : -r);
                mesh.add(glm::clamp(centre + glm::vec3(s.x, 0, 0), -size, size),
                         glm::clamp(centre + glm::vec3(0, s.y * random.uniform(0.8f, 1.2f), 0), -size, size),
                         glm::clamp(centre + glm::vec3(0, 0, s.z), -size, size));
                break;
            }
        }
    }
    return mesh;
}

inline Mesh3 moved(Mesh3 mesh, const glm::vec3& by) {
    for (glm::vec3& p : mesh.positions) p += by;
    mesh.lower += by;
    mesh.upper += by;
    return mesh;
}

/// Two triangles from x = -1 to 1 and z = -1 to 1, rising by `tilt` along x.
inline Mesh3 tilted_floor(float tilt) {
    const glm::vec3 a(-1, -tilt, -1), b(1, tilt, -1), c(1, tilt, 1), d(-1, -tilt, 1);
    Mesh3 mesh;
    mesh.add(a, b, c);
    mesh.add(a, c, d);
    return mesh;
}

inline Mesh3 from_scene(const char* name) {
    const Geometry geometry = flatten(load_scene(name));
    return {geometry.positions, geometry.triangles, geometry.lower, geometry.upper};
}

/// Every triangle at a hundredth of its size, where it was; the bounds stay.
inline Mesh3 shrink(Mesh3 mesh) {
    for (size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
        const glm::vec3 centre = (mesh.positions[i] + mesh.positions[i + 1] + mesh.positions[i + 2]) / 3.0f;
        for (size_t k = i; k < i + 3; k++) mesh.positions[k] = centre + 0.01f * (mesh.positions[k] - centre);
    }
    return mesh;
}

}  // namespace peelray::test
