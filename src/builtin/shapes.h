// Shapes and small helpers that the built-in scenes are made of. All shapes have unit normals and front faces outwards.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "scene/scene.h"

namespace peelray {

Scene make_teapots();
Scene make_glass();
Scene make_tree();
Scene make_leaves();
Scene make_room();
Scene make_walker();
Scene make_blob(uint64_t triangles);
Scene make_waves(uint64_t triangles);
Scene make_particles(uint64_t count);
Scene make_desk();
Scene make_kitchen(uint64_t triangles);
Scene make_bricks(uint64_t triangles);
Scene make_cloth(uint64_t triangles);

/// Collects a scene: one node with one mesh of one primitive per object.
class SceneBuilder {
  public:
    explicit SceneBuilder(const char* name) {
        scene_.name = name;
        scene_.outdoors = true;
    }

    uint32_t material(Material material);
    /// Returns the index of the node.
    int add(const char* name, Primitive shape, uint32_t material, const glm::mat4& transform = glm::mat4(1));
    /// A mesh once more.
    int again(const char* name, int mesh, const glm::mat4& transform);
    int mesh_of(int node) const { return scene_.nodes[size_t(node)].mesh; }
    /// A texture of n×n tiles in two sRGB colours (0xBBGGRR), alternating in u, or in u and v.
    int tiles(uint32_t n, uint32_t first, uint32_t second, bool both_directions);
    int texture(Texture texture);
    void camera(const glm::vec3& eye, const glm::vec3& look, float vertical_degrees);
    void light(Light light);
    Scene take() { return std::move(scene_); }

  private:
    Scene scene_;
};

Material matte(const char* name, const glm::vec3& color);
Material metal(const char* name, const glm::vec3& color);
/// `thickness`: 0 for thin sheets; `tint`: what is left of white after so much `distance` inside.
Material glass(const char* name, const glm::vec3& tint, float thickness, float distance);

/// A sphere as a subdivided cube (no poles, no slivers) with n×n squares per side.
Primitive sphere(const glm::vec3& center, float radius, uint32_t n);
/// A torus around the y axis.
Primitive torus(const glm::vec3& center, float ring_radius, float tube_radius, uint32_t ring_segments,
                uint32_t tube_segments);
/// A box with sharp edges.
Primitive box(const glm::vec3& lower, const glm::vec3& upper);
/// Two triangles: corner, corner + u, corner + u + v, corner + v; front towards u × v; uv from 0 to `repeat`.
Primitive parallelogram(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, float repeat = 1);
/// Newell's teapot: 32 bicubic patches, n×n squares each; y up, 3.15 high, standing on y = 0, the spout towards +x.
Primitive teapot(uint32_t n);

glm::vec3 any_perpendicular(const glm::vec3& v);
/// Adds a tapered tube, open at its ends, with as many sides.
void add_tube(Primitive& out, const glm::vec3& from, const glm::vec3& to, float from_radius, float to_radius,
              uint32_t sides);

/// A small deterministic generator (the same numbers on every machine, unlike the standard distributions).
class Random {
  public:
    explicit Random(uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ull + 1) {}
    /// Uniform in [0, 1).
    float next();
    float between(float low, float high) { return low + (high - low) * next(); }

  private:
    uint64_t state_;
};

}  // namespace peelray
