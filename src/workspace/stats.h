// How pictures and rays were made, for whoever wants to read or write it down.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "render/renderer.h"
#include "workspace/posed_scene.h"

namespace peelray {

/// What computed something: a device, or the processor.
struct Machine {
    std::string name, kind, driver;
    std::string api_version;  ///< empty: no Vulkan device
};

Machine machine_of(const Device& device);

/// How a picture was made.
struct PictureStats {
    Machine machine;
    uint32_t width = 0, height = 0;
    uint64_t triangles = 0;  ///< of the scene, with all instances
    Box box;                 ///< of the scene, relative to `origin`
    glm::dvec3 origin{0};    ///< Scene::origin
    Camera camera;           ///< that the picture is seen from, but for Shot::turn; relative to `origin`
    SamplesMade samples;
    RayCounts rays;
    uint32_t warm_up_pictures = 0;  ///< that were rendered before, of other moments (Denoise::temporal),
    double warm_up_ms = 0;          ///< and how long they took: rays and times are those of the picture itself
    RenderStats render;             ///< where is_on_cpu() only times and passes
    RayCosts largest_of_a_pixel;    ///< where costs were counted

    bool by_cpu() const { return is_on_cpu(render.tracer); }
    /// Were rays traced in layered depth cubes?
    bool has_cubes() const { return render.cubes.bodies > 0; }
};

/// What any tracer can say of its picture of the scene; of RenderStats nothing.
PictureStats picture_stats(const Machine& machine, const PosedScene& scene, const Picture& picture);

/// How rays from a file were traced.
struct TraceStats {
    Machine machine;
    uint64_t triangles = 0, rays = 0, hits = 0;
    bool any_hit = false;
    double build_ms = 0, trace_ms = 0;  ///< trace_ms: median over the repetitions
    std::vector<PassTime> build_passes;
    std::optional<AllKindCosts> costs;            ///< where they were counted; of all rays in the first entry
    std::optional<Structures::Stats> structures;  ///< of the device's own ray tracing; none: rays went through cubes
    CubeChoice choice;
    SceneCubes::Stats cubes;
    std::vector<LdcBody> bodies;  ///< with the grids of their cubes
    std::vector<uint32_t> shown;  ///< how many instances show each of them
    Box box;                      ///< of the scene, relative to `origin`
    glm::dvec3 origin{0};         ///< Scene::origin
    std::vector<Allocation> memory, peak_memory;
};

/// "2 cubes of up to 368": how many, and their voxels along the longest side.
std::string count_of_cubes(const SceneCubes::Stats& cubes);

/// What to say where cubes as fine as they should be, or exact hits, found no room; empty: nothing.
std::string room_note(const SceneCubes::Stats& cubes);

/// What to say where rays that show much of the picture end at the last bounce; empty: nothing.
std::string cut_note(const RayCounts& rays, uint32_t bounces);

/// What to say where rays were in more media than a stack holds; empty: nothing. Not of the reference, which counts
/// such rays and follows them.
std::string crowded_note(const RayCounts& rays);

/// What to say where photons were asked for and lamps sent none, or other lights would have; empty: nothing.
/// `emissive`: some surfaces light the scene.
std::string caustics_note(const RayCounts& rays, const PictureSettings& settings, bool emissive);

/// What to say where the tolerance of `tolerance` hits is so far below the voxels that surfaces have holes; empty:
/// nothing. `bodies`: with the grids of their cubes.
std::string tolerance_note(const std::vector<LdcBody>& bodies, const CubeChoice& choice);

}  // namespace peelray
