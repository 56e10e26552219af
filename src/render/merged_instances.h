// Many small bodies cost each ray a start in every cube that it comes near: instead of that, copies of their triangles,
// in the world, share one cube, which is built anew for every frame if any of them moves.
#pragma once

#include <memory>

#include "assembly/assembly.h"
#include "ldc/instances.h"
#include "ldc/merge_params.h"
#include "ldc/triangle_buffers.h"
#include "render/tracers/tracer_choice.h"

namespace peelray {

/// The copies, behind the triangles and vertices of the scene.
class MergedInstances {
  public:
    /// Null where `choice` merges nothing in this scene: its rays are not traced in cubes for `exact` hits by voxel,
    /// few instances are small, or their copies would be too many. `worlds`: of all nodes, at some moment; of
    /// the buffers of the scene's triangles those grow.
    static std::unique_ptr<MergedInstances> make(Device& device, Commands& commands, const Assembly& assembly,
                                                 const std::vector<glm::mat4>& worlds, const TracerChoice& choice,
                                                 TriangleBuffers& triangles);

    /// The body that the copies are, with bounds as they were in that moment. Its number is that behind the last.
    const Assembly::Body& body() const { return body_; }
    /// Do any of them move?
    bool moves() const { return moves_; }
    /// What becomes of the instances.
    const MergedBody& merged() const { return merged_; }
    /// uvec2 of each copied triangle: its instance, and the triangle there.
    const Buffer& copied() const { return copied_; }

    /// Records that the copies move to where the instances stand, and the bounds of their body with them.
    void record(Commands& commands, const BodyTable& bodies, const TriangleBuffers& triangles,
                const Instances& instances) const;

    uint64_t bytes() const;

  private:
    MergedInstances(Device& device, Commands& commands, const Assembly& assembly, const std::vector<glm::mat4>& worlds,
                    const std::vector<uint32_t>& chosen, TriangleBuffers& triangles);
    void add(const Assembly& assembly, const std::vector<glm::mat4>& worlds, uint32_t instance,
             std::vector<MergedInstance>& table);

    Device& device_;
    bool moves_ = false;
    Assembly::Body body_;
    MergedBody merged_;
    uint32_t vertex_groups_ = 0;
    Buffer table_, groups_, copied_;  ///< groups: of the vertices
};

}  // namespace peelray
