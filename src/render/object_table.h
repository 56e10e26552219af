// The scene's objects as the baseline (Tracer::cubemap) sees them: boxes, and which of them mirror or let light
// through.
#pragma once

#include <cmath>

#include "cubemap/cubemap_params.h"
#include "render/view_passes.h"
#include "scene/picture.h"

namespace peelray {

/// An object of the scene (Geometry::Object) and what its materials do.
struct ObjectSummary {
    uint32_t first = 0, count = 0;  ///< triangles
    glm::vec3 lower{INFINITY}, upper{-INFINITY};
    bool transmits = false, metallic = false;  ///< some surface that is not unlit
    float smoothest = 2, roughest = 0;         ///< perceptual roughness of those surfaces; 2: all are unlit

    /// Whether Tracer::ldc would send rays from it (scatter.comp): then it deserves a probe.
    bool reflects_or_refracts(const PictureSettings& settings) const;
};

class ObjectTable {
  public:
    ObjectTable(const Scene& scene, const Geometry& geometry);

    /// Takes on the boxes of the same scene in another moment.
    void move(const Geometry& geometry);

    const std::vector<ObjectSummary>& objects() const { return objects_; }

    /// GpuObject of every object, without probes.
    std::vector<GpuObject> gpu_objects() const;

    /// Uploads the table without probes.
    void upload(Device& device, Commands& commands);
    const Buffer& without_probes() const { return without_probes_; }  ///< GpuObject per object

    /// Rasterises what a probe or a light sees into `target`, whose frame constants are set.
    void record_visibility(Commands& commands, Device& device, const GpuScene& scene, const ViewTarget& target,
                           const MapVisibilityParams& params) const;

  private:
    std::vector<ObjectSummary> objects_;
    Buffer without_probes_;
};

}  // namespace peelray
