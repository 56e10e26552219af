#include "builtin/shapes.h"

#include <cmath>
#include <numbers>

namespace peelray {

uint32_t SceneBuilder::material(Material material) {
    scene_.materials.push_back(std::move(material));
    return static_cast<uint32_t>(scene_.materials.size() - 1);
}

int SceneBuilder::add(const char* name, Primitive shape, uint32_t material, const glm::mat4& transform) {
    shape.material = material;
    Mesh mesh{name, {}};
    mesh.primitives.push_back(std::move(shape));
    scene_.meshes.push_back(std::move(mesh));
    return again(name, static_cast<int>(scene_.meshes.size()) - 1, transform);
}

int SceneBuilder::again(const char* name, int mesh, const glm::mat4& transform) {
    Node node;
    node.name = name;
    node.local = transform;
    node.mesh = mesh;
    scene_.nodes.push_back(std::move(node));
    return static_cast<int>(scene_.nodes.size()) - 1;
}

int SceneBuilder::tiles(uint32_t n, uint32_t first, uint32_t second, bool both_directions) {
    // Several texels per tile: bilinear filtering then blurs only a thin seam between two tiles.
    constexpr uint32_t texels = 32;
    Texture texture;
    texture.name = "tiles";
    texture.width = texture.height = n * texels;
    texture.texels.reserve(size_t(texture.width) * texture.height);
    for (uint32_t y = 0; y < texture.height; ++y)
        for (uint32_t x = 0; x < texture.width; ++x) {
            const bool odd = (x / texels + (both_directions ? y / texels : 0)) % 2;
            texture.texels.push_back(0xFF000000u | (odd ? second : first));
        }
    return this->texture(std::move(texture));
}

int SceneBuilder::texture(Texture texture) {
    scene_.textures.push_back(std::move(texture));
    return static_cast<int>(scene_.textures.size()) - 1;
}

void SceneBuilder::light(Light light) {
    scene_.lights.push_back(std::move(light));
}

void SceneBuilder::camera(const glm::vec3& eye, const glm::vec3& look, float vertical_degrees) {
    Camera camera;
    camera.name = "default";
    camera.number = uint32_t(scene_.cameras.size());
    camera.eye = eye;
    camera.look = look;
    camera.vertical_fov = glm::radians(vertical_degrees);
    scene_.cameras.push_back(camera);
}

Material matte(const char* name, const glm::vec3& color) {
    Material out;
    out.name = name;
    out.base_color = color;
    out.roughness = 0.9f;
    return out;
}

Material metal(const char* name, const glm::vec3& color) {
    Material out;
    out.name = name;
    out.base_color = color;
    out.metallic = 1;
    out.roughness = 0;
    return out;
}

Material glass(const char* name, const glm::vec3& tint, float thickness, float distance) {
    Material out;
    out.name = name;
    out.roughness = 0;
    out.transmission = 1;
    out.thickness = thickness;
    out.attenuation_color = tint;
    out.attenuation_distance = distance;
    return out;
}

Primitive sphere(const glm::vec3& center, float radius, uint32_t n) {
    Primitive out;
    // Equal angles instead of equal lengths on the cube: squares of nearly equal size on the sphere. Exactly symmetric,
    // so that neighbouring faces meet in the same points and the body is closed.
    std::vector<float> spread(n + 1, 0.f);
    for (uint32_t k = 0; 2 * k < n; ++k) {
        const float angle = std::numbers::pi_v<float> / 4 * (1 - 2 * static_cast<float>(k) / static_cast<float>(n));
        spread[n - k] = k == 0 ? 1.f : std::tan(angle);
        spread[k] = -spread[n - k];
    }
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const float side = face % 2 ? -1.f : 1.f;
        const auto first = static_cast<uint32_t>(out.positions.size());
        for (uint32_t j = 0; j <= n; ++j)
            for (uint32_t i = 0; i <= n; ++i) {
                glm::vec3 direction;
                direction[axis] = side;
                direction[(axis + 1) % 3] = side * spread[i];
                direction[(axis + 2) % 3] = spread[j];
                direction = glm::normalize(direction);
                out.normals.push_back(direction);
                out.positions.push_back(center + radius * direction);
            }
        for (uint32_t j = 0; j < n; ++j)
            for (uint32_t i = 0; i < n; ++i) {
                const uint32_t a = first + j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
                out.triangles.push_back({a, b, d});
                out.triangles.push_back({a, d, c});
            }
    }
    return out;
}

