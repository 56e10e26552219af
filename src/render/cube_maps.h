// The baseline, Tracer::cubemap: what engines without ray tracing do. The surroundings of each object that mirrors or
// lets light through are rendered from the middle of its box into a cube map, its probe, which its surfaces look up by
// direction alone. docs/frame.md tells what that gets wrong.
#pragma once

#include "render/shadow_maps.h"

namespace peelray {

class CubeMaps {
  public:
    /// Takes from `source` and `geometry` what it needs; `scene` must outlive it.
    CubeMaps(Device& device, const GpuScene& scene, const Scene& source, const Geometry& geometry);

    /// Takes on another moment of the same scene.
    void move(const Geometry& geometry) { objects_.move(geometry); }

    /// Chooses the objects that get a probe and the faces' size; makes room for probes and shadow maps. `picture`: the
    /// picture's constants, on which those of the maps' views are modelled. `box`: of the scene.
    void prepare(Commands& commands, const PictureSettings& settings, const Frame& picture, const Box& box);

    /// Texels along a probe's face, 0 without probes: level 0 of the queues must have room for its square.
    uint32_t face() const { return face_; }

    /// Renders all shadow maps and probes; `submitted` is called after each submission.
    void render(Commands& commands, PathQueues& queues, const std::function<void()>& submitted);

    /// Shades level 0 of a view in place of `scatter` and `shadow`, with the probes of the last round.
    void record_shading(Commands& commands, const Buffer& frame, const PathLevel& level, const LevelParams& params);

    struct Stats {
        uint32_t probes = 0, face = 0, rounds = 0, samples = 0;
        uint32_t left_out = 0;  ///< objects that deserve a probe but find no room even at the smallest size
        uint64_t probe_bytes = 0;
        ShadowMaps::Stats shadows;
    };
    Stats stats() const;

  private:
    struct Probe {
        uint32_t object, first;  ///< first texel
        bool rough;              ///< has the blurred levels, too
    };
    glm::vec3 position(uint32_t object) const;
    /// `pixels`: along the longer side of the picture; faces are as fine as it within bounds.
    void choose_probes(const PictureSettings& settings, uint32_t pixels);
    bool place_probes(const std::vector<uint32_t>& chosen, uint64_t room);
    void upload_frames(Commands& commands, const Frame& picture);
    void record_face(Commands& commands, PathQueues& queues, size_t index, uint32_t face, const Buffer& texels);
    void record_probe(Commands& commands, PathQueues& queues, size_t index, const Buffer& texels);
    void record_blurred(Commands& commands, const Probe& probe, const Buffer& texels);

    Device& device_;
    const GpuScene& scene_;
    ObjectTable objects_;
    ShadowMaps shadows_;
    std::vector<Probe> probes_;
    uint32_t face_ = 0, rounds_ = 0, samples_ = 1, left_out_ = 0;
    uint64_t texel_count_ = 0;
    ViewTarget target_;
    Buffer with_probes_;  ///< GpuObject per object
    Buffer texels_[2];    ///< probes, in turns: a round reads those of the round before
    Buffer mips_, frames_;
    const Buffer* current_ = nullptr;  ///< the probes that can be looked up; null: none yet
};

}  // namespace peelray
