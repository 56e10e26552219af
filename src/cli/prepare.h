// From picture arguments to what every tracer renders: scene, triangles, camera, light.
#pragma once

#include "cli/arguments.h"
#include "motion/simulation.h"
#include "render/renderer.h"
#include "scene/environment.h"

namespace peelray {

/// A scene and one of its moments. What frames the picture does not depend on the moment, so that a sequence does not
/// wobble and any frame of it can be rendered alone.
struct PreparedScene {
    Scene scene;
    Moment moment;
    Camera camera;
    Environment environment;
    std::string animation;       ///< the one that moves the scene, see moment_of(); empty: it stands at rest
    std::optional<double> time;  ///< of the moment, in the animation
    Box framed;                  ///< the scene without the floor of --floor, over the whole animation
    Box bounds;                  ///< the same with the floor
    uint64_t triangles = 0;      ///< with all instances

    /// The triangles of this moment; put together when they are first asked for, since most tracers need none.
    const Geometry& geometry();
    /// Places what is generated on the CPU, too.
    void simulate();
    /// Another moment of the animation.
    void move_to(double seconds);

  private:
    std::optional<Geometry> geometry_;
    Simulation simulation_;
    bool simulated_ = false;  ///< the moment has been
};

/// The scene's triangles. Tells on standard error what of the scene is left out; throws Error if nothing can be hit,
/// unless that is but one moment of an animation.
void check_visible(const Geometry& geometry, const Scene& scene, bool is_moment = false);

/// Settings for a builder, a traversal and what belongs to them.
void choose_tracing(RenderSettings& settings, const TracingArguments& tracing);

/// Settings for a hit test; none: chosen by the number of triangles.
void choose_hit(RenderSettings& settings, std::optional<HitTest> hit);
/// The settings without the camera and the tracer.
RenderSettings settings_of(const PictureArguments& arguments);
/// The same with what goes into other files than the picture.
RenderSettings settings_of(const RenderArguments& arguments);
/// Throws Error where what is to be counted cannot be or goes nowhere.
void check_counters(const RenderArguments& arguments);
/// Loads the scene and applies --material, --floor, --time, the camera and the light. Throws Error.
PreparedScene prepare_scene(const PictureArguments& arguments);
/// Moves a prepared scene with an animation to another moment: triangles, camera and lights are then those of `time`.
void move_to(PreparedScene& scene, const PictureArguments& arguments, double time);

}  // namespace peelray
