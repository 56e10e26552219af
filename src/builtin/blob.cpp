// A displaced sphere of any number of triangles. The vertices lie on rings of constant height whose numbers of vertices
// follow the ring's length, so that triangles are of even size everywhere, the poles included; a mesh of rings with n_i
// vertices has exactly 2·Σ n_i triangles, which lets us meet every even number.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "builtin/shapes.h"

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

/// What the blob swells to: fewer and higher lobes, still one radius for each direction, so that no moment in between
/// folds over; and never below `lowest`, where the floor is near.
glm::vec3 swollen(const glm::vec3& direction, float lowest) {
    const float lobes = noise(direction * 1.9f + glm::vec3(37.1f), 0x51ED270Bu),
                ripples = noise(direction * 4.3f + glm::vec3(5.7f), 0xB5297A4Du);
    const float radius = 0.72f * (1 + 0.42f * lobes + 0.12f * ripples);
    if (direction.y >= 0) return direction * radius;
    // The smaller of both, with a soft bend where they meet.
    const float limit = lowest / direction.y, bend = std::max(0.25f - std::abs(radius - limit), 0.f);
    return direction * (std::min(radius, limit) - bend * bend);
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
    // The excess of the three-vertex rings near the poles is taken off the largest ring.
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

std::vector<glm::vec3> smooth_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<glm::uvec3>& triangles) {
    std::vector<glm::vec3> normals(positions.size(), glm::vec3(0));
    for (const glm::uvec3& t : triangles) {
        const glm::vec3 area = glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]);
        for (int k = 0; k < 3; ++k) normals[t[k]] += area;
    }
    // The area of a triangle in a mesh of 10 million is 1e-6, and its square does not underflow; the fallback is for
    // safety only.
    for (size_t i = 0; i < normals.size(); ++i) {
        const float length = glm::length(normals[i]);
        normals[i] = length > 0 ? normals[i] / length : glm::normalize(positions[i]);
    }
    return normals;
}

Primitive blob_surface(uint64_t triangles) {
    const std::vector<uint32_t> sizes = ring_sizes(triangles / 2);
    std::vector<uint32_t> first(1, 1);  // of each ring, then of the south pole; the north pole is vertex 0
    for (const uint32_t size : sizes) first.push_back(first.back() + size);
    const uint32_t last = first.back();
    Primitive out;
    out.positions.resize(last + 1);
    out.positions[0] = displaced({0, 1, 0});
    out.positions[last] = displaced({0, -1, 0});
    parallel_for(sizes.size(), 4, [&](size_t ring) {
        const double theta = std::numbers::pi * static_cast<double>(ring + 1) / static_cast<double>(sizes.size() + 1);
        for (uint32_t i = 0; i < sizes[ring]; ++i) {
            const double phi = 2 * std::numbers::pi * i / sizes[ring];
            out.positions[first[ring] + i] =
                displaced(glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
        }
    });
    out.triangles.reserve(2 * size_t(last - 1));
    stitch(out, 0, 1, 1, sizes[0]);
    for (size_t ring = 1; ring < sizes.size(); ++ring)
        stitch(out, first[ring - 1], sizes[ring - 1], first[ring], sizes[ring]);
    stitch(out, first[sizes.size() - 1], sizes.back(), last, 1);
    out.normals = smooth_normals(out.positions, out.triangles);
    return out;
}

MorphTarget swell_target(const Primitive& blob, float lowest) {
    MorphTarget out;
    out.positions.resize(blob.positions.size());
    parallel_for(out.positions.size(), 4096,
                 [&](size_t i) { out.positions[i] = swollen(glm::normalize(blob.positions[i]), lowest); });
    out.normals = smooth_normals(out.positions, blob.triangles);
    for (size_t i = 0; i < out.positions.size(); ++i) {
        out.positions[i] -= blob.positions[i];
        out.normals[i] -= blob.normals[i];
    }
    return out;
}

/// Out and back; all tangents are 0, so that it rests a little at both ends and the loop has no kink.
Animation swell(int node) {
    AnimationChannel weight;
    weight.node = node;
    weight.path = AnimationChannel::Path::weights;
    weight.interpolation = AnimationChannel::Interpolation::cubic;
    weight.width = 1;
    weight.times = {0, 1.1f, 2.2f};
    weight.values = {0, 0, 0, 0, 1, 0, 0, 0, 0};
    return {"swell", weight.times.back(), {weight}};
}

}  // namespace

Scene make_blob(uint64_t triangles) {
    const std::string name = fmt::format("builtin:blob:{}", triangles);
    SceneBuilder build(name.c_str());
    Primitive blob = blob_surface(triangles);
    float lowest = 0;
    for (const glm::vec3& p : blob.positions) lowest = std::min(lowest, p.y);
    blob.make_targets = [lowest](const Primitive& made) {
        return std::vector<MorphTarget>{swell_target(made, lowest)};
    };
    const size_t made = blob.triangles.size();
    build.add("blob", std::move(blob), build.material(metal("metal", {0.90f, 0.86f, 0.78f})));
    Material floor = metal("floor", glm::vec3(0.55f));
    floor.metallic = 0.3f;
    build.add("floor", parallelogram({-2, lowest - 0.02f, 2}, {4, 0, 0}, {0, 0, -4}), build.material(floor));
    build.camera({1.7f, 1.25f, 3.1f}, {0, -0.12f, 0}, 34);
    Scene scene = build.take();
    scene.animations.push_back(swell(0));
    scene.notes.push_back(fmt::format("the blob has {} triangles, the floor 2", made));
    return scene;
}

}  // namespace peelray
