#include "scene/normals.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <new>
#include <span>

#include "base/parallel.h"
#include "scene/transform.h"

namespace peelray {

namespace {

// In double precision, so that no triangle of finite floats overflows or vanishes.
glm::dvec3 area_vector(const Primitive& p, const glm::uvec3& t) {
    const glm::dvec3 a = p.positions[t.x], b = p.positions[t.y], c = p.positions[t.z];
    return glm::cross(b - a, c - a);
}

constexpr glm::vec3 any_normal{0, 1, 0};

/// Numbers equal keys 0, 1, 2, … in order of first appearance; `hash(i)` and `same(i, j)` speak of element i. `firsts`
/// gets the first element of each number.
template <typename Hash, typename Same>
std::vector<uint32_t> number_equal(size_t count, const Hash& hash, const Same& same, std::vector<uint32_t>& firsts) {
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

/// The corners (3·triangle + k) that lie at the same position, whichever vertex they name.
struct Corners {
    std::vector<uint32_t> start;  ///< per distinct position: its part of `list`
    std::vector<uint32_t> list;   ///< ascending within a position
};

Corners corners_by_position(const Primitive& p) {
    std::vector<uint32_t> firsts;
    const std::vector<uint32_t> ids = number_equal(
        p.positions.size(), [&](size_t i) { return hash_floats(&p.positions[i].x, 3, 1); },
        [&](size_t i, size_t j) { return p.positions[i] == p.positions[j]; }, firsts);
    Corners out;
    out.start.assign(firsts.size() + 1, 0);
    for (const glm::uvec3& t : p.triangles)
        for (int k = 0; k < 3; ++k) ++out.start[ids[t[k]] + 1];
    for (size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
    out.list.resize(p.triangles.size() * 3);
    for (size_t i = 0; i < out.list.size(); ++i)
        out.list[out.start[ids[p.triangles[i / 3][i % 3]]]++] = static_cast<uint32_t>(i);
    // Each start has moved to its end, which is the next one's start.
    std::copy_backward(out.start.begin(), out.start.end() - 1, out.start.end());
    out.start[0] = 0;
    return out;
}

float corner_angle(const Primitive& p, size_t corner) {
    const glm::uvec3& t = p.triangles[corner / 3];
    const auto k = static_cast<int>(corner % 3);
    const glm::dvec3 at = p.positions[t[k]];
    const glm::dvec3 a = glm::dvec3(p.positions[t[(k + 1) % 3]]) - at;
    const glm::dvec3 b = glm::dvec3(p.positions[t[(k + 2) % 3]]) - at;
    return static_cast<float>(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// Do two vertices agree in all but position and normal?
bool same_surface(const Primitive& p, size_t i, size_t j) {
    return (p.uvs.empty() || p.uvs[i] == p.uvs[j]) && (p.colors.empty() || p.colors[i] == p.colors[j]);
}

size_t hash_surface(const Primitive& p, size_t i, size_t seed) {
    if (!p.uvs.empty()) seed = hash_floats(&p.uvs[i].x, 2, seed);
    return p.colors.empty() ? seed : hash_floats(&p.colors[i].x, 4, seed);
}

/// Completes the normals of a range of positions and joins their corners into vertices.
class Completion {
  public:
    Completion(const Primitive& p, const std::vector<glm::vec3>& faces, float crease)
        : p_(p), faces_(faces), sharp_(std::cos(crease)) {}

    /// `corners`: those of one position. `vertex_of`: gets each corner's vertex, an index into `from` and `normals`.
    void add(std::span<const uint32_t> corners, std::vector<uint32_t>& vertex_of) {
        find_normals(corners);
        const auto first = static_cast<uint32_t>(from.size());
        const auto source = [&](size_t i) { return p_.triangles[corners[i] / 3][static_cast<int>(corners[i] % 3)]; };
        const auto same = [&](size_t i, size_t j) {
            return found_[i] == found_[j] && same_surface(p_, source(i), source(j));
        };
        std::vector<uint32_t> ids;
        distinct_.clear();
        if (corners.size() > 32) {
            const auto hash = [&](size_t i) { return hash_surface(p_, source(i), hash_floats(&found_[i].x, 3, 1)); };
            ids = number_equal(corners.size(), hash, same, distinct_);
        }
        for (size_t i = 0; i < corners.size(); ++i) {
            uint32_t id = 0;
            if (!ids.empty()) {
                id = ids[i];
            } else {
                while (id < distinct_.size() && !same(distinct_[id], i)) ++id;
                if (id == distinct_.size()) distinct_.push_back(static_cast<uint32_t>(i));
            }
            vertex_of[corners[i]] = first + id;
        }
        for (const uint32_t i : distinct_) {
            from.push_back(source(i));
            normals.push_back(found_[i]);
        }
    }

    std::vector<uint32_t> from;      ///< per vertex: the primitive's vertex that it copies
    std::vector<glm::vec3> normals;  ///< per vertex

  private:
    void find_normals(std::span<const uint32_t> corners) {
        const size_t count = corners.size();
        weighted_.resize(count);
        found_.resize(count);
        glm::dvec3 all(0);
        for (size_t i = 0; i < count; ++i) {
            weighted_[i] = faces_[corners[i] / 3] * corner_angle(p_, corners[i]);
            all += weighted_[i];
        }
        // Where hundreds of triangles meet, comparing all pairs would take quadratic time for no visible gain.
        const bool crowded = count > 512;
        for (size_t i = 0; i < count; ++i) {
            const uint32_t vertex = p_.triangles[corners[i] / 3][static_cast<int>(corners[i] % 3)];
            if (!p_.normals.empty() && p_.normals[vertex] != glm::vec3(0)) {
                found_[i] = p_.normals[vertex];
                continue;
            }
            const glm::vec3 own = faces_[corners[i] / 3];
            glm::dvec3 sum(0);
            for (size_t j = 0; j < count && !crowded; ++j)
                if (glm::dot(own, faces_[corners[j] / 3]) >= sharp_) sum += weighted_[j];
            const glm::vec3 fallback = own == glm::vec3(0) ? unit_or(all, any_normal) : own;
            found_[i] = unit_or(crowded ? all : sum, fallback);
        }
    }

    const Primitive& p_;
    const std::vector<glm::vec3>& faces_;
    const float sharp_;
    std::vector<glm::vec3> weighted_, found_;
    std::vector<uint32_t> distinct_;
};

/// Numbers the vertices in the order in which triangles name them first, and makes the primitive of them.
void take_vertices(Primitive& p, const std::vector<Completion>& parts, const std::vector<uint32_t>& vertex_of) {
    size_t count = 0;
    for (const Completion& part : parts) count += part.from.size();
    std::vector<uint32_t> numbers(count, UINT32_MAX), order;
    order.reserve(count);
    for (size_t i = 0; i < vertex_of.size(); ++i) {
        uint32_t& number = numbers[vertex_of[i]];
        if (number == UINT32_MAX) {
            number = static_cast<uint32_t>(order.size());
            order.push_back(vertex_of[i]);
        }
        p.triangles[i / 3][static_cast<int>(i % 3)] = number;
    }
    std::vector<uint32_t> from(count);
    std::vector<glm::vec3> normals(count);
    size_t vertex = 0;
    for (const Completion& part : parts)
        for (size_t i = 0; i < part.from.size(); ++i, ++vertex) {
            from[numbers[vertex]] = part.from[i];
            normals[numbers[vertex]] = part.normals[i];
        }
    p.normals.clear();
    gather_vertices(p, from);
    p.normals = std::move(normals);
}

}  // namespace

void append_uv_sets(std::vector<std::vector<glm::vec2>>& sets, const Primitive& primitive, size_t vertices) {
    for (size_t i = 0; i < sets.size(); i++) {
        if (i < primitive.more_uvs.size())
            sets[i].insert(sets[i].end(), primitive.more_uvs[i].begin(), primitive.more_uvs[i].end());
        sets[i].resize(vertices, glm::vec2(0));
    }
}

void gather_vertices(Primitive& p, const std::vector<uint32_t>& from) {
    gather(p.positions, from);
    gather(p.normals, from);
    gather(p.tangents, from);
    gather(p.uvs, from);
    for (std::vector<glm::vec2>& set : p.more_uvs) gather(set, from);
    gather(p.colors, from);
    gather(p.joints, from);
    for (MorphTarget& target : p.targets) {
        gather(target.positions, from);
        gather(target.normals, from);
        gather(target.tangents, from);
    }
}

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
    complete_normals(p, crease);
}

void complete_normals(Primitive& p, float crease) {
    constexpr size_t grain = 1 << 14;
    std::vector<glm::vec3> faces(p.triangles.size());
    parallel_for(faces.size(), grain,
                 [&](size_t i) { faces[i] = unit_or(area_vector(p, p.triangles[i]), glm::vec3(0)); });
    const Corners corners = corners_by_position(p);
    const size_t positions = corners.start.size() - 1;
    std::vector<Completion> parts((positions + grain - 1) / grain, Completion(p, faces, crease));
    std::vector<uint32_t> vertex_of(p.triangles.size() * 3);
    std::atomic<bool> out_of_memory{false};
    parallel_for(parts.size(), 1, [&](size_t part) {
        try {
            for (size_t id = part * grain; id < std::min(positions, (part + 1) * grain); ++id)
                parts[part].add(
                    std::span(corners.list).subspan(corners.start[id], corners.start[id + 1] - corners.start[id]),
                    vertex_of);
        } catch (const std::bad_alloc&) {
            out_of_memory = true;
        }
    });
    if (out_of_memory) throw std::bad_alloc();
    std::vector<uint32_t> firsts{0};
    for (const Completion& part : parts) firsts.push_back(firsts.back() + static_cast<uint32_t>(part.from.size()));
    parallel_for(parts.size(), 1, [&](size_t part) {
        for (size_t i = corners.start[part * grain]; i < corners.start[std::min(positions, (part + 1) * grain)]; ++i)
            vertex_of[corners.list[i]] += firsts[part];
    });
    take_vertices(p, parts, vertex_of);
}

void weld(Primitive& p) {
    const auto hash = [&](size_t i) {
        size_t h = hash_floats(&p.positions[i].x, 3, 1);
        if (!p.normals.empty()) h = hash_floats(&p.normals[i].x, 3, h);
        return hash_surface(p, i, h);
    };
    const auto same = [&](size_t i, size_t j) {
        return p.positions[i] == p.positions[j] && (p.normals.empty() || p.normals[i] == p.normals[j]) &&
               same_surface(p, i, j);
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
