#include "bench/ldc_contender.h"

#include <algorithm>

#include "render/tracers/ldc_tracer.h"
#include "render/transforms.h"

namespace peelray {
namespace {

TracerChoice rebuilt(const CubeChoice& cubes) {
    TracerChoice choice;
    choice.cubes = cubes;
    choice.rebuild = true;
    return choice;
}

}  // namespace

LdcContender::LdcContender(Device& device, ClockProbe& probe, const Scene& scene, const Moment& moment,
                           const Assembly& assembly, CubeChoice choice)
    : GpuContender(device, probe),
      scene_(device, scene, moment, assembly, rebuilt(choice)),
      cubes_(dynamic_cast<const LdcTracer&>(scene_.tracer()).cubes()) {
    const std::vector<LdcBody> bodies = scene_.stats(commands_).bodies;
    const std::vector<GpuTransform> transforms = transforms_of(assembly.instances, moment.worlds);
    if (cubes_.choice().hit != HitTest::exact) voxels_.resize(assembly.shown);
    for (size_t i = 0; i < assembly.instances.size(); i++) {
        const Assembly::Instance& instance = assembly.instances[i];
        const glm::mat3& m = transforms[i].linear;
        const float scale = std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
        const float voxel = bodies[instance.body].grid.voxel * scale;
        voxel_ = std::max(voxel_, voxel);
        if (voxels_.empty()) continue;
        const Assembly::Body& body = assembly.bodies[instance.body];
        for (uint32_t k = body.first_triangle; k < body.first_triangle + body.triangles; k++)
            voxels_[instance.first_id + assembly.ids[k]] = voxel;
    }
}

Claim LdcContender::claim() const {
    return cubes_.choice().hit == HitTest::exact ? Claim::exact : Claim::voxel;
}

float LdcContender::start_offset(uint32_t triangle) const {
    return voxels_.empty() || triangle == ~0u ? 0 : kPlanarOffset * voxels_[triangle];
}

MemoryUse LdcContender::memory() const {
    const Cubes& cubes = cubes_.cubes();
    MemoryUse use;
    const auto add = [&](const char* name, const Buffer& buffer) {
        if (buffer) use.emplace_back(name, buffer.bytes());
    };
    add("top_table", cubes.top_table);
    add("node_table", cubes.node_table);
    add("voxel_table", cubes.voxel_table);
    add("pixel_offsets", cubes.pixel_offsets);
    add("pixel_ranges", cubes.pixel_ranges);
    add("samples", cubes.has_patches() ? cubes.patches : cubes.samples);
    add("sample_ids", cubes.sample_ids);
    add("corners", cubes.corners);
    use.emplace_back("instances", scene_.instances().bytes());
    use.emplace_back("build_scratch", stats().scratch_bytes);
    return use;
}

}  // namespace peelray
