#include "scene/sidedness.h"

#include <algorithm>

#include "scene/picture.h"

namespace peelray {

bool is_single_sided(const Material& material) {
    const bool bounds_volume = transmits(material) && material.thickness > 0 && !material.unlit;
    return !material.double_sided && !bounds_volume;
}

bool has_single_sided(const Scene& scene) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(), [&](const Mesh& mesh) {
        return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                           [&](const Primitive& p) { return is_single_sided(scene.materials[p.material]); });
    });
}

bool has_single_sided(const Scene& scene, const std::vector<uint32_t>& triangle_materials) {
    return std::any_of(triangle_materials.begin(), triangle_materials.end(),
                       [&](uint32_t material) { return is_single_sided(scene.materials[material]); });
}

void show_both_sides(Scene& scene) {
    for (Material& material : scene.materials) material.double_sided = true;
}

Sidedness::Sidedness(const Scene& scene, const Geometry& geometry) {
    if (!has_single_sided(scene, geometry.materials)) return;
    scene_ = &scene;
    geometry_ = &geometry;
}

}  // namespace peelray
