#include "builtin/polygonise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "scene/transform.h"

namespace peelray {

glm::vec3 gradient(const Field& field, const glm::vec3& p) {
    // Differences along the corners of a tetrahedron: four values instead of six.
    constexpr float step = 5e-4f;
    glm::vec3 sum(0);
    for (const glm::vec3& corner :
         {glm::vec3(1, -1, -1), glm::vec3(-1, -1, 1), glm::vec3(-1, 1, -1), glm::vec3(1, 1, 1)})
        sum += corner * field(p + step * corner);
    return sum / (4 * step);
}

glm::vec3 onto_surface(const Field& field, glm::vec3 p) {
    for (int i = 0; i < 2; ++i) {
        const glm::vec3 growth = gradient(field, p);
        // Where the field hardly grows (between two surfaces) there is no way to tell how far it is.
        p -= field(p) * growth / std::max(glm::dot(growth, growth), 0.25f);
    }
    return p;
}

namespace {

/// Values of a field at the corners of a grid of cubes, where the surface is near.
class Grid {
  public:
    Grid(const Field& field, const glm::vec3& lower, const glm::vec3& upper, float cell)
        : lower_(lower), cell_(cell), blocks_(glm::uvec3(glm::ceil((upper - lower) / (cell * float(block))))) {
        nodes_ = blocks_ * block + 1u;
        values_.resize(size_t(nodes_.x) * nodes_.y * nodes_.z);
        active_.resize(size_t(blocks_.x) * blocks_.y * blocks_.z);
        // Half the diagonal of a block, plus that of a cube so that the neighbours of every crossed edge are included.
        const float reach = 0.5f * std::sqrt(3.f) * cell * float(block) + 0.01f * cell;
        parallel_for(active_.size(), 8, [&](size_t i) {
            const glm::vec3 middle = at(block_of(i) * block) + 0.5f * cell * float(block);
            active_[i] = std::abs(field(middle)) <= reach;
        });
        // Blocks share their border nodes; each is evaluated by the block that owns it, or by a neighbour of that.
        parallel_for(active_.size(), 8, [&](size_t i) {
            if (!active_[i]) return;
            for_each_node(block_of(i), [&](const glm::uvec3& node) {
                const glm::uvec3 owner = glm::min(node / block, blocks_ - 1u);
                if (owner == block_of(i) || !active_[index_of_block(owner)]) store(node, field(at(node)));
            });
        });
    }

    static constexpr uint32_t block = 4;  ///< cubes a side

    size_t index(const glm::uvec3& node) const { return (size_t(node.z) * nodes_.y + node.y) * nodes_.x + node.x; }
    glm::vec3 at(const glm::uvec3& node) const { return lower_ + cell_ * glm::vec3(node); }
    float value(const glm::uvec3& node) const { return values_[index(node)]; }
    size_t nodes() const { return values_.size(); }

    template <typename Visit>
    void for_each_active_cube(Visit visit) const {
        for (size_t i = 0; i < active_.size(); ++i) {
            if (!active_[i]) continue;
            const glm::uvec3 first = block_of(i) * block;
            for (uint32_t z = 0; z < block; ++z)
                for (uint32_t y = 0; y < block; ++y)
                    for (uint32_t x = 0; x < block; ++x) visit(first + glm::uvec3(x, y, z));
        }
    }

  private:
    glm::uvec3 block_of(size_t i) const {
        return {i % blocks_.x, i / blocks_.x % blocks_.y, i / (size_t(blocks_.x) * blocks_.y)};
    }
    size_t index_of_block(const glm::uvec3& b) const { return (size_t(b.z) * blocks_.y + b.y) * blocks_.x + b.x; }

    // A node on the border of several blocks may be stored by two of them, with one and the same value.
    void store(const glm::uvec3& node, float value) {
        std::atomic_ref<float>(values_[index(node)]).store(value, std::memory_order_relaxed);
    }

    template <typename Visit>
    void for_each_node(const glm::uvec3& of_block, Visit visit) const {
        for (uint32_t z = 0; z <= block; ++z)
            for (uint32_t y = 0; y <= block; ++y)
                for (uint32_t x = 0; x <= block; ++x) visit(of_block * block + glm::uvec3(x, y, z));
    }

