// A closed mesh whose triangles belong to parts, cut along the lines where parts meet. Private to src/builtin.
#pragma once

#include <algorithm>

#include "builtin/polygonise.h"

namespace peelray {

class PartedMesh {
  public:
    /// All triangles belong to part 0. `surface`: the field whose surface the mesh is.
    PartedMesh(ClosedMesh mesh, Field surface);

    /// Gives what lies at negative values of `line` to part `to`, of part `from` only: the mesh is cut where the line's
    /// field is zero. Vertices close to the line move onto it, so that no slivers arise; those of earlier lines stay.
    void give(uint32_t from, uint32_t to, const Field& line);

    /// Gives all triangles to a part, without a cut.
    void give_all(uint32_t to) { std::fill(parts_.begin(), parts_.end(), to); }
    /// Gives each triangle of a part to the one that `to` names for its centre, without a cut.
    void give_rest(uint32_t from, const std::function<uint32_t(const glm::vec3&)>& to);

    /// Takes out edges shorter than `shortest`, and turns edges inside of parts where that makes the sharpest corner of
    /// both triangles blunter. Lines stay where they are.
    void improve(float shortest);

    const ClosedMesh& mesh() const { return mesh_; }
    const std::vector<uint32_t>& parts() const { return parts_; }  ///< per triangle

  private:
    glm::vec3 middle_of(uint32_t triangle) const;
    bool may_slide(uint32_t h) const;
    float sharpest_corner(uint32_t a, uint32_t b, uint32_t c) const;
    bool is_crossed(uint32_t h, uint32_t part) const;
    glm::vec3 onto_line(const Field& line, const glm::vec3& near, float reach) const;
    bool snap(uint32_t vertex, uint32_t from, const Field& line);

    ClosedMesh mesh_;
    Field surface_;
    std::vector<uint32_t> parts_;
    std::vector<float> values_;  ///< of the current line, per vertex; 0: on it
    std::vector<bool> is_fixed_;
};

}  // namespace peelray
