#include "scene/normals.h"

#include "scene/transform.h"

#include <array>
#include <cmath>
#include <cstring>
#include <functional>

namespace peelray {

namespace {

// In double precision, so that no triangle of finite floats overflows or vanishes.
glm::dvec3 area_vector(const Primitive& p, const glm::uvec3& t) {
    const glm::dvec3 a = p.positions[t.x], b = p.positions[t.y], c = p.positions[t.z];
    return glm::cross(b - a, c - a);
}

constexpr glm::vec3 any_normal{0, 1, 0};

/// Numbers equal keys 0, 1, 2, … in order of first appearance; `hash(i)` and `same(i, j)` speak of element i.
std::vector<uint32_t> number_equal(size_t count, const std::function<size_t(size_t)>& hash,
                                   const std::function<bool(size_t, size_t)>& same, std::vector<uint32_t>& firsts) {
    size_t slots = 16;
    while (slots < count * 2) slots *= 2;
    std::vector<uint32_t> table(slots, UINT32_MAX), ids(count);
    for (size_t i = 0; i < count; ++i) {
        size_t slot = hash(i) & (slots - 1);
        while (table[slot] != UINT32_MAX && !same(firsts[table[slot]], i)) slot = (slot + 1) & (slots - 1);
        if (table[slot] == UINT32_MAX) {
            table[slot] = static_cast<uint32_t>(firsts.size());
            firsts.push_back(static_cast<uint32_t>(i));
        }
        ids[i] = table[slot];
    }
    return ids;
}

size_t hash_floats(const float* values, size_t count, size_t seed) {
    for (size_t i = 0; i < count; ++i) {
        uint32_t bits;
        const float value = values[i] + 0.f;  // -0 equals +0 and must hash alike
        std::memcpy(&bits, &value, 4);
        seed = (seed ^ bits) * 0x9E3779B97F4A7C15ull;
        seed ^= seed >> 32;
    }
    return seed;
}

template <typename T>
void gather(std::vector<T>& values, const std::vector<uint32_t>& from) {
    if (values.empty()) return;
    std::vector<T> out(from.size());
    for (size_t i = 0; i < from.size(); ++i) out[i] = values[from[i]];
    values = std::move(out);
}

/// Vertex i becomes a copy of vertex from[i].
void gather_vertices(Primitive& p, const std::vector<uint32_t>& from) {
    gather(p.positions, from);
    gather(p.normals, from);
    gather(p.uvs, from);
    gather(p.colors, from);
    gather(p.joints, from);
    for (MorphTarget& target : p.targets) {
        gather(target.positions, from);
        gather(target.normals, from);
    }
}

/// One vertex per corner.
void unshare(Primitive& p) {
    std::vector<uint32_t> from;
    from.reserve(p.triangles.size() * 3);
    for (glm::uvec3& t : p.triangles) {
        const auto first = static_cast<uint32_t>(from.size());
        from.insert(from.end(), {t.x, t.y, t.z});
        t = {first, first + 1, first + 2};
    }
    gather_vertices(p, from);
}

struct Corners {
    std::vector<uint32_t> start;     ///< per distinct position: its part of `list`
    std::vector<uint32_t> list;      ///< corners (3·triangle + k)
    std::vector<uint32_t> position;  ///< per corner: its distinct position
};

Corners corners_by_position(const Primitive& p) {
    std::vector<uint32_t> firsts;
    Corners out;
    out.position = number_equal(
        p.positions.size(), [&](size_t i) { return hash_floats(&p.positions[i].x, 3, 1); },
        [&](size_t i, size_t j) { return p.positions[i] == p.positions[j]; }, firsts);
    out.start.assign(firsts.size() + 1, 0);
    for (const uint32_t id : out.position) ++out.start[id + 1];
    for (size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
    std::vector<uint32_t> next(out.start.begin(), out.start.end() - 1);
    out.list.resize(out.position.size());
    for (size_t i = 0; i < out.position.size(); ++i) out.list[next[out.position[i]]++] = static_cast<uint32_t>(i);
    return out;
}

double corner_angle(const Primitive& p, size_t corner) {
    const size_t first = corner - corner % 3;
    const glm::dvec3 at = p.positions[corner];
    const glm::dvec3 a = glm::dvec3(p.positions[first + (corner + 1 - first) % 3]) - at;
    const glm::dvec3 b = glm::dvec3(p.positions[first + (corner + 2 - first) % 3]) - at;
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

void make_flat(Primitive& p) {
    p.flat = true;
    p.normals.clear();
    unshare(p);
    p.normals.resize(p.positions.size());
    for (const glm::uvec3& t : p.triangles)
        p.normals[t.x] = p.normals[t.y] = p.normals[t.z] = unit_or(area_vector(p, t), any_normal);
}

void make_smooth(Primitive& p, float crease) {
    p.normals.clear();
    unshare(p);
    std::vector<glm::vec3> faces(p.triangles.size());
    for (size_t i = 0; i < faces.size(); ++i) faces[i] = unit_or(area_vector(p, p.triangles[i]), glm::vec3(0));
    std::vector<glm::vec3> weighted(p.positions.size());
    for (size_t i = 0; i < weighted.size(); ++i) weighted[i] = faces[i / 3] * static_cast<float>(corner_angle(p, i));
    const Corners corners = corners_by_position(p);
    const float sharp = std::cos(crease);
    p.normals.resize(p.positions.size());
    for (size_t id = 0; id + 1 < corners.start.size(); ++id) {
        const uint32_t begin = corners.start[id], end = corners.start[id + 1];
        // Where hundreds of triangles meet, comparing all pairs would take quadratic time for no visible gain.
        const bool crowded = end - begin > 512;
        glm::dvec3 all{0};
        for (uint32_t i = begin; i < end; ++i) all += weighted[corners.list[i]];
        for (uint32_t i = begin; i < end; ++i) {
            const glm::vec3 own = faces[corners.list[i] / 3];
            glm::dvec3 sum{0};
            for (uint32_t j = begin; j < end && !crowded; ++j)
                if (glm::dot(own, faces[corners.list[j] / 3]) >= sharp) sum += weighted[corners.list[j]];
            const glm::vec3 fallback = own == glm::vec3(0) ? unit_or(all, any_normal) : own;
            p.normals[corners.list[i]] = unit_or(crowded ? all : sum, fallback);
        }
    }
    weld(p);
}

void weld(Primitive& p) {
    const auto hash = [&](size_t i) {
        size_t h = hash_floats(&p.positions[i].x, 3, 1);
        if (!p.normals.empty()) h = hash_floats(&p.normals[i].x, 3, h);
        if (!p.uvs.empty()) h = hash_floats(&p.uvs[i].x, 2, h);
        return p.colors.empty() ? h : hash_floats(&p.colors[i].x, 4, h);
    };
    const auto same = [&](size_t i, size_t j) {
        return p.positions[i] == p.positions[j] && (p.normals.empty() || p.normals[i] == p.normals[j]) &&
               (p.uvs.empty() || p.uvs[i] == p.uvs[j]) && (p.colors.empty() || p.colors[i] == p.colors[j]);
    };
    std::vector<uint32_t> firsts;
    const std::vector<uint32_t> ids = number_equal(p.positions.size(), hash, same, firsts);
    for (glm::uvec3& t : p.triangles) t = {ids[t.x], ids[t.y], ids[t.z]};
    gather_vertices(p, firsts);
}

size_t repair_normals(Primitive& p) {
    size_t broken = 0;
    std::vector<glm::dvec3> sums;
    for (size_t i = 0; i < p.normals.size(); ++i) {
        const glm::vec3 unit = unit_or(glm::dvec3(p.normals[i]), glm::vec3(0));
        if (unit != glm::vec3(0)) {
            p.normals[i] = unit;
            continue;
        }
        if (broken++ == 0) {
            sums.assign(p.positions.size(), glm::dvec3(0));
            for (const glm::uvec3& t : p.triangles)
                for (int k = 0; k < 3; ++k) sums[t[k]] += area_vector(p, t);
        }
        p.normals[i] = unit_or(sums[i], any_normal);
    }
    return broken;
}

}  // namespace peelray
