// Pictures of one scene by any tracer:
//
//     PictureArguments settings;
//     settings.scene = "builtin:walker";
//     settings.animation = "walk";  // else it stands at rest
//     Workspace workspace(settings);
//     const MadePicture made = workspace.render({.time = 0.5});
//     double ms = made.stats.render.frame_ms;
//
// Nothing here prints.
#pragma once

#include <memory>
#include <optional>

#include "workspace/posed_scene.h"
#include "workspace/shot.h"
#include "workspace/stats.h"
#include "workspace/warm_up.h"

namespace peelray {

/// A picture and how it was made.
struct MadePicture {
    Picture picture;
    PictureStats stats;
};

/// Opens the device when a tracer first needs one and keeps it, and what is on it, from picture to picture.
class Workspace {
  public:
    /// Opens the scene of `settings`. Throws Error.
    explicit Workspace(const PictureArguments& settings, Notes notes = {});
    ~Workspace();

    PosedScene& scene() { return scene_; }
    const PosedScene& scene() const { return scene_; }

    /// The picture that the settings ask for. Throws Error: no device, impossible settings, an interrupt, a validation
    /// message.
    MadePicture render(const Shot& shot = {}, const PictureWatch& watch = {});
    /// The same scene rendered in another way; camera and bounds are the workspace's. With PictureWatch::stop
    /// interrupts are not looked for any more once a pass is whole: that is left to it.
    MadePicture render(RenderSettings settings, const Shot& shot = {}, const PictureWatch& watch = {});

    /// Gives back a picture that is not needed any more: the next one that a device makes takes over its memory.
    void reuse(Picture picture);

    /// Throws Error where a tracer cannot render on this device.
    void check(Tracer tracer);
    /// The name of what renders for a tracer: of a device, or of a library where pictures do not depend on the machine.
    std::string renderer_name(Tracer tracer);
    /// Throws Error with the validation layers' first message, if there is any.
    void check_validation() const;
    /// What follows gets a device that is as new: after an Error it may be lost.
    void renew_device();

  private:
    Device& device();
    Renderer& renderer_for(const RenderSettings& settings);
    /// Goes to the shot's moment and completes the settings. Returns the moment before, if it is of interest and
    /// anything but the camera may have moved since: the settings refer to it.
    std::unique_ptr<PosedScene::Glimpse> pose(RenderSettings& settings, const Shot& shot);
    struct WarmUp {
        uint32_t pictures = 0;
        double ms = 0;  ///< GPU time
    };
    WarmUp warm_up(const RenderSettings& settings, const Shot& shot, const std::function<void(double)>& progress);
    CpuPast* past_for(const RenderSettings& settings);
    MadePicture in_world(MadePicture made) const;
    void note_settings(const RenderSettings& settings);
    void note_cubes(const RenderStats& stats);
    void note_bands(const RenderStats& stats);
    void note_environment();
    void note_uncaught(const PictureSettings& settings);
    MadePicture render_on_device(const RenderSettings& settings, const PictureWatch& watch);
    bool may_note_culled() const;
    void note_culled(const PictureSettings& settings, Picture& picture);

    PictureArguments settings_;
    Notes notes_;
    PosedScene scene_;
    std::unique_ptr<Device> device_;
    std::unique_ptr<Renderer> renderer_;
    KeptPictures kept_;              ///< by the renderer, or by
    std::unique_ptr<CpuPast> past_;  ///< the CPU tracer
    /// What the renderer was made for.
    struct Kind {
        Tracer tracer;
        bool hit_auto;
        HitTest hit;
        bool operator==(const Kind&) const = default;
    } kind_{};
    std::optional<double> posed_;  ///< the moment that the renderer is in
    /// What has been said on this device, and is not said again.
    struct Noted {
        bool ambient = false;      ///< that a tracer has none
        bool denoise = false;      ///< that there is nothing to denoise
        bool environment = false;  ///< that it shows less of the map than there is
        bool uncaught = false;     ///< that no shadows fall on a floor that is there for them
        bool tolerance = false;    ///< that it is too small
        bool culled = false;       ///< that the camera is behind single-sided faces
        /// The least that was seen when it was looked at whether it is: that takes longer than a frame, and is done
        /// again where only half as much is seen.
        double least_seen = 1;
        bool cut = false;         ///< that rays end too early
        bool caustics = false;    ///< that there are none, or not all
        bool crowded = false;     ///< that rays are in too many media
        bool bands = false;       ///< that memory is limited to so little that a picture is made in bands
        ChoiceSet<HitTest> room;  ///< that these stand for what found no room
    } noted_;
};

}  // namespace peelray
