// An assembly's instances as the GPU takes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/assembly.h"
#include "common/instance.h"

namespace peelray {

inline GpuTransform gpu_transform(const glm::mat4& m) {
    return {glm::mat3(m), glm::vec3(m[3])};
}

inline std::vector<InstanceInfo> instance_infos(const Assembly& assembly) {
    std::vector<InstanceInfo> infos;
    for (const Assembly::Instance& instance : assembly.instances)
        infos.push_back({instance.body, instance.first_id, instance.first_object});
    return infos;
}

/// Where an instance stands; `worlds`: of all nodes (Moment::worlds).
inline glm::mat4 world_of(const Assembly::Instance& instance, const std::vector<glm::mat4>& worlds) {
    return instance.node < 0 ? instance.offset : worlds[size_t(instance.node)] * instance.offset;
}

/// Where the instances stand; `worlds`: of all nodes (Moment::worlds).
inline std::vector<GpuTransform> transforms_of(const std::vector<Assembly::Instance>& instances,
                                               const std::vector<glm::mat4>& worlds) {
    std::vector<GpuTransform> transforms;
    for (const Assembly::Instance& instance : instances)
        transforms.push_back(gpu_transform(world_of(instance, worlds)));
    return transforms;
}

/// Of each body the smallest scale at which an instance shows it (of transforms without shear); 1 where none does.
inline std::vector<float> smallest_scales(const Assembly& assembly, const std::vector<glm::mat4>& worlds) {
    std::vector<float> scales(assembly.bodies.size(), std::numeric_limits<float>::infinity());
    const std::vector<GpuTransform> transforms = transforms_of(assembly.instances, worlds);
    for (size_t i = 0; i < transforms.size(); i++) {
        float& scale = scales[assembly.instances[i].body];
        for (int k = 0; k < 3; k++) scale = std::min(scale, glm::length(transforms[i].linear[k]));
    }
    for (float& scale : scales) scale = std::isinf(scale) || scale <= 0 ? 1 : scale;
    return scales;
}

}  // namespace peelray
