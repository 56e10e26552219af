#include "builtin/parted_mesh.h"

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "scene/transform.h"

namespace peelray {

PartedMesh::PartedMesh(ClosedMesh mesh, Field surface)
    : mesh_(std::move(mesh)),
      surface_(std::move(surface)),
      parts_(mesh_.half_edges() / 3),
      values_(mesh_.positions.size()),
      is_fixed_(mesh_.positions.size()) {}

bool PartedMesh::is_crossed(uint32_t h, uint32_t part) const {
    return values_[mesh_.from(h)] * values_[mesh_.to(h)] < 0 &&
           (parts_[h / 3] == part || parts_[mesh_.twin(h) / 3] == part);
}

glm::vec3 PartedMesh::onto_line(const Field& line, const glm::vec3& near, float reach) const {
    glm::vec3 p = near;
    for (int i = 0; i < 3; ++i) {
        const glm::vec3 normal = unit_or(gradient(surface_, p), glm::vec3(0));
        glm::vec3 along = gradient(line, p);
        along -= glm::dot(along, normal) * normal;
        const float growth = glm::dot(along, along);
        if (growth > 1e-4f) p -= line(p) / growth * along;
        p = onto_surface(surface_, p);
    }
    // Where the fields bend sharply the steps may lead astray.
    return glm::distance(p, near) < reach ? p : onto_surface(surface_, near);
}

/// Moves a vertex onto the line if that is near enough and folds nothing.
bool PartedMesh::snap(uint32_t vertex, uint32_t from, const Field& line) {
    float nearest = 0.35f, length = 0;
    glm::vec3 at(0);
    mesh_.for_each_around(vertex, [&](uint32_t h) {
        if (!is_crossed(h, from)) return;
        const float value = values_[vertex], share = value / (value - values_[mesh_.to(h)]);
        if (share >= nearest) return;
        nearest = share;
        length = mesh_.length(h);
        at = glm::mix(mesh_.positions[vertex], mesh_.positions[mesh_.to(h)], share);
    });
    if (nearest == 0.35f) return false;
    at = onto_line(line, at, 0.5f * length);
    bool folds = false;
    mesh_.for_each_around(vertex, [&](uint32_t h) {
        const glm::vec3 &q = mesh_.positions[mesh_.to(h)], &r = mesh_.positions[mesh_.to(ClosedMesh::next(h))];
        const glm::vec3 before = mesh_.area_vector(h / 3), after = glm::cross(q - at, r - at);
        folds |= glm::dot(before, after) < 0.7f * glm::length(before) * glm::length(after) ||
                 glm::length(after) < 0.15f * glm::length(before);
    });
    if (folds) return false;
    mesh_.positions[vertex] = at;
    return true;
}

void PartedMesh::give(uint32_t from, uint32_t to, const Field& line) {
    parallel_for(values_.size(), 256, [&](size_t i) {
        const float value = line(mesh_.positions[i]);
        // A tenth of a millimetre: what an earlier cut along the same line left.
        values_[i] = std::abs(value) < 1e-4f ? 0 : value;
    });
    for (uint32_t vertex = 0; vertex < values_.size(); ++vertex)
        if (!is_fixed_[vertex] && values_[vertex] != 0 && snap(vertex, from, line)) values_[vertex] = 0;
    for (uint32_t h = 0; h < mesh_.half_edges(); ++h) {
        if (!is_crossed(h, from)) continue;
        const uint32_t a = mesh_.from(h), b = mesh_.to(h);
        const float share = values_[a] / (values_[a] - values_[b]);
        parts_.push_back(parts_[h / 3]);
        parts_.push_back(parts_[mesh_.twin(h) / 3]);
        const glm::vec3 at = glm::mix(mesh_.positions[a], mesh_.positions[b], share);
        mesh_.split(h, onto_line(line, at, 0.7f * mesh_.length(h)));
        values_.push_back(0);
        is_fixed_.push_back(true);
    }
    for (uint32_t t = 0; t < parts_.size(); ++t) {
        if (parts_[t] != from) continue;
        float sum = 0;
        for (uint32_t k = 0; k < 3; ++k) sum += values_[mesh_.from(3 * t + k)];
        if (sum == 0) sum = line(middle_of(t));
        if (sum < 0) parts_[t] = to;
    }
    for (uint32_t vertex = 0; vertex < values_.size(); ++vertex)
        if (values_[vertex] == 0)
            mesh_.for_each_around(vertex, [&](uint32_t h) {
                if (parts_[h / 3] == from || parts_[h / 3] == to) is_fixed_[vertex] = true;
            });
}

void PartedMesh::give_rest(uint32_t from, const std::function<uint32_t(const glm::vec3&)>& to) {
    for (uint32_t t = 0; t < parts_.size(); ++t)
        if (parts_[t] == from) parts_[t] = to(middle_of(t));
}

/// Its sine: twice the area over the product of the two longest sides.
float PartedMesh::sharpest_corner(uint32_t a, uint32_t b, uint32_t c) const {
    const glm::vec3 &p = mesh_.positions[a], &q = mesh_.positions[b], &r = mesh_.positions[c];
    const float pq = glm::distance(p, q), qr = glm::distance(q, r), rp = glm::distance(r, p);
    const float shortest = std::min({pq, qr, rp}), product = pq * qr * rp;
    return product > 0 ? glm::length(glm::cross(q - p, r - p)) * shortest / product : 0;
}

/// May an edge's start move to its end without moving a line?
bool PartedMesh::may_slide(uint32_t h) const {
    const uint32_t from = mesh_.from(h);
    if (!is_fixed_[from]) return true;
    // Along the border of two parts, but not from where three meet.
    const uint32_t left = parts_[h / 3], right = parts_[mesh_.twin(h) / 3];
    bool is_corner = false;
    mesh_.for_each_around(from, [&](uint32_t i) { is_corner |= parts_[i / 3] != left && parts_[i / 3] != right; });
    return left != right && !is_corner;
}

void PartedMesh::improve(float shortest) {
    for (uint32_t h = 0; h < mesh_.half_edges(); ++h)
        if (!mesh_.is_dead(h) && mesh_.length(h) < shortest && may_slide(h))
            mesh_.collapse(h, mesh_.positions[mesh_.to(h)], std::numeric_limits<float>::infinity());
    for (uint32_t h = 0; h < mesh_.half_edges(); ++h) {
        if (mesh_.is_dead(h)) continue;
        const uint32_t g = mesh_.twin(h), a = mesh_.from(h), b = mesh_.to(h);
        if (g < h || parts_[h / 3] != parts_[g / 3] || (is_fixed_[a] && is_fixed_[b])) continue;
        const uint32_t c = mesh_.from(ClosedMesh::previous(h)), d = mesh_.from(ClosedMesh::previous(g));
        if (std::min(sharpest_corner(a, b, c), sharpest_corner(b, a, d)) <
            std::min(sharpest_corner(c, d, b), sharpest_corner(d, c, a)))
            mesh_.turn(h);
    }
    size_t kept = 0;
    for (uint32_t t = 0; t < parts_.size(); ++t)
        if (!mesh_.is_dead(3 * t)) parts_[kept++] = parts_[t];
    parts_.resize(kept);
    mesh_.compact();
    values_.assign(mesh_.positions.size(), 0);
    is_fixed_.assign(mesh_.positions.size(), true);
}

glm::vec3 PartedMesh::middle_of(uint32_t triangle) const {
    glm::vec3 sum(0);
    for (uint32_t k = 0; k < 3; ++k) sum += mesh_.positions[mesh_.from(3 * triangle + k)];
    return sum / 3.f;
}

}  // namespace peelray
