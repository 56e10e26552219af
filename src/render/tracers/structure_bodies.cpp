#include "render/tracers/structure_bodies.h"

#include "scene/alpha_test.h"

namespace peelray {
namespace {

/// A body whose materials change more often than that is masked as a whole: its structure would be all overhead.
constexpr size_t kMostParts = 64;

std::vector<StructurePart> parts_of(const Scene& scene, const Assembly& assembly, const Assembly::Body& body) {
    std::vector<StructurePart> parts;
    for (uint32_t i = body.first_triangle; i < body.first_triangle + body.triangles; i++) {
        const bool masked = scene.materials[assembly.materials[i]].alpha_cutoff > 0;
        if (parts.empty() || parts.back().masked != masked) parts.push_back({i, 0, masked});
        parts.back().triangles++;
    }
    if (parts.size() > kMostParts) parts = {{body.first_triangle, body.triangles, true}};
    return parts;
}

}  // namespace

std::vector<StructureBody> structure_bodies(const Scene& scene, const Assembly& assembly) {
    const bool masks = has_masks(scene, assembly.materials);
    std::vector<StructureBody> bodies;
    for (const Assembly::Body& body : assembly.bodies) {
        StructureBody& out = bodies.emplace_back();
        out.parts = {{body.first_triangle, body.triangles, false}};
        if (masks) out.parts = parts_of(scene, assembly, body);
        out.last_vertex = body.first_vertex + std::max(body.vertices, 1u) - 1;
    }
    return bodies;
}

}  // namespace peelray
