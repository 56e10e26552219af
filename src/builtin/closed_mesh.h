// A closed triangle mesh whose triangles know their neighbours, and the steps that change it without opening it: an
// edge is split, collapsed or turned (Botsch and Kobbelt, A Remeshing Approach to Multiresolution Modeling, 2004).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace peelray {

/// Half-edge 3t + k runs from corner k of triangle t to the next one. Collapsed triangles stay, dead, until compact().
class ClosedMesh {
  public:
    static constexpr uint32_t none = 0xffffffff;

    /// Every edge must be shared by exactly two triangles that use it in opposite directions; otherwise asserts.
    ClosedMesh(std::vector<glm::vec3> positions, const std::vector<glm::uvec3>& triangles);

    std::vector<glm::vec3> positions;

    size_t half_edges() const { return from_.size(); }
    bool is_dead(uint32_t h) const { return from_[h] == none; }
    uint32_t from(uint32_t h) const { return from_[h]; }
    uint32_t to(uint32_t h) const { return from_[next(h)]; }
    uint32_t twin(uint32_t h) const { return twin_[h]; }
    static uint32_t next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static uint32_t previous(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
    float length(uint32_t h) const { return glm::distance(positions[from(h)], positions[to(h)]); }
    bool is_used(uint32_t vertex) const { return edge_of_[vertex] != none; }

    /// Calls `visit(h)` for every half-edge that starts at the vertex, in order around it.
    template <typename Visit>
    void for_each_around(uint32_t vertex, Visit visit) const {
        uint32_t h = edge_of_[vertex];
        do {
            visit(h);
            h = twin(previous(h));
        } while (h != edge_of_[vertex]);
    }
    uint32_t valence(uint32_t vertex) const;
    glm::vec3 area_vector(uint32_t triangle) const;  ///< normal times twice the area

    /// Puts a new vertex at `at` into the edge.
    uint32_t split(uint32_t h, const glm::vec3& at);
    /// Draws the edge together: both ends become one vertex at `at`. False, and nothing changed, where that would fold
    /// the surface, turn a triangle by more than some 60 degrees, or make an edge longer than `longest`.
    bool collapse(uint32_t h, const glm::vec3& at, float longest);
    /// Replaces the edge by the other diagonal of its two triangles; false where that would fold the surface.
    bool turn(uint32_t h);

    /// The triangles that live; unused vertices are dropped and `positions` renumbered.
    std::vector<glm::uvec3> compact();

  private:
    void link(uint32_t a, uint32_t b) { twin_[a] = b, twin_[b] = a; }
    void set_triangle(uint32_t t, uint32_t a, uint32_t b, uint32_t c);
    bool may_collapse(uint32_t h) const;

    std::vector<uint32_t> from_, twin_;  ///< per half-edge
    std::vector<uint32_t> edge_of_;      ///< per vertex: one that starts there, or none
};

}  // namespace peelray
