#include "render/ray_scene.h"

#include "common/ray.h"
#include "render/base_colors.h"
#include "render/transforms.h"
#include "scene/alpha_test.h"
#include "scene/sidedness.h"

namespace peelray {

RayScene::RayScene(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
                   const TracerChoice& choice)
    : device_(device),
      triangles_(device, assembly.positions, assembly.triangles),
      triangle_ids_(device, "places of triangles in the file", assembly.ids.size() * 4),
      instances_(device, instance_infos(assembly)) {
    Commands commands(device);
    const bool masked = has_masks(scene, assembly.materials), culled = has_single_sided(scene, assembly.materials);
    if (masked || culled)
        base_colors_ =
            upload_base_colors(device, commands, scene, assembly, used_materials(scene, assembly), MaterialsFor::hits);
    if (masked) triangles_.masks = &base_colors_;
    if (culled) triangles_.sides = &base_colors_;
    commands.upload(triangle_ids_, std::span<const uint32_t>(assembly.ids));
    instances_.place(commands, transforms_of(assembly.instances, moment.worlds));
    std::vector<StructureBody> structures;
    if (device.features.ray_tracing) structures = structure_bodies(scene, assembly);
    merged_ = MergedInstances::make(device, commands, assembly, moment.worlds, choice, triangles_);
    tracer_ = make_tracer(choice, {device, triangles_, instances_, assembly, moment.worlds, structures, merged_.get()});
    // What deforms lies in the assembly as it is now.
    tracer_->build(
        commands, [] {}, build_);
    commands.submit();
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
    tracer_->trace(commands, queue, hits, {any_hit, edges});
}

void RayScene::record_translation(Commands& commands, const Buffer& hits, uint32_t count, const Buffer& file_hits) {
    record_file_hits(commands, device_, instances_, triangle_ids_, hits, count, file_hits);
}

TracerStats RayScene::stats(Commands& commands) const {
    TracerStats stats;
    tracer_->describe(commands, stats, true);
    return stats;
}

}  // namespace peelray
