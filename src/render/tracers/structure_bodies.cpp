#include "render/tracers/structure_bodies.h"

#include "scene/alpha_test.h"
#include "scene/sidedness.h"

namespace peelray {
namespace {

/// A body whose materials change more often than that is not opaque as a whole: its structure would be all overhead.
constexpr size_t kMostParts = 64;

std::vector<StructurePart> parts_of(const Scene& scene, const Assembly& assembly, const Assembly::Body& body) {
    std::vector<StructurePart> parts;
    for (uint32_t i = body.first_triangle; i < body.first_triangle + body.triangles; i++) {
        const Material& material = scene.materials[assembly.materials[i]];
        const bool opaque = material.alpha_cutoff <= 0 && !is_single_sided(material);
        if (parts.empty() || parts.back().opaque != opaque) parts.push_back({i, 0, opaque});
        parts.back().triangles++;
    }
    if (parts.size() > kMostParts) parts = {{body.first_triangle, body.triangles, false}};
    return parts;
}

}  // namespace

std::vector<StructureBody> structure_bodies(const Scene& scene, const Assembly& assembly) {
    const bool asks = has_masks(scene, assembly.materials) || has_single_sided(scene, assembly.materials);
    std::vector<StructureBody> bodies;
    for (const Assembly::Body& body : assembly.bodies) {
        StructureBody& out = bodies.emplace_back();
        out.parts = {{body.first_triangle, body.triangles, true}};
        if (asks) out.parts = parts_of(scene, assembly, body);
        out.last_vertex = body.first_vertex + std::max(body.vertices, 1u) - 1;
    }
    return bodies;
}

}  // namespace peelray
