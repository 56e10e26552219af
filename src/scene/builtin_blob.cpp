// A displaced sphere of any number of triangles. The vertices lie on rings of constant height whose numbers of vertices
// follow the ring's length, so that triangles are of even size everywhere, the poles included; a mesh of rings with n_i
// vertices has exactly 2·Σ n_i triangles, which lets us meet every even number.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "scene/shapes.h"

namespace peelray {

namespace {

/// Smooth value noise in [-1, 1] on the integer lattice.
float noise(const glm::vec3& p, uint32_t seed) {
    const glm::vec3 cell = glm::floor(p), f = p - cell;
    const glm::vec3 t = f * f * f * (f * (f * 6.f - 15.f) + 10.f);
    const auto lattice = [&](int x, int y, int z) {
        uint32_t h = static_cast<uint32_t>(static_cast<int>(cell.x) + x) * 0x8DA6B343u ^
                     static_cast<uint32_t>(static_cast<int>(cell.y) + y) * 0xD8163841u ^
                     static_cast<uint32_t>(static_cast<int>(cell.z) + z) * 0xCB1AB31Fu ^ seed;
        h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
        h = (h ^ (h >> 12)) * 0x297A2D39u;
        return static_cast<float>(h >> 8) * 0x1p-23f - 1.f;
    };
    std::array<float, 4> x;
    for (int i = 0; i < 4; ++i)
        x[static_cast<size_t>(i)] = glm::mix(lattice(0, i & 1, i >> 1), lattice(1, i & 1, i >> 1), t.x);
    return glm::mix(glm::mix(x[0], x[1], t.y), glm::mix(x[2], x[3], t.y), t.z);
}

glm::vec3 displaced(const glm::vec3& direction) {
    float sum = 0, amplitude = 0.16f, frequency = 1.7f;
    for (uint32_t octave = 0; octave < 5; ++octave, amplitude *= 0.48f, frequency *= 2.03f)
        sum += amplitude * noise(direction * frequency + glm::vec3(11.3f), octave * 0x9E3779B9u);
    return direction * (0.72f * (1 + sum));
}

/// Vertices per ring, from the north pole to the south pole; their sum is `half`.
std::vector<uint32_t> ring_sizes(uint64_t half) {
    const double edge = std::sqrt(4 * 4 * std::numbers::pi / (2.0 * static_cast<double>(half) * std::sqrt(3.0)));
    const auto bands = static_cast<uint32_t>(std::clamp(std::round(std::numbers::pi / (edge * std::sqrt(3.0) / 2)), 2.0,
                                                        1.0 + static_cast<double>(half) / 3));
    std::vector<double> share(bands - 1);
    for (uint32_t i = 0; i < share.size(); ++i) share[i] = std::sin(std::numbers::pi * (i + 1) / bands);
    const double total = std::accumulate(share.begin(), share.end(), 0.0);
    std::vector<uint32_t> sizes(share.size());
    // Rounding the running sum instead of each ring keeps the total exact; a ring has at least three vertices.
    double running = 0;
    int64_t given = 0;
    for (size_t i = 0; i < sizes.size(); ++i) {
        running += share[i] / total * static_cast<double>(half);
        const int64_t wanted = std::max<int64_t>(3, std::llround(running) - given);
        sizes[i] = static_cast<uint32_t>(wanted);
        given += wanted;
    }
    // What three-vertex rings near the poles took too much comes off the largest ring.
    uint32_t& largest = *std::max_element(sizes.begin(), sizes.end());
    largest = static_cast<uint32_t>(std::max<int64_t>(3, largest - (given - static_cast<int64_t>(half))));
    return sizes;
}

/// Triangles between two rings (or a ring and a pole, a ring of one): each step takes the side whose next vertex is
/// nearer.
void stitch(Primitive& out, uint32_t upper, uint32_t upper_size, uint32_t lower, uint32_t lower_size) {
    uint32_t i = 0, j = 0;
    const uint32_t i_end = upper_size == 1 ? 0 : upper_size, j_end = lower_size == 1 ? 0 : lower_size;
    while (i < i_end || j < j_end) {
        const bool advance_lower =
            i == i_end || (j < j_end && uint64_t(2 * j + 1) * i_end <= uint64_t(2 * i + 1) * j_end);
        const uint32_t a = upper + i % upper_size, b = lower + j % lower_size;
        if (advance_lower)
            out.triangles.push_back({a, lower + (j + 1) % lower_size, b}), ++j;
        else
            out.triangles.push_back({a, upper + (i + 1) % upper_size, b}), ++i;
    }
}

void smooth_normals(Primitive& out) {
    out.normals.assign(out.positions.size(), glm::vec3(0));
    for (const glm::uvec3& t : out.triangles) {
        const glm::vec3 area =
            glm::cross(out.positions[t.y] - out.positions[t.x], out.positions[t.z] - out.positions[t.x]);
        for (int k = 0; k < 3; ++k) out.normals[t[k]] += area;
    }
    // The area of a triangle in a 10-million mesh is 1e-6 and its square underflows nothing; the fallback is for safety
    // only.
    for (size_t i = 0; i < out.normals.size(); ++i) {
        const float length = glm::length(out.normals[i]);
        out.normals[i] = length > 0 ? out.normals[i] / length : glm::normalize(out.positions[i]);
    }
}

Primitive blob_surface(uint64_t triangles) {
    const std::vector<uint32_t> sizes = ring_sizes(triangles / 2);
    Primitive out;
    const uint64_t vertices = std::accumulate(sizes.begin(), sizes.end(), uint64_t(2));
    out.positions.reserve(vertices);
    out.triangles.reserve(2 * (vertices - 2));
    out.positions.push_back(displaced({0, 1, 0}));
    uint32_t previous = 0, previous_size = 1;
    for (size_t ring = 0; ring < sizes.size(); ++ring) {
        const double theta = std::numbers::pi * static_cast<double>(ring + 1) / static_cast<double>(sizes.size() + 1);
        const auto first = static_cast<uint32_t>(out.positions.size());
        for (uint32_t i = 0; i < sizes[ring]; ++i) {
            const double phi = 2 * std::numbers::pi * i / sizes[ring];
            out.positions.push_back(displaced(
                glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi))));
        }
        stitch(out, previous, previous_size, first, sizes[ring]);
        previous = first;
        previous_size = sizes[ring];
    }
    out.positions.push_back(displaced({0, -1, 0}));
    stitch(out, previous, previous_size, static_cast<uint32_t>(out.positions.size() - 1), 1);
    smooth_normals(out);
    return out;
}

}  // namespace

Scene make_blob(uint64_t triangles) {
    const std::string name = fmt::format("builtin:blob:{}", triangles);
    SceneBuilder build(name.c_str());
    Primitive blob = blob_surface(triangles);
    float lowest = 0;
    for (const glm::vec3& p : blob.positions) lowest = std::min(lowest, p.y);
    const size_t made = blob.triangles.size();
    build.add("blob", std::move(blob), build.material(metal("metal", {0.90f, 0.86f, 0.78f})));
    Material floor = metal("floor", glm::vec3(0.55f));
    floor.metallic = 0.3f;
    build.add("floor", parallelogram({-2, lowest - 0.02f, 2}, {4, 0, 0}, {0, 0, -4}), build.material(floor));
    build.camera({1.7f, 1.25f, 3.1f}, {0, -0.12f, 0}, 34);
    Scene scene = build.take();
    scene.notes.push_back(fmt::format("the blob has {} triangles, the floor 2", made));
    return scene;
}

}  // namespace peelray
