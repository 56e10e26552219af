// One picture of a scene: docs/frame.md tells it pass by pass.
#pragma once

#include <memory>

#include "render/picture_output.h"
#include "render/render_settings.h"
#include "render/render_stats.h"
#include "scene/moment.h"
#include "scene/passes.h"

namespace peelray {

struct RenderResult : Picture {
    RenderStats stats;
};

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

    /// From now on the pass runs after all others; see PostPass.
    void add_post_pass(PostPass pass);

    /// With Denoise::temporal, before the picture of which it is one of the DENOISE_WARM_UP that come before it by
    /// PictureSettings::number, with the same settings but for the moment: makes the picture and keeps of it what that
    /// one needs. Pictures that render() has made are kept as well. Returns GPU milliseconds. Throws Error like
    /// render().
    double warm_up(const RenderSettings& settings, const PictureWatch& watch = {});

    /// Throws Error for impossible settings (naming the option) or when the device's limits or memory do not do.
    RenderResult render(const RenderSettings& settings, const PictureWatch& watch = {});

    /// Gives back a picture that is not needed any more: the next one takes over its memory.
    void reuse(Picture picture);
    /// Adds the radiance to the last picture of render(), where PictureSettings::radiance was false.
    void add_radiance(Picture& picture);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace peelray
