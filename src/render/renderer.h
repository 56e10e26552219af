// One picture of a scene: docs/frame.md tells it pass by pass.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ldc/compute_builder.h"
#include "ldc/tracer.h"
#include "render/cube_maps.h"
#include "scene/picture.h"

namespace peelray {

/// Who answers for what a surface mirrors, lets through and has in its way to the light.
enum class Tracer : uint8_t {
    ldc,      ///< rays in the layered depth cube
    cubemap,  ///< the baseline: cube maps of each object's surroundings and shadow maps
    none,     ///< nobody: the environment is all that surfaces see, and no light is blocked
};

/// What a picture is to look like and how it is traced. Defaults are those of the command line.
struct RenderSettings : PictureSettings {
    uint32_t ldc = 0;      ///< voxels along the box's longest side, 16 to 2048; 0: chosen by the number of triangles
    bool hit_auto = true;  ///< choose the hit test by the number of triangles
    HitTest hit = HitTest::exact;
    Tracer tracer = Tracer::ldc;
    uint32_t repeat = 1;  ///< frames to render; times are medians over them
};

struct RenderStats {
    Tracer tracer = Tracer::ldc;
    struct Time {
        std::string name;
        double ms;  ///< GPU time; median over the repeated frames; summed over bands, samples and levels of a frame
    };
    std::vector<Time> passes;  ///< in order of their first run
    double frame_ms = 0;       ///< GPU time from first to last pass, median over the frames
    double build_ms = 0;       ///< of the cube's passes
    double maps_ms = 0;        ///< of the passes of probes and shadow maps
    bool timed = false;        ///< false: the device has no timestamps
    CubeGrid grid{};
    LdcCounters cube{};
    uint64_t cube_bytes = 0, scratch_bytes = 0, scene_bytes = 0, frame_bytes = 0, peak_bytes = 0;
    uint32_t ldc = 0;
    HitTest hit = HitTest::exact;
    CubeMaps::Stats maps;
    uint32_t redone = 0;  ///< how often something did not fit and was done again
};

struct RenderResult : Picture {
    RenderStats stats;
};

/// The cube's resolution and hit test that `auto` stands for.
struct AutoChoice {
    uint32_t ldc;
    HitTest hit;
};
AutoChoice choose_automatically(uint32_t triangles, const RenderSettings& settings);

/// Renders pictures of one scene; keeps its buffers from picture to picture.
class Renderer {
  public:
    Renderer(Device& device, const Scene& scene, const Geometry& geometry, const Environment& environment);
    ~Renderer();

    /// Throws Error for impossible settings (naming the option) or when the device's limits or memory do not do.
    /// `progress` is told the share done, [0, 1].
    RenderResult render(const RenderSettings& settings, const std::function<void(double)>& progress = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace peelray
