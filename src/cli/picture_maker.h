// Pictures of one scene by any tracer.
#pragma once

#include <functional>
#include <memory>

#include "cli/prepare.h"
#include "workspace/stats.h"

namespace peelray {

/// A picture and how it was made.
struct MadePicture {
    Picture picture;
    PictureStats stats;
};

/// When and from where a picture is seen.
struct Shot {
    std::optional<double> time;  ///< of the animation, seconds; none: as the scene stands
    double turn = 0;             ///< how far the camera went around its look point, see turned()
};

/// Opens the device when a tracer first needs one and keeps it from picture to picture.
class PictureMaker {
  public:
    /// Both must outlive it. Pictures move the scene to their moments.
    PictureMaker(PreparedScene& scene, const PictureArguments& arguments);
    ~PictureMaker();

    /// Throws Error: no device, impossible settings, an interrupt, a validation message. `progress` is told the share
    /// done, [0, 1]; without it a bar of its own is drawn.
    MadePicture make(Tracer tracer, RenderSettings settings, const Shot& shot = {},
                     const std::function<void(double)>& progress = {});

    /// Throws Error where a tracer cannot render on this device.
    void check(Tracer tracer);

    /// The name of what renders for a tracer: of a device, or of a library where pictures do not depend on the machine.
    std::string renderer_name(Tracer tracer);

    /// Throws Error with the validation layers' first message, if there is any.
    void check_validation() const;

  private:
    Device& device();
    Renderer& renderer_for(const RenderSettings& settings);
    MadePicture make_on_gpu(const RenderSettings& settings, const std::function<void(double)>& progress);
    MadePicture make_reference(const RenderSettings& settings, const std::function<void(double)>& progress);

    PreparedScene& scene_;
    const PictureArguments& arguments_;
    std::unique_ptr<Device> device_;
    std::unique_ptr<Renderer> renderer_;
    struct Kind {
        Tracer tracer;
        bool hit_auto;
        HitTest hit;
        bool operator==(const Kind&) const = default;
    } kind_{};
    std::optional<double> posed_;   ///< the moment that the renderer is in
    bool noted_ = false;            ///< said what a tracer cannot do
    bool noted_tolerance_ = false;  ///< said that it is too small
};

}  // namespace peelray
