// From settings to what every tracer renders: scene, moment, triangles, camera, light.
#pragma once

#include <memory>
#include <optional>

#include "assembly/assembly.h"
#include "motion/simulation.h"
#include "scene/box.h"
#include "scene/environment.h"
#include "scene/framing.h"
#include "settings/settings.h"
#include "workspace/notes.h"

namespace peelray {

/// A scene and one of its moments. What frames the picture does not depend on the moment, so that a sequence does not
/// wobble and any frame of it can be rendered alone.
class PosedScene {
  public:
    /// Loads the scene and applies everything of `settings` that does not need a device: the material of all surfaces,
    /// the floor, the moment, the camera and the light. Throws Error.
    explicit PosedScene(const PictureArguments& settings, const Notes& notes = {});

    /// Never changes, and stays where it is as long as this object, or what it was moved to, lives.
    const Scene& scene() const { return *scene_; }
    const Moment& moment() const { return moment_; }
    const Camera& camera() const { return camera_; }
    const Environment& environment() const { return environment_; }
    /// How it lights; with `sampled` it has a distribution.
    EnvironmentMode env_mode() const { return env_mode_; }
    /// The one that moves the scene, see moment_of(); empty: it stands at rest.
    const std::string& animation() const { return animation_; }
    /// Of the moment, in the animation; none: at rest.
    std::optional<double> time() const { return time_; }
    /// What is visible of the scene, without the floor of the settings, over the whole animation.
    const Box& framed() const { return framed_; }
    /// Everything, with the floor, also at rest.
    const Box& bounds() const { return bounds_; }
    uint64_t triangles() const { return triangles_; }  ///< with all instances

    /// The triangles of this moment; put together when they are first asked for, since most tracers need none.
    const Geometry& geometry();
    /// Places what is generated on the CPU, too: geometry() does it, and a reader of objects' boxes must call it.
    void simulate();

    /// Goes to another moment of the animation: triangles, camera and lights are then those of `seconds`. Without an
    /// animation the scene stays at rest.
    void move_to(double seconds);

    /// The same, but what frames the picture stays as it is at this moment.
    void visit(double seconds);

    /// Another moment of the animation, and the camera then; it frames what the camera of this moment does. The scene
    /// stays where it is. `simulate`: what is generated is placed in it, for who reads it on the CPU.
    struct Glimpse {
        Moment moment;
        Camera camera;
    };
    Glimpse glimpse(double seconds, bool simulate);

    /// For a renderer that goes from moment to moment: divided at the beginning of the animation, since the moment of a
    /// picture must not shape its cubes.
    Assembly assembly() const;
    /// For rays through this moment alone.
    Assembly assembly_of_moment() const;

  private:
    void pose(double seconds);
    void frame_animation(const Scene& scene);
    void frame_moment();

    PictureArguments settings_;
    std::unique_ptr<const Scene> scene_;
    std::string animation_;
    Moment moment_;
    std::optional<double> time_;
    Simulation simulation_;
    Simulation glimpsed_;     ///< of glimpse(): in a sequence it goes from moment to moment as well
    bool simulated_ = false;  ///< the moment has been
    std::optional<Geometry> geometry_;
    Framing framing_;       ///< of the camera that shows all of it
    size_t own_nodes_ = 0;  ///< of the scene, without the floor of the settings
    Box framed_, bounds_;
    uint64_t triangles_ = 0;
    Camera camera_;
    Environment environment_;
    EnvironmentMode env_mode_ = EnvironmentMode::open;
};

/// The scene's triangles. Notes what is left out of the scene; throws Error if nothing can be hit, unless that is but
/// one moment of an animation.
void check_visible(const Geometry& geometry, const Scene& scene, bool is_moment, const Notes& notes);

}  // namespace peelray
