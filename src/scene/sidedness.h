// Which sides of a triangle are shown (glTF 2.0, section 3.9.5).
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/scene.h"

namespace peelray {

/// Is only the front shown, from which a triangle's corners go counter-clockwise? The surface of a volume that lets
/// light through shows both sides whatever the file says (KHR_materials_volume), for rays must come out again.
bool is_single_sided(const Material& material);

/// Does anything that the scene has show its front only? Materials that nothing is made of do not count.
bool has_single_sided(const Scene& scene);
/// Do any of the triangles show their front only?
bool has_single_sided(const Scene& scene, const std::vector<uint32_t>& triangle_materials);

/// Makes every material show both sides.
void show_both_sides(Scene& scene);

/// Does a ray along `direction` come from the triangle's front?
inline bool comes_from_front(const std::array<glm::vec3, 3>& corners, const glm::dvec3& direction) {
    const glm::dvec3 a = corners[0], b = corners[1], c = corners[2];
    return glm::dot(glm::cross(b - a, c - a), direction) < 0;
}

/// Of the triangles of a scene.
class Sidedness {
  public:
    /// Every triangle shows both sides.
    Sidedness() = default;
    /// Both must outlive it.
    Sidedness(const Scene& scene, const Geometry& geometry);

    bool is_single(uint32_t triangle) const {
        return scene_ && is_single_sided(scene_->materials[geometry_->materials[triangle]]);
    }
    /// Is the triangle there for a ray that meets it from the front or, else, from behind?
    bool shows(uint32_t triangle, bool front) const { return front || !is_single(triangle); }

  private:
    const Scene* scene_ = nullptr;  ///< null: nothing is single-sided
    const Geometry* geometry_ = nullptr;
};

}  // namespace peelray
