#include "bench/khr_contender.h"

namespace peelray {
namespace {

std::unique_ptr<RayScene> make_scene(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
                                     StructureUpdate update) {
    TracerChoice choice;
    choice.tracer = Tracer::khr;
    choice.rebuild = true;
    choice.structures = update;
    return std::make_unique<RayScene>(device, scene, moment, assembly, choice);
}

}  // namespace

KhrContender::KhrContender(Device& device, ClockProbe& probe, const Scene& scene, const Moment& moment,
                           const Assembly& assembly, StructureUpdate update)
    : GpuContender(device, probe), source_(scene), moment_(moment), assembly_(assembly), update_(update) {
    device.check_ray_tracing();
    scene_ = make_scene(device, scene, moment, assembly, update);
}

Timing KhrContender::time_build(uint32_t runs) {
    if (update_ == StructureUpdate::keep) return {};
    return GpuContender::time_build(runs);
}

/// In structures that can be refitted: those that are rebuilt can not.
Timing KhrContender::time_refit(uint32_t runs) {
    if (update_ == StructureUpdate::keep) return {};
    std::unique_ptr<RayScene> rebuilt = std::move(scene_);
    scene_ = make_scene(device_, source_, moment_, assembly_, StructureUpdate::refit);
    const Timing timing = GpuContender::time_build(runs);
    scene_ = std::move(rebuilt);
    return timing;
}

MemoryUse KhrContender::memory() const {
    Commands commands(device_);
    const Structures::Stats stats = scene_->stats(commands).structures;
    return {{"acceleration_structures", stats.bytes}, {"build_scratch", stats.scratch_bytes}};
}

}  // namespace peelray
