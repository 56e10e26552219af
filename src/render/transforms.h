// An assembly's instances as the GPU takes them.
#pragma once

#include "params.h"
#include "scene/assembly.h"

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

/// Where the instances stand; `worlds`: of all nodes (world_matrices).
inline std::vector<GpuTransform> transforms_of(const std::vector<Assembly::Instance>& instances,
                                               const std::vector<glm::mat4>& worlds) {
    std::vector<GpuTransform> transforms;
    for (const Assembly::Instance& instance : instances)
        transforms.push_back(
            gpu_transform(instance.node < 0 ? instance.offset : worlds[size_t(instance.node)] * instance.offset));
    return transforms;
}

}  // namespace peelray
