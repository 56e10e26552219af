// One picture of a scene: the frame of DESIGN.md section 4 (docs/frame.md tells it pass by pass).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ldc/compute_builder.h"
#include "ldc/tracer.h"
#include "render/gpu_scene.h"

namespace peelray {

enum class Tonemap : uint8_t { none, aces, neutral };

/// What a picture is to look like. Defaults are those of the command line.
struct RenderSettings {
    uint32_t width = 1280, height = 1024;  ///< pixels, 1 to the device's largest image
    Camera camera;
    uint32_t ldc = 0;      ///< voxels along the box's longest side, 16 to 2048; 0: chosen by the number of triangles
    bool hit_auto = true;  ///< choose the hit test by the number of triangles
    HitTest hit = HitTest::exact;
    uint32_t bounces = 4;                                      ///< secondary rays in a row, 0 to 16
    uint32_t spp = 1;                                          ///< samples per pixel, at least 1
    bool reflection = true, refraction = true, shadow = true;  ///< effects that are traced; others see the environment
    bool ambient = false;  ///< one ray per hit and sample decides how much of the sky a diffuse surface sees
    bool trace = true;     ///< false: no cube, no secondary rays (--tracer none)
    float exposure = 0;    ///< stops; applies to the encoded picture only
    Tonemap tonemap = Tonemap::neutral;
    bool aovs = false;    ///< also the auxiliary pictures
    uint32_t repeat = 1;  ///< frames to render; times are medians over them
};

/// Auxiliary pictures at the pixel centres; width·height entries each, row 0 at the top.
struct Aovs {
    std::vector<float> depth;                         ///< distance along the camera ray, world units; +inf: nothing
    std::vector<float> triangle, material;            ///< index; -1: nothing
    std::vector<glm::vec4> normal, albedo, position;  ///< world space; w: 1 where there is a surface (normal: 0)
};

struct RayCounts {
    uint64_t primary = 0, reflection = 0, refraction = 0, shadow = 0, ambient = 0;
    uint64_t secondary() const { return reflection + refraction + shadow + ambient; }
};

struct RenderStats {
    struct Time {
        std::string name;
        double ms;  ///< GPU time; median over the repeated frames; summed over bands, samples and levels of a frame
    };
    std::vector<Time> passes;  ///< in order of their first run
    double frame_ms = 0;       ///< GPU time from first to last pass, median over the frames
    double build_ms = 0;       ///< of the cube's passes
    bool timed = false;        ///< false: the device has no timestamps
    RayCounts rays;            ///< of one frame
    CubeGrid grid{};
    LdcCounters cube{};
    uint64_t cube_bytes = 0, scratch_bytes = 0, scene_bytes = 0, frame_bytes = 0, peak_bytes = 0;
    uint32_t ldc = 0;
    HitTest hit = HitTest::exact;
    uint32_t redone = 0;  ///< how often something did not fit and was done again
};

struct RenderResult {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec4>
        radiance;  ///< linear, mean over the samples, before exposure; alpha: share of samples with a surface
    std::vector<uint32_t> encoded;  ///< exposed, tone-mapped, 8-bit sRGB
    Aovs aovs;
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
