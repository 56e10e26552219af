#include "render/ray_scene.h"

#include "common/ray.h"
#include "khr/tracer.h"
#include "render/base_colors.h"
#include "render/structure_bodies.h"
#include "render/transforms.h"
#include "scene/alpha_test.h"

namespace peelray {

RayScene::RayScene(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
                   const TracerChoice& choice)
    : device_(device),
      triangles_(device, assembly.positions, assembly.triangles),
      triangle_ids_(device, "places of triangles in the file", assembly.ids.size() * 4),
      instances_(device, instance_infos(assembly)),
      cubes_(device, assembly, choice.cubes, choice.fixed_bodies(assembly), smallest_scales(assembly, moment.worlds)),
      shown_(assembly.bodies.size()) {
    Commands commands(device);
    if (has_masks(scene, assembly.materials)) {
        base_colors_ = upload_base_colors(device, commands, scene, assembly);
        triangles_.masks = &base_colors_;
    }
    commands.upload(triangle_ids_, std::span<const uint32_t>(assembly.ids));
    instances_.place(commands, transforms_of(assembly.instances, moment.worlds));
    for (const Assembly::Instance& instance : assembly.instances) shown_[instance.body]++;
    if (choice.tracer == Tracer::khr)
        build_structures(commands, scene, assembly, choice);
    else
        build_cubes(commands);
}

void RayScene::build_structures(Commands& commands, const Scene& scene, const Assembly& assembly,
                                const TracerChoice& choice) {
    std::vector<StructureBody> bodies = structure_bodies(scene, assembly);
    for (size_t i = choice.fixed_bodies(assembly); i < bodies.size(); i++) bodies[i].update = choice.structures;
    structures_ = std::make_unique<Structures>(device_, triangles_, instances_, bodies);
    const auto count = [&] {
        build_times_.insert(build_times_.end(), commands.times().begin(), commands.times().end());
        build_ms_ += commands.elapsed_ms();
    };
    instances_.record(commands, cubes_.cubes(), false);
    structures_->build_kept(commands, count);
    structures_->record(commands, true);
    commands.submit();
    count();
}

void RayScene::build_cubes(Commands& commands) {
    // What deforms lies in the assembly as it is now.
    for (bool built = false; !built;) {
        const bool fixed = cubes_.build_fixed(commands, triangles_);
        if (fixed) build_times_ = commands.times(), build_ms_ = commands.elapsed_ms();
        record_build(commands);
        commands.submit();
        built = finish_build(commands);
    }
    build_times_.insert(build_times_.end(), commands.times().begin(), commands.times().end());
    build_ms_ += commands.elapsed_ms();
}

void RayScene::record(Commands& commands, const Buffer& rays, uint32_t count, const Buffer& file_hits, bool any_hit,
                      const CountBuffers* counting) {
    ensure_size(device_, hits_, "hits", uint64_t(count) * sizeof(Hit));
    RayQueue queue{rays, nullptr, count};
    queue.counting = counting;
    record_hits(commands, queue, hits_, any_hit, Edges::precise);
    record_translation(commands, hits_, count, file_hits);
}

void RayScene::record_hits(Commands& commands, const RayQueue& queue, const Buffer& hits, bool any_hit, Edges edges) {
    if (structures_)
        record_khr_trace(commands, device_, *structures_, triangles_, queue, hits, any_hit);
    else
        record_trace(commands, device_, {cubes_.cubes(), instances_, triangles_}, queue, hits,
                     {cubes_.choice().hit, cubes_.choice().tolerance, any_hit, edges});
}

void RayScene::record_translation(Commands& commands, const Buffer& hits, uint32_t count, const Buffer& file_hits) {
    record_file_hits(commands, device_, instances_, triangle_ids_, hits, count, file_hits);
}

void RayScene::record_build(Commands& commands) {
    if (structures_) return structures_->record(commands, true);
    cubes_.record(commands, triangles_);
    instances_.record(commands, cubes_.cubes());
}

}  // namespace peelray