    glm::vec3 lower_;
    float cell_;
    glm::uvec3 blocks_, nodes_;
    std::vector<float> values_;
    std::vector<uint8_t> active_;
};

/// The surface in one grid; vertices lie on the edges of the tetrahedra.
class Marcher {
  public:
    explicit Marcher(const Grid& grid) : grid_(grid), vertex_of_(8 * grid.nodes(), ClosedMesh::none) {}

    ClosedMesh march() {
        grid_.for_each_active_cube([&](const glm::uvec3& cube) {
            // The six ways from the cube's first corner to its last, one axis after the other; odd ones are mirrored.
            constexpr std::array<std::array<uint32_t, 3>, 6> ways = {
                {{1, 2, 4}, {2, 4, 1}, {4, 1, 2}, {2, 1, 4}, {1, 4, 2}, {4, 2, 1}}};
            uint32_t inside = 0;
            for (uint32_t corner = 0; corner < 8; ++corner)
                inside |= uint32_t(grid_.value(cube + offset(corner)) < 0) << corner;
            if (inside == 0 || inside == 255) return;
            for (size_t way = 0; way < ways.size(); ++way) {
                std::array<uint32_t, 4> corners{0, ways[way][0], ways[way][0] | ways[way][1], 7};
                if (way >= 3) std::swap(corners[2], corners[3]);
                tetrahedron(cube, corners, inside);
            }
        });
        return ClosedMesh(std::move(positions_), triangles_);
    }

  private:
    static glm::uvec3 offset(uint32_t corner) { return {corner & 1, corner >> 1 & 1, corner >> 2}; }

    /// Corners in positive order, given as corners of the cube.
    void tetrahedron(const glm::uvec3& cube, const std::array<uint32_t, 4>& corners, uint32_t inside_of_cube) {
        // Even permutations that bring the corners inside (or a single one outside) to the front.
        constexpr std::array<std::array<uint32_t, 4>, 16> orders = {{{0, 1, 2, 3},
                                                                     {0, 1, 2, 3},
                                                                     {1, 0, 3, 2},
                                                                     {0, 1, 2, 3},
                                                                     {2, 3, 0, 1},
                                                                     {0, 2, 3, 1},
                                                                     {1, 2, 0, 3},
                                                                     {3, 2, 1, 0},
                                                                     {3, 2, 1, 0},
                                                                     {0, 3, 1, 2},
                                                                     {1, 3, 2, 0},
                                                                     {2, 3, 0, 1},
                                                                     {2, 3, 0, 1},
                                                                     {1, 0, 3, 2},
                                                                     {0, 1, 2, 3},
                                                                     {0, 1, 2, 3}}};
        uint32_t inside = 0;
        for (uint32_t i = 0; i < 4; ++i) inside |= (inside_of_cube >> corners[i] & 1) << i;
        if (inside == 0 || inside == 15) return;
        std::array<uint32_t, 4> c;
        for (uint32_t i = 0; i < 4; ++i) c[i] = corners[orders[inside][i]];
        const int count = __builtin_popcount(inside);
        const auto on = [&](uint32_t i, uint32_t j) { return vertex(cube, c[i], c[j]); };
        if (count == 1) triangles_.push_back({on(0, 1), on(0, 2), on(0, 3)});
        if (count == 3) triangles_.push_back({on(0, 1), on(0, 3), on(0, 2)});
        if (count == 2) {
            triangles_.push_back({on(0, 2), on(0, 3), on(1, 3)});
            triangles_.push_back({on(0, 2), on(1, 3), on(1, 2)});
        }
    }

