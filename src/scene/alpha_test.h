// The alpha test of masked materials (glTF 2.0, section 3.9.4): where a triangle has a surface.
#pragma once

#include "scene/scene.h"

namespace peelray {

/// Does any of the triangles' materials have holes?
bool has_masks(const Scene& scene, const std::vector<uint32_t>& triangle_materials);

class AlphaTest {
  public:
    /// Every triangle is whole.
    AlphaTest() = default;
    /// Both must outlive it.
    AlphaTest(const Scene& scene, const Geometry& geometry);

    /// May the triangle have holes?
    bool is_masked(uint32_t triangle) const;
    /// Is there a surface at the point with the weights `u`, `v` of the triangle's second and third corner?
    bool is_present(uint32_t triangle, double u, double v) const;

  private:
    const Scene* scene_ = nullptr;  ///< null: nothing is masked
    const Geometry* geometry_ = nullptr;
};

}  // namespace peelray
