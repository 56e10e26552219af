// A scene for rays alone: cubes, or acceleration structures, and what tells whose triangles were hit, nothing to shade
// with but what tells of holes.
#pragma once

#include "ldc/tracer.h"
#include "render/tracer_choice.h"

namespace peelray {

class RayScene {
  public:
    /// Uploads the scene at a moment, which is that of its assembly, and builds what rays are traced in: Tracer::ldc or
    /// khr. Throws Error where the device has no acceleration structures.
    RayScene(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
             const TracerChoice& choice);
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// Records the tracing of `count` rays (Ray each): file_hits[i] (FileHit each) for rays[i], see record_trace.
    /// `counting`: where it is counted what they cost, if that is not null.
    void record(Commands& commands, const Buffer& rays, uint32_t count, const Buffer& file_hits, bool any_hit,
                const CountBuffers* counting = nullptr);

    /// The same in two parts: hits[i] (Hit each) for the rays of a queue, and their translation.
    void record_hits(Commands& commands, const RayQueue& queue, const Buffer& hits, bool any_hit, Edges edges);
    void record_translation(Commands& commands, const Buffer& hits, uint32_t count, const Buffer& file_hits);

    /// Records the build of what is built for every frame, and where it stands. After the submission finish_build()
    /// tells whether everything fitted; if not, it is to be recorded again.
    void record_build(Commands& commands);
    bool finish_build(Commands& commands) { return structures_ || cubes_.finish(commands); }

    const SceneCubes& cubes() const { return cubes_; }
    /// Null: rays are traced in the cubes.
    const Structures* structures() const { return structures_.get(); }
    const Instances& instances() const { return instances_; }
    std::vector<LdcBody> download_bodies(Commands& commands) const { return cubes_.cubes().download_bodies(commands); }
    std::vector<uint32_t> shown() const { return shown_; }  ///< instances of each body
    const std::vector<PassTime>& build_times() const { return build_times_; }
    double build_ms() const { return build_ms_; }

  private:
    void build_cubes(Commands& commands);
    void build_structures(Commands& commands, const Scene& scene, const Assembly& assembly, const TracerChoice& choice);

    Device& device_;
    TriangleBuffers triangles_;
    BaseColorBuffers base_colors_;  ///< only where a material is masked
    Buffer triangle_ids_, hits_;
    Instances instances_;
    SceneCubes cubes_;
    std::unique_ptr<Structures> structures_;
    std::vector<uint32_t> shown_;
    std::vector<PassTime> build_times_;
    double build_ms_ = 0;
};

}  // namespace peelray
