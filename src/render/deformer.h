// Skins and morph targets on the GPU: the vertices of everything that changes its shape, once per frame.
#pragma once

#include "assembly/assembly.h"
#include "ldc/body_table.h"
#include "ldc/triangle_buffers.h"
#include "motion/motion_params.h"

namespace peelray {

/// Computes positions and normals of the bodies that deform, and their bounds.
class Deformer {
  public:
    /// Uploads the shapes at rest, the joints' weights and the morph targets of the assembly's pieces.
    Deformer(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly);

    bool empty() const { return pieces_.empty(); }

    /// Takes on another moment of the scene: uploads joints and weights. Where a transform has come to turn a piece
    /// inside out, or back, its triangles in `triangles` are turned over.
    void pose(Commands& commands, const Scene& scene, const Moment& moment, const Buffer& triangles);

    /// Records the passes into the group "animate": vertices go to positions, normals and, if there are any, tangents,
    /// bounds to the bodies, whose bounds have been emptied.
    void record(Commands& commands, const BodyTable& bodies, const TriangleBuffers& triangles, const Buffer& normals,
                const BaseColorBuffers& base_colors) const;

    uint64_t bytes() const;

  private:
    void add_rest(const Primitive& primitive, DeformPiece& piece);
    void add_influences(const Primitive& primitive, DeformPiece& piece);
    void add_targets(const Primitive& primitive, DeformPiece& piece);
    void turn_over(Commands& commands, size_t piece, const Primitive& primitive, bool mirrors, const Buffer& triangles);

    Device& device_;
    std::vector<Assembly::Piece> places_;
    std::vector<DeformPiece> pieces_;
    std::vector<bool> mirrored_;  ///< as the triangles lie in their buffer now
    DeformParams params_{};
    bool flat_ = false, has_tangents_ = false;
    /// What the constructor gathers for the upload.
    struct Gathered {
        std::vector<glm::vec3> positions, normals, targets;
        std::vector<glm::vec4> tangents;
        std::vector<JointInfluence> influences;
    } gathered_;
    uint32_t joint_count_ = 0, weight_count_ = 0;
    Buffer piece_table_, rest_positions_, rest_normals_, rest_tangents_, influences_, targets_, weights_, joints_;
};

}  // namespace peelray
