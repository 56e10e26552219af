#include "render/moment_before.h"

#include "render/frame_state.h"

namespace peelray {

void MomentBefore::look_back(FrameState& f, const Scene& source, const Moment& before, const Moment& now,
                             const Assembly& assembly, const View& view) {
    const std::vector<Assembly::Body>& bodies = assembly.bodies;
    const bool deforms = assembly.fixed < bodies.size();
    camera_.eye = view.eye;
    camera_.near = view.near;
    camera_.right = view.right;
    camera_.orthographic = view.orthographic;
    camera_.up = view.up;
    camera_.first_moving = deforms ? bodies[assembly.fixed].first_vertex : ~0u;
    camera_.forward = view.forward;

    f.scene.pose(f.commands, source, before);
    f.scene.record_animation(f.commands, f.tracer->bodies());
    const MemoryPart part(f.device, "images");
    const uint64_t instances = f.scene.instances.count() * sizeof(GpuTransform);
    ensure_size(f.device, transforms_, "where instances stood", instances);
    f.commands.copy(f.scene.instances.transforms(), transforms_, instances);
    if (deforms) {
        const uint64_t first = camera_.first_moving * sizeof(glm::vec3),
                       bytes = (bodies.back().first_vertex + bodies.back().vertices) * sizeof(glm::vec3) - first;
        ensure_size(f.device, positions_, "where vertices were", bytes);
        f.commands.copy(f.scene.triangles.positions, positions_, bytes, first);
    }
    f.commands.submit();
    f.scene.pose(f.commands, source, now);
}

}  // namespace peelray
