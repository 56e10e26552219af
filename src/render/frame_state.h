// What the stages of a frame share.
#pragma once

#include <algorithm>

#include "common/material.h"
#include "path/filtered_numbers.h"
#include "render/bands.h"
#include "render/camera_view.h"
#include "render/cost_counter.h"
#include "render/cube_maps.h"
#include "render/moment_before.h"
#include "render/photons.h"
#include "render/tracers/ray_tracer.h"

namespace peelray {

struct FrameState {
    Device& device;
    Commands commands;
    GpuScene scene;
    CameraView view;
    PathQueues queues;
    std::unique_ptr<MergedInstances> merged;  ///< null: nothing is
    std::unique_ptr<RayTracer> tracer;
    std::unique_ptr<CubeMaps> maps;        ///< null: rays are shaded, not looked up
    std::unique_ptr<CostCounter> counter;  ///< null: nothing is counted
    std::unique_ptr<PhotonMap> photons;    ///< null: lamps send none

    // Of the picture that is being made:
    MomentBefore before;  ///< where it is asked for
    RenderSettings settings;
    Frame constants{};
    Bands bands;
    uint32_t last_level = 0;

    FrameState(Device& device, const Scene& source, const Moment& moment, const Assembly& assembly,
               const Environment& environment)
        : device(device),
          commands(device),
          scene(device, source, moment, assembly, environment),
          view(device),
          queues(device) {}

    /// Shadow rays that a hit may start.
    uint32_t lights_per_hit() const {
        if (!tracer->traces()) return 0;
        const uint32_t skies = scene.base_colors.kinds & MATERIALS_SEEPING ? 2 : 1;  // in front, and behind
        const uint32_t many = drawn_lamps(), all = scene.lamps(env_sampled()) - many + (many > 0 ? 1 : 0);
        const uint32_t lamps = settings.shadow ? all : 0;
        const uint32_t drawn = settings.shadow && emitting() ? 1 : 0;
        if (env_sampled()) return lamps + drawn + (settings.shadow ? 1 : 0);
        if (!occludes_sky(settings)) return lamps + drawn;
        return lamps + drawn + (env_filtered() ? FILTERED_DIRECTIONS : skies);
    }
    /// How many of them there are as a rule, so that there is room for them at once.
    uint32_t usual_lights_per_hit() const {
        const bool many = lights_per_hit() > 0 && env_filtered() && occludes_sky(settings);
        return many ? FILTERED_DIRECTIONS / 2 : 1;  // those that a surface faces
    }
    /// Is the environment's light found by sampling? Cube maps hold it blurred.
    bool env_sampled() const { return settings.env_mode == EnvironmentMode::sampled && !maps; }
    /// Is it found without noise, and behind what is in the way of a few directions?
    bool env_filtered() const { return settings.env_mode == EnvironmentMode::filtered && !maps; }
    /// Are diffuse bounces followed?
    bool indirect() const { return settings.gi > 0 && tracer->traces(); }
    /// Lamps of which each hit draws one; 0: all count.
    uint32_t drawn_lamps() const { return samples_lamps(settings) && !maps ? scene.drawn_lamps() : 0; }
    /// Are lamps seen to have a size?
    bool soft_lamps() const {
        const auto has_size = [](const GpuLight& light) { return light.sine > 0; };
        return samples_lamps(settings) && !maps && std::ranges::any_of(scene.light_list, has_size);
    }
    /// What the shaders that shade hits know of the scene's materials. Cones also filter what mirrors show of a sampled
    /// environment.
    uint32_t shaded_kinds() const {
        return scene.base_colors.kinds | (env_sampled() || env_filtered() ? MATERIALS_FILTERED : 0);
    }
    /// PHOTONS_*: the ways that light takes as photons; 0: none.
    uint32_t photon_ways() const {
        if (!photons) return 0;
        return photons->plan().through_glass && scene.has_glass ? PHOTONS_THROUGH_GLASS : PHOTONS_BY_MIRRORS;
    }
    /// Is light looked for on emissive triangles?
    bool emitting() const { return scene.emitters() > 0 && !maps && samples_emitters(settings); }
    /// Are rays traced that may be in several media at once?
    bool layered() const { return tracer->traces() && (scene.layered || constants.camera_media != glm::uvec2(0)); }
    uint64_t pixels() const { return uint64_t(settings.width) * settings.height; }
};

/// Of the camera's level in the band that starts at a row, or of a deeper one.
LevelParams level_params(const FrameState& f, uint32_t level, uint32_t sample, uint32_t first_row);

}  // namespace peelray
