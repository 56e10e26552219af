#include "workspace/scene_changes.h"

#include <algorithm>

namespace peelray {

void override_materials(Scene& scene, MaterialOverride choice, const Box& box) {
    Material material;
    material.name = name_of(choice);
    switch (choice) {
        case MaterialOverride::mirror:
            material.base_color = glm::vec3(0.93f, 0.92f, 0.90f);
            material.metallic = 1;
            material.roughness = 0;
            break;
        case MaterialOverride::glass:
            material.roughness = 0;
            material.transmission = 1;
            material.thickness = 1;
            material.attenuation_color = glm::vec3(0.75f, 0.92f, 0.85f);
            material.attenuation_distance = 0.5f * glm::length(box.upper - box.lower);
            break;
        case MaterialOverride::clay:
            material.base_color = glm::vec3(0.62f, 0.52f, 0.44f);
            material.roughness = 0.9f;
            break;
    }
    for (Material& each : scene.materials) {
        // Which sides are shown is part of the model's shape: an outline's hull would hide what it surrounds.
        material.double_sided = each.double_sided;
        each = material;
    }
}

Box add_floor(Scene& scene, const Box& box, bool catcher) {
    const glm::vec3 size = box.upper - box.lower, centre = 0.5f * (box.lower + box.upper);
    const float longest = std::max({size.x, size.y, size.z}), half = 1.5f * longest, y = box.lower.y - 1e-4f * longest;
    Material material;
    material.name = "floor";
    material.base_color = glm::vec3(0.35f, 0.36f, 0.38f);
    material.roughness = 0;
    material.ior = 1.8f;
    material.catcher = catcher;
    material.double_sided = !catcher;  // from below nothing is to be hidden
    Primitive primitive;
    Box with_floor = box;
    for (int i = 0; i < 4; i++) {
        primitive.positions.emplace_back(centre.x + (i == 1 || i == 2 ? half : -half), y,
                                         centre.z + (i >= 2 ? half : -half));
        with_floor.add(primitive.positions.back());
    }
    primitive.normals.assign(4, {0, 1, 0});
    primitive.triangles = {{0, 2, 1}, {0, 3, 2}};
    primitive.material = uint32_t(scene.materials.size());
    scene.materials.push_back(material);
    Node node;
    node.name = "floor";
    node.local[3] = glm::dvec4(scene.origin, 1);
    node.mesh = int(scene.meshes.size());
    scene.meshes.push_back({"floor", {primitive}, {}});
    scene.nodes.push_back(node);
    return with_floor;
}

}  // namespace peelray
