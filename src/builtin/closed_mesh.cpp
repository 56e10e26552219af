#include "builtin/closed_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

namespace peelray {

ClosedMesh::ClosedMesh(std::vector<glm::vec3> points, const std::vector<glm::uvec3>& triangles)
    : positions(std::move(points)),
      from_(3 * triangles.size()),
      twin_(3 * triangles.size(), none),
      edge_of_(positions.size(), none) {
    std::vector<std::pair<uint64_t, uint32_t>> edges;  // both ends, the smaller first; half-edge
    edges.reserve(from_.size());
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t h = 3 * t + k, a = triangles[t][int(k)], b = triangles[t][int((k + 1) % 3)];
            from_[h] = a;
            edge_of_[a] = h;
            edges.emplace_back(uint64_t(std::min(a, b)) << 32 | std::max(a, b), h);
        }
    std::sort(edges.begin(), edges.end());
    for (size_t i = 0; i + 1 < edges.size(); i += 2) {
        assert(edges[i].first == edges[i + 1].first && from_[edges[i].second] != from_[edges[i + 1].second]);
        assert(i + 2 == edges.size() || edges[i + 2].first != edges[i].first);
        link(edges[i].second, edges[i + 1].second);
    }
}

uint32_t ClosedMesh::valence(uint32_t vertex) const {
    uint32_t count = 0;
    for_each_around(vertex, [&](uint32_t) { ++count; });
    return count;
}

glm::vec3 ClosedMesh::area_vector(uint32_t triangle) const {
    const glm::vec3 &a = positions[from_[3 * triangle]], &b = positions[from_[3 * triangle + 1]],
                    &c = positions[from_[3 * triangle + 2]];
    return glm::cross(b - a, c - a);
}

void ClosedMesh::set_triangle(uint32_t t, uint32_t a, uint32_t b, uint32_t c) {
    from_[3 * t] = a, from_[3 * t + 1] = b, from_[3 * t + 2] = c;
    edge_of_[a] = 3 * t, edge_of_[b] = 3 * t + 1, edge_of_[c] = 3 * t + 2;
}

uint32_t ClosedMesh::split(uint32_t h, const glm::vec3& at) {
    // a → b with c on one side and d on the other becomes a → m → b.
    const uint32_t g = twin(h), a = from(h), b = to(h), c = from(previous(h)), d = from(previous(g));
    const uint32_t bc = twin(next(h)), ca = twin(previous(h)), ad = twin(next(g)), db = twin(previous(g));
    const auto m = uint32_t(positions.size());
    positions.push_back(at);
    edge_of_.push_back(none);
    const uint32_t t0 = h / 3, t1 = g / 3, t2 = uint32_t(from_.size() / 3), t3 = t2 + 1;
    from_.resize(from_.size() + 6);
    twin_.resize(twin_.size() + 6, none);
    set_triangle(t0, a, m, c);
    set_triangle(t1, m, a, d);
    set_triangle(t2, m, b, c);
    set_triangle(t3, b, m, d);
    link(3 * t0, 3 * t1);
    link(3 * t2, 3 * t3);
    link(3 * t0 + 1, 3 * t2 + 2);
    link(3 * t1 + 2, 3 * t3 + 1);
    link(3 * t0 + 2, ca);
    link(3 * t2 + 1, bc);
    link(3 * t1 + 1, ad);
    link(3 * t3 + 2, db);
    return m;
}

bool ClosedMesh::may_collapse(uint32_t h) const {
    // The ends may share no other neighbours than the two opposite corners, which must keep three of their own.
    const uint32_t a = from(h), b = to(h), c = from(previous(h)), d = from(previous(twin(h)));
    if (c == d || valence(c) <= 3 || valence(d) <= 3) return false;
    bool shares_others = false;
    for_each_around(a, [&](uint32_t i) {
        const uint32_t neighbour = to(i);
        if (neighbour == b || neighbour == c || neighbour == d) return;
        for_each_around(b, [&](uint32_t j) { shares_others |= to(j) == neighbour; });
    });
    return !shares_others;
}

bool ClosedMesh::collapse(uint32_t h, const glm::vec3& at, float longest) {
    if (!may_collapse(h)) return false;
    const uint32_t g = twin(h), a = from(h), b = to(h);
    bool is_bad = false;
    for (const uint32_t end : {a, b})
        for_each_around(end, [&](uint32_t i) {
            if (i / 3 == h / 3 || i / 3 == g / 3) return;
            const glm::vec3 &q = positions[to(i)], &r = positions[to(next(i))];
            const glm::vec3 before = glm::cross(q - positions[end], r - positions[end]),
                            after = glm::cross(q - at, r - at);
            is_bad |= glm::dot(before, after) < 0.5f * glm::length(before) * glm::length(after) ||
                      glm::distance(at, q) > longest || glm::distance(at, r) > longest;
        });
    if (is_bad) return false;
    for_each_around(a, [&](uint32_t i) { from_[i] = b; });
    positions[b] = at;
    for (const uint32_t side : {h, g}) {
        const uint32_t outer = twin(next(side)), inner = twin(previous(side));
        link(outer, inner);
        edge_of_[from(outer)] = outer;
        edge_of_[from(inner)] = inner;
        for (uint32_t k = 0; k < 3; ++k) from_[side / 3 * 3 + k] = twin_[side / 3 * 3 + k] = none;
    }
    edge_of_[a] = none;
    return true;
}

bool ClosedMesh::turn(uint32_t h) {
    const uint32_t g = twin(h), a = from(h), b = to(h), c = from(previous(h)), d = from(previous(g));
    if (c == d || valence(a) <= 3 || valence(b) <= 3) return false;
    bool exists = false;
    for_each_around(c, [&](uint32_t i) { exists |= to(i) == d; });
    if (exists) return false;
    const glm::vec3 before = area_vector(h / 3) + area_vector(g / 3);
    const glm::vec3 first = glm::cross(positions[d] - positions[c], positions[b] - positions[c]),
                    second = glm::cross(positions[c] - positions[d], positions[a] - positions[d]);
    for (const glm::vec3& after : {first, second})
        if (glm::dot(before, after) < 0.8f * glm::length(before) * glm::length(after)) return false;
    const uint32_t bc = twin(next(h)), ca = twin(previous(h)), ad = twin(next(g)), db = twin(previous(g));
    const uint32_t t0 = h / 3, t1 = g / 3;
    set_triangle(t0, c, d, b);
    set_triangle(t1, d, c, a);
    link(3 * t0, 3 * t1);
    link(3 * t0 + 1, db);
    link(3 * t0 + 2, bc);
    link(3 * t1 + 1, ca);
    link(3 * t1 + 2, ad);
    return true;
}

std::vector<glm::uvec3> ClosedMesh::compact() {
    std::vector<uint32_t> renumbered(positions.size(), none);
    std::vector<glm::vec3> kept;
    std::vector<glm::uvec3> triangles;
    for (uint32_t h = 0; h < from_.size(); h += 3) {
        if (is_dead(h)) continue;
        glm::uvec3 triangle;
        for (int k = 0; k < 3; ++k) {
            uint32_t& number = renumbered[from_[h + uint32_t(k)]];
            if (number == none) {
                number = uint32_t(kept.size());
                kept.push_back(positions[from_[h + uint32_t(k)]]);
            }
            triangle[k] = number;
        }
        triangles.push_back(triangle);
    }
    *this = ClosedMesh(std::move(kept), triangles);
    return triangles;
}

}  // namespace peelray
