// One picture of a scene: docs/frame.md tells it pass by pass.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/cost_counter.h"
#include "render/cube_maps.h"
#include "render/tracer_choice.h"
#include "scene/moment.h"
#include "scene/picture.h"

namespace peelray {

/// What a picture is to look like and how it is traced. Defaults are those of the command line.
struct RenderSettings : PictureSettings, TracerChoice {
    bool hit_auto = true;  ///< choose cubes.hit by the number of triangles
    Visibility visibility = Visibility::automatic;
    uint32_t repeat = 1;      ///< frames to render; times are medians over them
    bool time_passes = true;  ///< else only the frame and its build: passes then do not wait for timestamps
    bool counters = false;    ///< count what rays cost, which slows them: times then tell nothing; of Tracer::ldc
};

struct RenderStats {
    Tracer tracer = Tracer::ldc;
    Visibility visibility = Visibility::compute;  ///< of the camera; never automatic
    struct Time {
        std::string name;
        double ms;  ///< GPU time; median over the repeated frames; summed over bands, samples and levels of a frame
    };
    std::vector<Time> passes;  ///< in order of their first run
    struct FrameTime {
        double frame_ms, build_ms;
    };
    std::vector<FrameTime> frames;  ///< each of those that the medians are taken of, in order
    double frame_ms = 0;            ///< GPU time from first to last pass, median over the frames
    double build_ms = 0;            ///< of the passes that build cubes, or acceleration structures
    double maps_ms = 0;             ///< of the passes of probes and shadow maps
    bool timed = false;             ///< false: the device has no timestamps
    SceneCubes::Stats cubes;
    std::vector<LdcBody> bodies;  ///< with the grids of their cubes
    std::vector<uint32_t> shown;  ///< how many instances show each of them
    uint32_t rebuilt = 0;         ///< cubes that were built for this frame
    uint32_t moved = 0;           ///< instances that stand elsewhere than in the frame before
    uint64_t scene_bytes = 0, frame_bytes = 0, peak_bytes = 0;
    std::vector<Allocation> memory, peak_memory;  ///< all of the device's when the picture was done, and at the peak
    HitTest hit = HitTest::exact;
    CubeChoice choice;  ///< of the cubes
    CubeMaps::Stats maps;
    Structures::Stats structures;                       ///< of `khr`
    StructureUpdate update = StructureUpdate::rebuild;  ///< of those of them that are not kept
    bool counted = false;                               ///< with RenderSettings::counters
    AllKindCosts costs;                                 ///< of the last frame
    uint32_t redone = 0;                                ///< how often something did not fit and was done again
};

struct RenderResult : Picture {
    RenderStats stats;
};

/// What `auto` stands for in a scene of so many triangles.
CubeChoice choose_automatically(const Device& device, uint32_t triangles, const RenderSettings& settings);

/// Renders pictures of one scene at one moment or another; keeps its buffers and cubes from picture to picture.
class Renderer {
  public:
    /// `scene`, which must outlive it, at `moment`; `assembly`: of this scene, at any moment.
    Renderer(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
             const Environment& environment);
    ~Renderer();

    /// Takes on another moment of the scene. What is generated must have been placed (Simulation) for Tracer::cubemap
    /// only: its maps stand in the middle of objects, whose boxes the CPU knows.
    void pose(const Moment& moment);

    /// Throws Error for impossible settings (naming the option) or when the device's limits or memory do not do.
    /// `progress` is told the share done, [0, 1].
    RenderResult render(const RenderSettings& settings, const std::function<void(double)>& progress = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace peelray