Primitive torus(const glm::vec3& center, float ring_radius, float tube_radius, uint32_t ring_segments,
                uint32_t tube_segments) {
    Primitive out;
    constexpr float turn = 2 * std::numbers::pi_v<float>;
    for (uint32_t i = 0; i < ring_segments; ++i)
        for (uint32_t j = 0; j < tube_segments; ++j) {
            const float a = turn * static_cast<float>(i) / static_cast<float>(ring_segments),
                        b = turn * static_cast<float>(j) / static_cast<float>(tube_segments);
            const glm::vec3 outwards(std::cos(a), 0, std::sin(a));
            const glm::vec3 normal = outwards * std::cos(b) + glm::vec3(0, std::sin(b), 0);
            out.normals.push_back(glm::normalize(normal));
            out.positions.push_back(center + ring_radius * outwards + tube_radius * normal);
            const uint32_t next_i = (i + 1) % ring_segments, next_j = (j + 1) % tube_segments;
            const uint32_t p = i * tube_segments + j, q = i * tube_segments + next_j, r = next_i * tube_segments + j,
                           s = next_i * tube_segments + next_j;
            out.triangles.push_back({p, q, s});
            out.triangles.push_back({p, s, r});
        }
    return out;
}

Primitive parallelogram(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, float repeat) {
    Primitive out;
    out.positions = {corner, corner + u, corner + u + v, corner + v};
    out.normals.assign(4, glm::normalize(glm::cross(u, v)));
    out.uvs = {{0, 0}, {repeat, 0}, {repeat, repeat}, {0, repeat}};
    out.triangles = {{0, 1, 2}, {0, 2, 3}};
    return out;
}

Primitive box(const glm::vec3& lower, const glm::vec3& upper) {
    Primitive out;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        glm::vec3 u{0}, v{0};
        u[(axis + 1) % 3] = upper[(axis + 1) % 3] - lower[(axis + 1) % 3];
        v[(axis + 2) % 3] = upper[(axis + 2) % 3] - lower[(axis + 2) % 3];
        glm::vec3 corner = lower;
        if (face % 2)
            corner[axis] = upper[axis];
        else
            std::swap(u, v);
        const Primitive side = parallelogram(corner, u, v);
        const auto first = static_cast<uint32_t>(out.positions.size());
        out.positions.insert(out.positions.end(), side.positions.begin(), side.positions.end());
        out.normals.insert(out.normals.end(), side.normals.begin(), side.normals.end());
        out.uvs.insert(out.uvs.end(), side.uvs.begin(), side.uvs.end());
        for (const glm::uvec3& t : side.triangles) out.triangles.push_back(t + first);
    }
    return out;
}

glm::vec3 any_perpendicular(const glm::vec3& v) {
    return glm::normalize(glm::cross(v, std::abs(v.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
}

void add_tube(Primitive& out, const glm::vec3& from, const glm::vec3& to, float from_radius, float to_radius,
              uint32_t sides) {
    const glm::vec3 axis = glm::normalize(to - from), x = any_perpendicular(axis), y = glm::cross(axis, x);
    const float taper = (from_radius - to_radius) / glm::length(to - from);
    const auto first = static_cast<uint32_t>(out.positions.size());
    for (uint32_t i = 0; i < sides; ++i) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
        const glm::vec3 outwards = std::cos(angle) * x + std::sin(angle) * y;
        const glm::vec3 normal = glm::normalize(outwards + axis * taper);
        out.positions.insert(out.positions.end(), {from + outwards * from_radius, to + outwards * to_radius});
        out.normals.insert(out.normals.end(), {normal, normal});
        const uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % sides);
        out.triangles.push_back({a, b, b + 1});
        out.triangles.push_back({a, b + 1, a + 1});
    }
}

float Random::next() {
    // splitmix64
    uint64_t z = state_ += 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<float>((z ^ (z >> 31)) >> 40) * 0x1p-24f;
}

}  // namespace peelray
