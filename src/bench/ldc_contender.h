// Layered depth cubes in a benchmark.
#pragma once

#include "bench/gpu_contender.h"
#include "render/ray_scene.h"

namespace peelray {

class LdcContender : public GpuContender {
  public:
    /// The scene at a moment, which is that of its assembly. `choice`: every cube is rebuilt, whatever it says. Throws
    /// Error where it does not fit the device.
    LdcContender(Device& device, ClockProbe& probe, const Scene& scene, const Moment& moment, const Assembly& assembly,
                 CubeChoice choice);

    Claim claim() const override;
    float start_offset(uint32_t triangle) const override;
    double voxel() const override { return voxel_; }
    MemoryUse memory() const override;
    std::optional<KindCosts> costs(bool any_hit) override { return count_costs(any_hit); }

    SceneCubes::Stats stats() const { return cubes_.stats(); }

  protected:
    void record_build(Commands& commands) override { scene_.record_build(commands); }
    bool finish_build(Commands& commands) override { return scene_.finish_build(commands); }
    void record_hits(Commands& commands, const RayQueue& queue, const Buffer& hits, bool any_hit) override {
        scene_.record_hits(commands, queue, hits, any_hit, Edges::single);
    }
    void record_translation(Commands& commands, const Buffer& hits, uint32_t count, const Buffer& file_hits) override {
        scene_.record_translation(commands, hits, count, file_hits);
    }

  private:
    RayScene scene_;
    const SceneCubes& cubes_;    ///< of the scene's tracer
    std::vector<float> voxels_;  ///< of the cube of each triangle (file order), world units; only of planar hits
    float voxel_ = 0;            ///< the largest
};

/// Heights that planar hits give their rays, in voxels (Frame::surface_offset).
inline constexpr float kPlanarOffset = 0.7f;

}  // namespace peelray