    /// The vertex on an edge between two corners of a cube: one of them has all the other's bits and some more.
    uint32_t vertex(const glm::uvec3& cube, uint32_t a, uint32_t b) {
        const glm::uvec3 from = cube + offset(a & b), to = cube + offset(a | b);
        uint32_t& number = vertex_of_[8 * grid_.index(from) + (a ^ b)];
        if (number == ClosedMesh::none) {
            const float at_from = grid_.value(from), at_to = grid_.value(to);
            // Not too near to a corner, where several vertices would coincide.
            const float share = std::clamp(at_from / (at_from - at_to), 0.02f, 0.98f);
            number = uint32_t(positions_.size());
            positions_.push_back(glm::mix(grid_.at(from), grid_.at(to), share));
        }
        return number;
    }

    const Grid& grid_;
    std::vector<uint32_t> vertex_of_;  // 8 per node: by the bits in which the edge's ends differ
    std::vector<glm::vec3> positions_;
    std::vector<glm::uvec3> triangles_;
};

void split_long_edges(ClosedMesh& mesh, const Field& field, const Size& size) {
    const auto count = uint32_t(mesh.half_edges());
    for (uint32_t h = 0; h < count; ++h) {
        if (mesh.is_dead(h) || mesh.twin(h) < h) continue;
        const glm::vec3 middle = 0.5f * (mesh.positions[mesh.from(h)] + mesh.positions[mesh.to(h)]);
        if (mesh.length(h) > 4.f / 3 * size(middle)) mesh.split(h, onto_surface(field, middle));
    }
}

/// New vertices lie a little below the surface until they are relaxed.
void collapse_short_edges(ClosedMesh& mesh, const Size& size) {
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t h = 0; h < mesh.half_edges(); ++h) {
            if (mesh.is_dead(h) || mesh.twin(h) < h) continue;
            const glm::vec3 middle = 0.5f * (mesh.positions[mesh.from(h)] + mesh.positions[mesh.to(h)]);
            const float wanted = size(middle);
            if (mesh.length(h) < 0.8f * wanted) changed |= mesh.collapse(h, middle, 4.f / 3 * wanted);
        }
    }
}

/// Turns edges where that brings the numbers of neighbours closer to six.
void even_out_valences(ClosedMesh& mesh) {
    for (uint32_t h = 0; h < mesh.half_edges(); ++h) {
        if (mesh.is_dead(h) || mesh.twin(h) < h) continue;
        const auto off = [&](uint32_t vertex, int change) {
            const int excess = int(mesh.valence(vertex)) + change - 6;
            return excess * excess;
        };
        const uint32_t a = mesh.from(h), b = mesh.to(h), c = mesh.from(ClosedMesh::previous(h)),
                       d = mesh.from(ClosedMesh::previous(mesh.twin(h)));
        if (off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1) < off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0))
            mesh.turn(h);
    }
}

/// Moves every vertex towards the middle of its neighbours, and back to the surface by one of Newton's steps.
void relax(ClosedMesh& mesh, const Field& field) {
    std::vector<glm::vec3> moved(mesh.positions.size());
    parallel_for(moved.size(), 256, [&](size_t i) {
        const auto vertex = uint32_t(i);
        if (!mesh.is_used(vertex)) return;
        glm::vec3 sum(0);
        float count = 0;
        mesh.for_each_around(vertex, [&](uint32_t h) { sum += mesh.positions[mesh.to(h)], ++count; });
        const glm::vec3 &at = mesh.positions[i], growth = gradient(field, at);
        const float growth2 = std::max(glm::dot(growth, growth), 0.25f);
        glm::vec3 way = sum / count - at;
        way -= glm::dot(way, growth) / growth2 * growth;
        moved[i] = at + 0.7f * way;
        moved[i] -= field(moved[i]) / growth2 * growth;
    });
    mesh.positions = std::move(moved);
}

}  // namespace

ClosedMesh polygonise(const Field& field, const glm::vec3& lower, const glm::vec3& upper, float cell) {
    return Marcher(Grid(field, lower, upper, cell)).march();
}

void remesh(ClosedMesh& mesh, const Field& field, const Size& size, int rounds) {
    for (int round = 0; round < rounds; ++round) {
        collapse_short_edges(mesh, size);
        if (round > 0) split_long_edges(mesh, field, size);
        even_out_valences(mesh);
        relax(mesh, field);
    }
    relax(mesh, field);
    mesh.compact();
}

}  // namespace peelray
