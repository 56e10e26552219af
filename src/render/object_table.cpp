#include "render/object_table.h"

#include <algorithm>

namespace peelray {

bool ObjectSummary::reflects_or_refracts(const PictureSettings& settings) const {
    if (settings.refraction && transmits) return true;
    return settings.reflection && (transmits || is_reflection_traced(smoothest, metallic, settings.spp));
}

ObjectTable::ObjectTable(const Scene& scene, const Geometry& geometry) {
    std::vector<float> smoothest;
    for (const Material& material : scene.materials) smoothest.push_back(least_roughness(scene, material));
    for (const Geometry::Object& object : geometry.objects) {
        ObjectSummary s;
        s.first = object.first;
        s.count = object.count;
        uint32_t last = ~0u;
        for (uint32_t i = object.first; i < object.first + object.count; i++) {
            if (geometry.materials[i] == last) continue;
            last = geometry.materials[i];
            const Material& m = scene.materials[last];
            s.transmits |= m.unlit ? m.blended : lets_through(m);
            if (m.unlit) continue;
            s.metallic |= m.metallic > float(MOSTLY_METAL);
            s.smoothest = std::min(s.smoothest, smoothest[last]);
            s.roughest = std::max(s.roughest, most_roughness(m));
        }
        objects_.push_back(s);
    }
    move(geometry);
}

void ObjectTable::move(const Geometry& geometry) {
    for (ObjectSummary& s : objects_) {
        s.lower = glm::vec3(INFINITY);
        s.upper = glm::vec3(-INFINITY);
        for (uint32_t i = s.first; i < s.first + s.count; i++)
            for (int k = 0; k < 3; k++) {
                const glm::vec3& p = geometry.positions[geometry.triangles[i][k]];
                s.lower = glm::min(s.lower, p);
                s.upper = glm::max(s.upper, p);
            }
    }
}

std::vector<GpuObject> ObjectTable::gpu_objects() const {
    std::vector<GpuObject> table;
    for (const ObjectSummary& s : objects_) {
        const glm::vec3 size = s.upper - s.lower;
        table.push_back({s.lower, NO_PROBE, s.upper, 0, 0, std::min({size.x, size.y, size.z})});
    }
    return table;
}

void ObjectTable::upload(Device& device, Commands& commands) {
    ensure_size(device, without_probes_, "objects", objects_.size() * sizeof(GpuObject));
    commands.upload(without_probes_, std::span<const GpuObject>(gpu_objects()));
}

void ObjectTable::record_visibility(Commands& commands, Device& device, const GpuScene& scene, const ViewTarget& target,
                                    const MapVisibilityParams& params) const {
    record_view(commands, device, "map_visibility", scene, target,
                {{"triangle_objects", scene.triangle_objects}, {"objects", without_probes_}}, params);
}

}  // namespace peelray
