#include "render/motion_picture.h"

namespace peelray {

void MotionPicture::look_back(FrameState& f, const Scene& source, const Moment& before, const Moment& now,
                              const Assembly& assembly, const View& view) {
    const std::vector<Assembly::Body>& bodies = assembly.bodies;
    const bool deforms = assembly.fixed < bodies.size();
    params_.eye = view.eye;
    params_.near = view.near;
    params_.right = view.right;
    params_.orthographic = view.orthographic;
    params_.up = view.up;
    params_.first_moving = deforms ? bodies[assembly.fixed].first_vertex : ~0u;
    params_.forward = view.forward;

    f.scene.pose(f.commands, source, before);
    f.scene.record_animation(f.commands, f.tracer->bodies());
    const MemoryPart part(f.device, "images");
    const uint64_t instances = f.scene.instances.count() * sizeof(GpuTransform);
    ensure_size(f.device, transforms_, "where instances stood", instances);
    f.commands.copy(f.scene.instances.transforms(), transforms_, instances);
    if (deforms) {
        const uint64_t first = params_.first_moving * sizeof(glm::vec3),
                       bytes = (bodies.back().first_vertex + bodies.back().vertices) * sizeof(glm::vec3) - first;
        ensure_size(f.device, positions_, "where vertices were", bytes);
        f.commands.copy(f.scene.triangles.positions, positions_, bytes, first);
    }
    ensure_size(f.device, motions_, "motion in the picture", f.pixels() * sizeof(AovMotion));
    f.commands.submit();
    f.scene.pose(f.commands, source, now);
}

void MotionPicture::record(FrameState& f, const LevelParams& band) const {
    MotionParams params = params_;
    params.capacity = band.capacity;
    params.first_row = band.first_row;
    f.commands.run(f.device.pass("aov_motion"),
                   {{"frame", f.view.target.frame},
                    {"positions", f.scene.triangles.positions},
                    {"triangles", f.scene.triangles.triangles},
                    {"instances", f.scene.instances.table()},
                    {"hits", f.queues.level(0).hits},
                    Binding::if_used("positions_before", positions_),
                    {"transforms_before", transforms_},
                    {"motions", motions_}},
                   params, groups_for(params.capacity, 64));
}

void MotionPicture::store(FrameState& f, Aovs& aovs) const {
    std::vector<AovMotion> records(f.pixels(), AovMotion{});
    if (f.settings.motion) records = f.commands.download<AovMotion>(motions_, records.size());
#define AOV_STORE(name, type, channels, nothing) \
    for (const AovMotion& record : records) aovs.name.push_back(record.name);
    MOTION_AOVS(AOV_STORE)
#undef AOV_STORE
}

}  // namespace peelray
