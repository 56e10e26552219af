// The rays of a frame, made on the CPU in double precision: what a benchmark sends through every tracer alike.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "reference/oracle.h"
#include "scene/picture.h"
#include "settings/choices.h"

namespace peelray {

inline constexpr size_t kRayKinds = names_of(RayKind{}).size();

/// Rays that only ask whether something is in the way.
inline bool is_any_hit(RayKind kind) {
    return kind == RayKind::shadow || kind == RayKind::ambient;
}

/// A ray before it is known how far off its surface it has to start (leaving_ray).
struct SurfaceRay {
    glm::vec3 point, direction;  ///< world space; direction: unit
    float reach;                 ///< from `point`, world units; +inf: without end
    glm::vec3 normal;            ///< of the triangle at `point`, unit, to either side
    float error;                 ///< bound on the rounding error of `point`, world units; 0: it lies on no surface
    uint32_t triangle;           ///< at `point`, in file order; ~0u: it lies on no surface
};

/// A ray as tracers take it.
struct StartedRay {
    glm::vec3 origin;
    float tmin;
    glm::vec3 direction;
    float tmax;
};

/// Where the frame lets a ray start (leavingRay in shaders/path/frame.glsl). `offset`: height above its surface from
/// which it counts, world units; 0 unless hits know surfaces only to a voxel.
StartedRay leaving_ray(const SurfaceRay& ray, float offset);

/// From where and with which light the sets are made.
struct RaySetView {
    Camera camera;
    uint32_t width, height;  ///< pixels
    Box box;                 ///< of the scene
    Light light;             ///< of the shadow rays
};

/// Sets by kind; empty where a kind was not asked for.
using RaySets = std::array<std::vector<SurfaceRay>, kRayKinds>;

/// Makes the sets of `kinds`, in the order of a frame's queues: pixels in tiles of 8x8, row by row, only rays that
/// exist; of refraction bounce by bounce, of ambient sample by sample. `oracle`: over `geometry`, which is `scene`'s.
/// The result does not depend on the number of threads. Throws Error (see make_view), Interrupted.
RaySets make_ray_sets(const Scene& scene, const Geometry& geometry, const Oracle& oracle, const RaySetView& view,
                      const std::vector<RayKind>& kinds);

}  // namespace peelray
